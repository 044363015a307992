#pragma once
// Debug views of virtual lights.

#include "volumetric_gi/vpl/vpl_gather.h"
#include "volumetric_gi/vpl/vpl_settings.h"

namespace tyndall::volumetric_gi {

/// Images gathered in this frame; null where there are none.
struct VplGathered {
    fg::TextureHandle surfaces, media;
};

/// The finished picture with the view that `settings.show` selects; `color` itself if it selects none. `radius`: of a ball, metres.
[[nodiscard]] fg::TextureHandle addVplShow(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                           const VplSettings& settings, const VplBuffers& lights,
                                           const gpu::VplParams& params, float radius,
                                           const VplGathered& gathered, fg::TextureHandle color);

} // namespace tyndall::volumetric_gi
