#pragma once
// What went on in the paths that somebody traced.

#include <cstdint>

namespace tyndall::tracing {

struct PathCounts {
    uint64_t paths = 0, segments = 0, shadowRays = 0;
    uint64_t cutOff = 0;    // paths ended by a limit on their length
    uint64_t nonFinite = 0; // contributions that were not finite, left out
    uint64_t negative = 0;  // contributions below 0
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
