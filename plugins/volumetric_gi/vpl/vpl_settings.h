#pragma once
// Settings of virtual point lights.

#include <cstdint>
#include <span>

#include "core/settings.h"

namespace tyndall::volumetric_gi {

struct VplSettings {
    int32_t walks;
    int32_t classes;
    int32_t mapSide;
    int32_t compensation; // kVplClamped and so on
    int32_t march;        // log2 of pixels per ray along an axis
    float clamp;
    float relaxed;
    float roughness;
    bool fromSurfaces, fromMedia, keep;
};
std::span<const SettingDesc> vplSettings();
std::span<const PresetEntry> vplPresets();

} // namespace tyndall::volumetric_gi
