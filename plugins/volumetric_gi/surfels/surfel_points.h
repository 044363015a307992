#pragma once
// Surfels on the GPU: their tessellation and their light.

#include "plugin/plugin_api.h"
#include "shared/surfels.h"
#include "volumetric_gi/surfels/surfel_patches.h"
#include "volumetric_gi/surfels/surfels_settings.h"

namespace tyndall::volumetric_gi {

/// Adds the pass `gi.surfels.tessellate`: Surfel[plan.surfels]. `plan` must live until the frame has been executed; `key`: of it.
[[nodiscard]] fg::BufferHandle addSurfels(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                          const SurfelPlan& plan, Surfelizer surfelizer,
                                          uint64_t key);

struct SurfelLight {
    fg::BufferHandle lit;        // LitSurfel[]
    fg::BufferHandle brightness; // SurfelBrightness
    uint32_t count = 0;
};

/// Adds the passes `gi.surfels.light` and `gi.surfels.brightness`: light that lights of the scene send to surfels through media and past surfaces.
[[nodiscard]] SurfelLight addSurfelLight(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                         fg::BufferHandle surfels, uint32_t count);

} // namespace tyndall::volumetric_gi
