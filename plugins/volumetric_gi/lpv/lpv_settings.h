#pragma once
// Settings of the light propagation lattice.

#include <cstdint>
#include <span>

#include "core/settings.h"

namespace tyndall::volumetric_gi {

struct LpvSettings {
    int32_t resolution;
    int32_t cascades;
    float extent;
    float tolerance;
    int32_t steps;
    int32_t rsmSize;
    int32_t rsmLights;
    int32_t rsmRectPoints;
    bool reflected, scattered, keep;
    int32_t march; // log2 of pixels per ray along an axis
    int32_t show;  // 0: nothing, else kLpvShow…
    int32_t showAxis;
    float showAt;
};
std::span<const SettingDesc> lpvSettings();
std::span<const PresetEntry> lpvPresets();

} // namespace tyndall::volumetric_gi
