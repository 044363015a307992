#pragma once
// Points of surfaces that the GPU splats into visibility maps.

#include <span>
#include <vector>

#include "tracing/surface_scene.h"
#include "shared/vpl.h"

namespace tyndall::volumetric_gi {

struct SurfacePoints {
    std::vector<gpu::VplPoint> points; // one set after another
    gpu::VplPointParams params{};
};

/// `setCount` sets of `setSize` points, each set spread over all surfaces: by area over the squared distance from where the lights are, so that a landscape
/// does not take the points that a room needs. Triangles with holes have points where they cover. No points if there is no surface.
SurfacePoints makeSurfacePoints(const tracing::SurfaceScene& surfaces,
                                std::span<const dvec3> lights, uint32_t setSize, uint32_t setCount,
                                uint64_t seed);

} // namespace tyndall::volumetric_gi
