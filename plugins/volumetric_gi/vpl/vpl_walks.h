#pragma once
// Walks from the lights, and the virtual point lights that they leave.

#include <vector>

#include "tracing/proxy_media.h"
#include "shared/vpl.h"

namespace tyndall::volumetric_gi {

struct VplSet {
    std::vector<gpu::VplData> lights; // walk by walk
    std::vector<uint32_t> walks; // first light of each walk that left one, and the end of the last
    std::vector<uint32_t>
        starts; // first light of each walk, walks without lights included; and the end of the last
    std::vector<gpu::VplPlace> places;
    std::vector<dvec3> positions; // of the lights, in double precision
    std::vector<double> margins;  // metres by which rays start off the surface; 0 in media
    uint64_t cutOff = 0;          // walks that reached the largest length
};

struct WalkOrder {
    uint32_t walks = 256;
    uint32_t together = 1; // this many are gathered as one; divides `walks`
    uint64_t seed = 0;
    uint32_t generation = 0; // walks of one generation always have the same random numbers
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
/// Power of walks through one field as it is in the other.
Walks reweighed(const Walks& walks, const tracing::MediaField& from,
                const tracing::MediaField& to);
/// Powers are divided by the number of walks.
VplSet packWalks(const Walks& walks, const WalkOrder& order);
/// Replaces the lights of some walks, from number `first` on; order.together is 1.
void replaceWalks(VplSet& set, uint32_t first, const VplSet& others);

} // namespace tyndall::volumetric_gi
