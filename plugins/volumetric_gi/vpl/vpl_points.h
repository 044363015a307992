#pragma once
// Points of surfaces, for maps of what virtual lights see that the graphics processor splats.

#include <span>
#include <vector>

#include "tracing/surface_scene.h"
#include "shared/vpl.h"

namespace tyndall::volumetric_gi {

struct SurfacePoints {
    std::vector<gpu::VplPoint> points; // set by set
    gpu::VplPointParams params{};
};

/// `setCount` sets of `setSize` points, each set spread over all surfaces: by area over the squared distance from where the lights are, so that a landscape
/// does not take the points that a room needs. Where rays may pass, points stand for what covers. No points where there is no surface.
SurfacePoints makeSurfacePoints(const tracing::SurfaceScene& surfaces,
                                std::span<const dvec3> lights, uint32_t setSize, uint32_t setCount,
                                uint64_t seed);

} // namespace tyndall::volumetric_gi
