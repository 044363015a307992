#pragma once
// Light of surfels in the intervals of eye rays: splats into the interleaved framebuffer, and back to pixels.

#include "volumetric_gi/shared/traced_scene.h"
#include "volumetric_gi/surfels/interval_map.h"
#include "volumetric_gi/surfels/surfel_points.h"

namespace tyndall::volumetric_gi {

struct SplatRequest {
    SurfelLight surfels;
    SurfelIntervals map;
    fg::BufferHandle interleave; // interleaveTables()
    TracedBuffers traced;        // null handles: visibility is not asked for
    Bounds media;                // render space; empty: everywhere
    uint32_t levels = 1;
    double threshold = 0;
    SurfelRays rays = SurfelRays::None;
    bool attenuation = false, visibility = false;
    bool paper = false; // as printed
    double nearest = 0; // δ of the printed kernel, m²
    bool blur = false;
    uint64_t chance = 0; // of this frame
};

struct SurfelSplats {
    fg::TextureHandle levels; // RGBA32F array, a layer a level: nits that reach the eye, w: how many surfels have come to the ray
    fg::BufferHandle draws;   // fg::DrawArguments of each level: six vertices a surfel
};

/// Adds the passes `gi.surfels.list` and `gi.surfels.splat`.
[[nodiscard]] SurfelSplats addSurfelSplats(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                           const SplatRequest& request);

/// Numbers about a frame, in this order: of lit surfels, of quads drawn, of pairs of a surfel and a ray, of surfels, and what their sizes have grown by.
constexpr uint32_t kSurfelCounts = 5;

/// Adds the pass `gi.surfels.count`: float[kSurfelCounts]. `of`: the last two, which must live until the frame has been executed.
[[nodiscard]] fg::BufferHandle addSurfelCounts(fg::FrameGraph& graph,
                                               const plugin::FrameInputs& inputs,
                                               const SplatRequest& request,
                                               const SurfelSplats& splats, const float (&of)[2]);

/// Adds the passes `gi.surfels.collect` and `gi.surfels.upsample`. View-sized RGBA32F nits that reach the eye.
[[nodiscard]] fg::TextureHandle addSurfelCollect(fg::FrameGraph& graph,
                                                 const plugin::FrameInputs& inputs,
                                                 const SplatRequest& request,
                                                 fg::TextureHandle levels);

} // namespace tyndall::volumetric_gi
