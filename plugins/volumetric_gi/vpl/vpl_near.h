#pragma once
// What the bound takes away between surfaces: followed by paths on the processor (Kollig and Keller 2004), for squares of pixels.

#include "reference/instant_radiosity.h"
#include "shared/view.h"

namespace tyndall::volumetric_gi {

/// As cameraRay() in shaders/common/view.glsl; `ndc`: -1 to 1.
reference::CameraRays::CameraRay eyeRay(const gpu::ViewData& view, const dvec2& ndc);

struct NearOrder {
    int factor =
        1; // pixels along an edge of a square; which of them stands for it says marchedPixel() in shaders/media/nearest_rays.glsl
    uint32_t paths = 1; // of each square
    uint32_t first = 0; // number of its first path: others bring other light
    reference::InstantRadiositySettings settings;
};

struct NearLight {
    std::vector<vec4> squares; // the lowest row first; w: 0
    uint64_t nonFinite = 0;    // lights that were left out because they were no numbers
};

/// Nits that leave surfaces towards the eye over reflectance() in shaders/gi/vpl/receiver.glsl. The mean over paths is what gathering with the same bound
/// misses.
NearLight lostBetweenSurfaces(const gpu::ViewData& view, const reference::TracerScene& scene,
                              const reference::LightEmission& emission, const NearOrder& order);

} // namespace tyndall::volumetric_gi
