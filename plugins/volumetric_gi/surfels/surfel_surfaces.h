#pragma once
// Light of surfels on the surfaces of pixels.

#include "volumetric_gi/surfels/surfel_splats.h"

namespace tyndall::volumetric_gi {

/// Adds the passes `gi.surfels.splatSurfaces` and `gi.surfels.collectSurfaces`. View-sized RGBA32F nits that leave surfaces towards the eye.
[[nodiscard]] fg::TextureHandle addSurfaceSplats(fg::FrameGraph& graph,
                                                 const plugin::FrameInputs& inputs,
                                                 const SplatRequest& request,
                                                 const SplatList& list);

} // namespace tyndall::volumetric_gi
