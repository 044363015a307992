#pragma once
// Chooses virtual lights by importance (after Georgiev and Slusallek, "Simple and Robust Iterative Importance Sampling of Virtual
// Point Lights", 2010): a light is kept with a probability that grows with its contribution to some visible points, and its power is divided
// by the probability. The expected light is that of all lights.

#include "shared/view.h"
#include "volumetric_gi/vpl/vpl_walks.h"

namespace tyndall::volumetric_gi {

/// Visible points: where eye rays end on surfaces and in media.
struct SeenPoint {
    dvec3 position{0};
    dvec3 normal{0};   // of the facet; 0 in a medium
    double margin = 0; // metres by which rays start off the surface
};
std::vector<SeenPoint> seenPoints(const gpu::ViewData& view,
                                  const tracing::SurfaceScene& surfaces,
                                  const tracing::MediaField& media, uint32_t count,
                                  uint64_t seed);

/// Drops lights so that about `wanted` remain. Without points all have the same importance. `least`: metres, clamping distance.
void chooseLights(Walks& walks, const std::vector<SeenPoint>& seen,
                  const tracing::SurfaceScene& surfaces, const tracing::MediaField& media,
                  double wanted, double least, uint64_t seed);

} // namespace tyndall::volumetric_gi
