#pragma once
// Debug views of the surfels: gi.surfels.show.

#include "volumetric_gi/surfels/interval_map.h"
#include "volumetric_gi/surfels/surfel_splats.h"

namespace tyndall::volumetric_gi {

/// What a frame has made. Null handles: it has not.
struct SurfelsOfFrame {
    SurfelLight surfels;
    fg::BufferHandle interleave;
    SurfelIntervals map;
    fg::TextureHandle levels; // of the light in media
};

/// Adds the pass `gi.surfels.show`. `what`: kSurfelShowDisks and so on. The new picture, or `color` where there is nothing to show.
[[nodiscard]] fg::TextureHandle addSurfelsShow(fg::FrameGraph& graph,
                                               const plugin::FrameInputs& inputs,
                                               const SurfelsOfFrame& made, uint32_t what,
                                               fg::TextureHandle color);

} // namespace tyndall::volumetric_gi
