#pragma once
// Virtual point lights on the GPU: their buffers, and what they do in the picture.

#include "plugin/plugin_api.h"
#include "shared/vpl.h"
#include "volumetric_gi/vpl/vpl_walks.h"

namespace tyndall::volumetric_gi {

struct VplBuffers {
    fg::BufferHandle lights, walks, maps, planes;
};

/// What goes up; must live until the frame has been executed. `lightsKey`, `planesKey`: of its content.
struct VplUpload {
    const VplSet* set = nullptr;
    const std::vector<uint32_t>* maps = nullptr;
    const std::vector<vec4>* planes = nullptr;
    uint64_t lightsKey = 0, planesKey = 0;
};

[[nodiscard]] VplBuffers addVplUpload(fg::FrameGraph& graph, const VplUpload& upload);

/// View-sized RGBA32F nits that leave surfaces towards the eye.
[[nodiscard]] fg::TextureHandle addVplSurfaces(fg::FrameGraph& graph,
                                               const plugin::FrameInputs& inputs,
                                               const VplBuffers& lights,
                                               const gpu::VplParams& params);

/// View-sized RGBA32F nits that reach the eye from media. Skipped where there are none.
[[nodiscard]] fg::TextureHandle addVplMedia(fg::FrameGraph& graph,
                                            const plugin::FrameInputs& inputs,
                                            const VplBuffers& lights, const gpu::VplParams& params);

} // namespace tyndall::volumetric_gi
