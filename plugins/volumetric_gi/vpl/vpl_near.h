#pragma once
// What the bound takes away and no step in media makes up for: followed by paths on the processor (Kollig and Keller 2004), for squares of pixels.

#include "reference/instant_radiosity.h"
#include "shared/view.h"

namespace tyndall::volumetric_gi {

/// As cameraRay() in shaders/common/view.glsl; `ndc`: -1 to 1.
reference::CameraRays::CameraRay eyeRay(const gpu::ViewData& view, const dvec2& ndc);

struct NearOrder {
    // Pixels along an edge of a square; which of them stands for it says marchedPixel() in shaders/media/nearest_rays.glsl.
    int surfaceFactor = 1, mediaFactor = 1;
    uint32_t paths = 1; // of each square
    uint32_t first = 0; // number of its first path: others bring other light
    bool onSurfaces = true, inMedia = true;
    reference::InstantRadiositySettings settings;
};

/// By square, the lowest row first; w: 0. Empty where none was asked for.
struct NearLight {
    std::vector<vec4>
        onSurfaces; // nits that leave surfaces towards the eye over reflectance() in shaders/gi/vpl/receiver.glsl
    std::vector<vec4> inMedia; // nits that media scatter to the eye
    uint64_t nonFinite = 0;    // lights that were left out because they were no numbers
};

/// The mean over paths is what gathering with `order.settings.elsewhere` misses.
NearLight missedLight(const gpu::ViewData& view, const reference::TracerScene& scene,
                      const reference::LightEmission& emission, const NearOrder& order);

} // namespace tyndall::volumetric_gi
