#pragma once
// Settings of surfaces: how textures are filtered, and how light on them is sampled.

#include <cstdint>
#include <span>

#include "core/settings.h"
#include "shared/deferred.h"

namespace tyndall {

struct GBufferSettings {
    float textureLodBias;
    float anisotropy;
};

struct SurfaceLightSettings {
    int32_t rectSamples;
    int32_t environmentSamples;
    float mapRoughness, lightsRoughness;                 // single frames
    float convergeMapRoughness, convergeLightsRoughness; // averaged frames
    bool materialOcclusion;
};

std::span<const SettingDesc> gbufferSettings();
std::span<const SettingDesc> surfaceLightSettings();
/// Entries for both.
std::span<const PresetEntry> surfacePresets();

/// What the shaders see of the settings. `converge`: this frame is one of many that are averaged.
gpu::SurfaceLightParams surfaceLightParams(const SurfaceLightSettings& settings, bool converge);

} // namespace tyndall
