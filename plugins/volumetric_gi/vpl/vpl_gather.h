#pragma once
// Virtual point lights on the GPU: their buffers, and the light that they give to surfaces and media.

#include "shared/vpl.h"
#include "volumetric_gi/shared/traced_scene.h"
#include "volumetric_gi/vpl/vpl_points.h"
#include "volumetric_gi/vpl/vpl_walks.h"

namespace tyndall::volumetric_gi {

struct VplBuffers {
    fg::BufferHandle lights, walks, maps;
    TracedBuffers traced;
    fg::BufferHandle depths;                  // optical depth of grids; null: no grids
    fg::BufferHandle pathsOnSurfaces, pathsInMedia; // CompensationLight
};

/// Declares that a pass reads them; the result is what bindVpls() takes.
[[nodiscard]] VplBuffers readVpls(fg::Builder& builder, const VplBuffers& buffers);

/// For shaders that include gi/vpl/lights.glsl.
template <typename Command>
Command& bindVpls(Command& command, const VplBuffers& buffers, const gpu::VplParams& params) {
    return bindTraced(command, buffers.traced)
        .params(params, "Vpl")
        .bind("VplLights", buffers.lights)
        .bind("VplWalks", buffers.walks)
        .bind("VplMaps", buffers.maps)
        .bind("VplDepths", buffers.depths);
}

/// Data to upload; they must live until the frame has been executed. `lightsKey`, `mapsKey`, `pathsKey`: of its content.
struct VplUpload {
    const VplSet* set = nullptr;
    const std::vector<uint32_t>* maps = nullptr; // maps by rays
    const SurfacePoints* points = nullptr;       // not empty: maps are splatted from them
    TracedBuffers traced;
    const std::vector<vec4>*pathsOnSurfaces = nullptr, *pathsInMedia = nullptr; // empty: no paths
    uint64_t lightsKey = 0, mapsKey = 0, pathsKey = 0;
};

/// How lights are gathered.
struct VplGather {
    gpu::VplParams params{};
    int surfaceFactor = 1, mediaFactor = 1; // pixels along an edge of the squares that gather once
    uint32_t pointsATurn = 1; // along a ray through media (vpl_rounds.h)
};

[[nodiscard]] VplBuffers addVplUpload(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                      const VplUpload& upload, const gpu::VplParams& params);

/// View-sized RGBA32F nits that leave surfaces towards the eye.
[[nodiscard]] fg::TextureHandle addVplSurfaces(fg::FrameGraph& graph,
                                               const plugin::FrameInputs& inputs,
                                               const VplBuffers& lights, const VplGather& gather);

/// View-sized RGBA32F nits that reach the eye from media. Skipped where there are none.
[[nodiscard]] fg::TextureHandle addVplMedia(fg::FrameGraph& graph,
                                            const plugin::FrameInputs& inputs,
                                            const VplBuffers& lights, const VplGather& gather);

} // namespace tyndall::volumetric_gi
