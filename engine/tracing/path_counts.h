#pragma once
// Statistics of traced paths.

#include <cmath>
#include <cstdint>

#include "core/math.h"

namespace tyndall::tracing {

struct PathCounts {
    uint64_t paths = 0, segments = 0, shadowRays = 0;
    uint64_t cutOff = 0;    // paths ended by a limit on their length
    uint64_t nonFinite = 0; // contributions that were not finite, left out
    uint64_t negative = 0;  // contributions below 0
    /// Counts what is wrong with a contribution; false if it is not finite and must be left out.
    [[nodiscard]] bool takes(const dvec3& light) {
        for (int c = 0; c < 3; ++c) {
            if (!std::isfinite(light[c])) {
                ++nonFinite;
                return false;
            }
            negative += light[c] < 0;
        }
        return true;
    }
    void add(const PathCounts& other) {
        paths += other.paths;
        segments += other.segments;
        shadowRays += other.shadowRays;
        cutOff += other.cutOff;
        nonFinite += other.nonFinite;
        negative += other.negative;
    }
};

} // namespace tyndall::tracing
