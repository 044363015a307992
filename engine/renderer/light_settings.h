#pragma once
// Settings of lights, their lists and their shadows.

#include <cstdint>
#include <span>

#include "core/settings.h"

namespace tyndall {

struct LightSettings {
    float cutoff;
    int32_t clusterMinimum, clusterColumns, clusterRows, clusterSlices, clusterCapacity;
    int32_t environmentLights, mediumLights;
};

struct ShadowSettings {
    bool enabled;
    int32_t maxLights, resolution, localResolution, environmentResolution, cascades;
    float cascadeSplit;
    int32_t atlasSize, atlasLayers, taps, searchTaps;
};

std::span<const SettingDesc> lightSettingsTable();
std::span<const SettingDesc> shadowSettingsTable();
/// Entries for both.
std::span<const PresetEntry> lightPresets();

} // namespace tyndall
