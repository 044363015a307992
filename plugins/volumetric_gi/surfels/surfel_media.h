#pragma once
// Light of surfels that media scatter to the eye.

#include "volumetric_gi/surfels/interval_map.h"
#include "volumetric_gi/surfels/surfel_splats.h"

namespace tyndall::volumetric_gi {

/// Adds the pass `gi.surfels.splat`. As splatLevels(): nits that reach the eye.
[[nodiscard]] fg::TextureHandle addMediaSplats(fg::FrameGraph& graph,
                                               const plugin::FrameInputs& inputs,
                                               const SplatRequest& request,
                                               const SurfelIntervals& map, const SplatList& list);

/// Adds the passes `gi.surfels.collect` and `gi.surfels.upsample`. View-sized RGBA32F nits that reach the eye.
[[nodiscard]] fg::TextureHandle addMediaCollect(fg::FrameGraph& graph,
                                                const plugin::FrameInputs& inputs,
                                                const SplatRequest& request,
                                                const SurfelIntervals& map,
                                                fg::TextureHandle levels);

} // namespace tyndall::volumetric_gi
