#pragma once
// Walks from the lights, and the virtual point lights that they leave.

#include <vector>

#include "tracing/proxy_media.h"
#include "shared/vpl.h"

namespace tyndall::volumetric_gi {

struct VplSet {
    std::vector<gpu::VplData> lights; // walk by walk
    std::vector<uint32_t> walks; // where each that left a light begins, and where the last ends
    std::vector<uint32_t>
        starts; // where the lights of each walk begin, of those without any, too; and where the last ends
    std::vector<gpu::VplPlace> places;
    std::vector<dvec3> positions; // of the lights, as exactly as they are known
    std::vector<double> margins;  // metres by which rays start off the surface; 0 in media
    uint64_t cutOff = 0;          // walks that were as long as walks may be
};

struct WalkOrder {
    uint32_t walks = 256;
    uint32_t together = 1; // so many are gathered as one; divides `walks`
    uint64_t seed = 0;
    uint32_t generation = 0; // walks of one generation are the same whenever they are made
    bool fromSurfaces = true, fromMedia = true; // which virtual lights to keep
};

struct Walks {
    std::vector<tracing::EmittedRay> starts;
    std::vector<std::vector<tracing::WalkVertex>> vertices;
    uint64_t cutOff = 0;
};

/// The same order gives the same walks, however many threads there are. `count` of them from number `first` on.
Walks traceWalks(const tracing::TracerScene& scene, const tracing::LightEmission& emission,
                 const WalkOrder& order, uint32_t first, uint32_t count);
/// What walks through one field carry in the other.
Walks reweighed(const Walks& walks, const tracing::MediaField& from,
                const tracing::MediaField& to);
/// Powers are divided by the number of walks.
VplSet packWalks(const Walks& walks, const WalkOrder& order);
/// Puts other lights in the place of those of some walks, from number `first` on; order.together is 1.
void replaceWalks(VplSet& set, uint32_t first, const VplSet& others);

} // namespace tyndall::volumetric_gi
