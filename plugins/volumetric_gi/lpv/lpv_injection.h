#pragma once
// Injection: the texels of reflective shadow maps add to fixed-point deposits, and deposits become the sources of a step.

#include "plugin/plugin_api.h"
#include "shared/lpv.h"
#include "volumetric_gi/lpv/lpv_settings.h"
#include "volumetric_gi/rsm/rsm_views.h"

namespace tyndall::volumetric_gi {

struct Injection {
    fg::BufferHandle medium, links, deposits;
    gpu::LpvParams params;
    gpu::LpvInjectParams inject; // its scale; addInjection() fills in the rest
};

/// A reflective shadow map.
struct Rsm {
    ViewResources view;
    GBuffer surfaces;
    RsmView from;
};
[[nodiscard]] Rsm addRsm(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                         const RsmView& from);

/// LpvDeposits of the lattice number `index`, from frame to frame.
[[nodiscard]] fg::PersistentBuffer keptDeposits(fg::FrameGraph& graph, int index, uint64_t cells);
/// Sets them to 0; returns their next version.
[[nodiscard]] fg::BufferHandle addClear(fg::FrameGraph& graph, fg::BufferHandle deposits);

/// Adds a map's light to the deposits; returns their next version.
[[nodiscard]] fg::BufferHandle addInjection(fg::FrameGraph& graph,
                                            const plugin::FrameInputs& inputs,
                                            const LpvSettings& settings, const Rsm& rsm,
                                            const Injection& injection);

/// LpvSources of all deposits; does not need medium and links.
[[nodiscard]] fg::BufferHandle addCollection(fg::FrameGraph& graph, const Injection& injection,
                                             uint64_t cells);

} // namespace tyndall::volumetric_gi
