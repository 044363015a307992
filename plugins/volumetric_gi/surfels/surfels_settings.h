#pragma once
// Settings of the surfels: gi.surfels.*

#include <cstdint>
#include <span>

#include "core/settings.h"

namespace tyndall::volumetric_gi {

enum class SurfelPairs : int32_t { Hierarchy = 0, All = 1 };
enum class SurfelRays : int32_t { None = 0, One = 1, Every = 2 };
enum class Surfelizer : int32_t { Tessellator = 0, Compute = 1 };

struct SurfelsSettings {
    float size; // pixels
    int32_t most;
    float far;
    int32_t surfelizer;
    int32_t intervals; // of SurfelIntervals
    bool jitter;
    int32_t levels;
    float threshold;
    int32_t pairs;
    int32_t rays;
    bool attenuation, visibility;
    bool blur;
    int32_t march;
    int32_t show;
};

[[nodiscard]] std::span<const SettingDesc> surfelsSettings();
[[nodiscard]] std::span<const PresetEntry> surfelsPresets();

/// Intervals of a ray: 8, 16 or 32.
[[nodiscard]] inline uint32_t intervalCount(const SurfelsSettings& settings) {
    return 8u << settings.intervals;
}

} // namespace tyndall::volumetric_gi
