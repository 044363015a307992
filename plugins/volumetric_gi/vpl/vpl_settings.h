#pragma once
// Settings of virtual point lights.

#include <cstdint>
#include <span>

#include "core/settings.h"

namespace tyndall::volumetric_gi {

/// How visibility maps are made: by rays on the processor, or from points that the GPU splats.
constexpr int32_t kVplMapsOfRays = 0, kVplMapsOfPoints = 1;

struct VplSettings {
    int32_t walks, candidates, renewed;
    int32_t subsets, surfaceSubsets;
    int32_t maps, points; // maps: kVplMapsOfRays …
    int32_t mapSide, depthSide;
    int32_t samples;
    int32_t compensationPaths;
    int32_t compensation;    // kVplClamped and so on
    int32_t march, surfaces; // log2 of pixels along an edge of the squares that gather once
    float clamp, surfaceClamp;
    float relaxed;
    float roughness;
    bool fromSurfaces, fromMedia, keep, incremental;
    int32_t show; // 0: nothing, else kVplShow…
    int32_t showLight;
};
std::span<const SettingDesc> vplSettings();
std::span<const PresetEntry> vplPresets();

} // namespace tyndall::volumetric_gi
