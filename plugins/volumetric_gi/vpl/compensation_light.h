#pragma once
// Light that clamping removes and the GPU does not compensate, by paths on the processor (Kollig and Keller 2004), for squares of pixels.

#include "volumetric_gi/vpl/bias_compensation.h"
#include "shared/view.h"

namespace tyndall::volumetric_gi {

/// As cameraRay() in shaders/common/view.glsl; `ndc`: -1 to 1.
tracing::CameraRays::CameraRay eyeRay(const gpu::ViewData& view, const dvec2& ndc);

struct CompensationOrder {
    // Pixels along an edge of a square; marchedPixel() in shaders/media/nearest_rays.glsl chooses the pixel that represents it.
    int surfaceFactor = 1, mediaFactor = 1;
    uint32_t paths = 1; // of each square
    uint32_t first = 0; // number of its first path; other numbers are other random numbers
    bool onSurfaces = true, inMedia = true;
    tracing::VirtualLightPathSettings path;
    GpuClamps clamps;
};

/// By square, the lowest row first; w: 0. Empty where none was asked for.
struct CompensationLight {
    std::vector<vec4>
        onSurfaces; // nits that leave surfaces towards the eye over reflectance() in shaders/gi/shared/surface_light.glsl
    std::vector<vec4> inMedia; // nits that media scatter to the eye
    uint64_t nonFinite = 0;    // contributions left out because they were not finite
};

/// Means over paths: the light that gathering with `order.clamps` lacks.
CompensationLight compensationLight(const gpu::ViewData& view, const tracing::TracerScene& scene,
                      const tracing::LightEmission& emission, const CompensationOrder& order);

} // namespace tyndall::volumetric_gi
