#pragma once
// Virtual lights to be looked at.

#include "volumetric_gi/vpl/vpl_gather.h"
#include "volumetric_gi/vpl/vpl_settings.h"

namespace tyndall::volumetric_gi {

/// What was gathered in this frame; null where nothing was.
struct VplGathered {
    fg::TextureHandle surfaces, media;
};

/// The finished picture with what `settings.show` asks for in it; `color` itself where that is nothing. `radius`: of a ball, metres.
[[nodiscard]] fg::TextureHandle addVplShow(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                           const VplSettings& settings, const VplBuffers& lights,
                                           const gpu::VplParams& params, float radius,
                                           const VplGathered& gathered, fg::TextureHandle color);

} // namespace tyndall::volumetric_gi
