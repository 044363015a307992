#pragma once
// Of many virtual lights those that matter to the picture (after Georgiev and Slusallek, "Simple and Robust Iterative Importance Sampling of Virtual
// Point Lights", 2010): a light is kept with a chance that goes with how much it gives to some points that the picture shows, and then
// carries more by as much. The mean is that of all lights.

#include "shared/view.h"
#include "volumetric_gi/vpl/vpl_walks.h"

namespace tyndall::volumetric_gi {

/// Where eye rays end: on surfaces, and in media.
struct SeenPoint {
    dvec3 position{0};
    dvec3 normal{0};   // of the facet; 0 in a medium
    double margin = 0; // metres by which rays start off the surface
};
std::vector<SeenPoint> seenPoints(const gpu::ViewData& view,
                                  const tracing::SurfaceScene& surfaces,
                                  const tracing::MediaField& media, uint32_t count,
                                  uint64_t seed);

/// Drops lights so that about `wanted` are left. Without points all are of one worth. `least`: metres; a light that is nearer counts as this far.
void chooseLights(Walks& walks, const std::vector<SeenPoint>& seen,
                  const tracing::SurfaceScene& surfaces, const tracing::MediaField& media,
                  double wanted, double least, uint64_t seed);

} // namespace tyndall::volumetric_gi
