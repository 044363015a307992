#pragma once
// Which shadow maps a frame needs, where they look, and where they lie in the atlas. Without GL.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/math.h"
#include "plugin/frame_resources.h"
#include "renderer/light_settings.h"
#include "shared/light.h"
#include "shared/shadow.h"

namespace tyndall {

/// All shadow maps of one frame.
struct ShadowPlan {
    std::vector<gpu::ShadowView> views; // in the order of `Lights`' shadow indices
    std::vector<mat4> clipFromRender;   // of each view, for drawing
    std::vector<vec4>
        balls; // of each view: the ball of light that it looks out of, centre and radius; radius 0: none
    std::vector<uint64_t> keys;    // of each view: what its picture depends on beside the casters
    int atlasSize = 0, layers = 0; // texels; 0: no map
    int shrunk = 0;                // times that all maps were halved to fit
    int lightsDropped = 0;         // lights at the end of the list that did not fit at all
};

struct ShadowRequest {
    std::span<const Bounds> casters;     // render space, of each surface that may cast a shadow
    Bounds surroundings;                 // render space: what maps of light from infinity must show
    const ViewResources* view = nullptr; // cascades follow it; its flags and jitter are minded
};

/// Plans the maps of `lights[i]` for i in `chosen`, the most important first, and sets their `shadowIndex` (all others get
/// -1). Lights must have this frame's sample points. Without casters there are no maps.
ShadowPlan planShadows(std::span<gpu::LightData> lights, std::span<const uint32_t> chosen,
                       const ShadowRequest& request, const ShadowSettings& settings);

} // namespace tyndall
