#pragma once
// Walks from the lights, and the virtual point lights that they leave.

#include <vector>

#include "reference/light_walk.h"
#include "shared/vpl.h"

namespace tyndall::volumetric_gi {

struct VplSet {
    std::vector<gpu::VplData> lights; // walk by walk
    std::vector<uint32_t> walks;  // where each that left a light begins, and where the last ends
    std::vector<dvec3> positions; // of the lights, as exactly as they are known
    std::vector<double> margins;  // metres by which rays start off the surface; 0 in media
    uint64_t cutOff = 0;          // walks that were as long as walks may be
};

struct WalkOrder {
    uint32_t walks = 256;
    uint64_t seed = 0;
    uint32_t generation = 0; // walks of one generation are the same whenever they are made
    bool fromSurfaces = true, fromMedia = true; // which virtual lights to keep
};

/// Powers are divided by the number of walks. The same order gives the same lights, however many threads there are.
VplSet makeWalks(const reference::TracerScene& scene, const reference::LightEmission& emission,
                 const WalkOrder& order);

} // namespace tyndall::volumetric_gi
