#pragma once
// Settings of how media are integrated and marched.

#include <cstdint>
#include <span>

#include "core/settings.h"

namespace tyndall {

/// Auto: exact in averaged frames (--converge), else the faster way.
enum class MediaIntegration : int32_t { Auto = 0, Steps = 1, Exact = 2 };
enum class LightOpticalDepth : int32_t { Auto = 0, Volume = 1, Exact = 2 };
enum class MarchResolution : int32_t { Full = 0, Half = 1, Quarter = 2 };

struct MediaSettings {
    bool enabled;
    bool dropUnseen;
    MediaIntegration integration;
    float stepScale;
    int32_t steps;
    int32_t environmentLights;
    MarchResolution resolution;
    bool smooth;
    bool refine;
    float depthTolerance, transmittanceTolerance, refineWeight;
    float minTransmittance;
    LightOpticalDepth lightOpticalDepth;
    int32_t opticalDepthResolution, opticalDepthLights;
};

std::span<const SettingDesc> mediaSettingsTable();
std::span<const PresetEntry> mediaPresets();

} // namespace tyndall
