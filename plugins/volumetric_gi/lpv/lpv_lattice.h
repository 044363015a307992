#pragma once
// One lattice: its buffers and its propagation steps.

#include "plugin/plugin_api.h"
#include "volumetric_gi/lpv/lattice_placement.h"

namespace tyndall::volumetric_gi {

struct Lattice {
    LatticeLevel level;
    fg::BufferHandle medium, links, sources, flux, fluxBefore; // LpvMedium and so on, shared/lpv.h
};

/// The media of each cell. Cached while they and the lattice stay the same.
[[nodiscard]] fg::BufferHandle addLatticeMedium(fg::FrameGraph& graph,
                                                const plugin::FrameInputs& inputs,
                                                const LatticeLevel& level);

/// The links between cells that surfaces block. Cached while they and the lattice stay the same.
[[nodiscard]] fg::BufferHandle addLatticeLinks(fg::FrameGraph& graph,
                                               const plugin::FrameInputs& inputs,
                                               const LatticeLevel& level);

/// Adds the light that enters from the coarser lattice around it to the sources; returns their next version.
[[nodiscard]] fg::BufferHandle addInflow(fg::FrameGraph& graph, const Lattice& lattice,
                                         const Lattice& outer);

struct Flux {
    fg::BufferHandle now, before; // LpvFlux after the last step and before it
};
struct StepsRequest {
    int lattice;     // number among the lattices, the coarsest is 0
    int most;        // maximum steps; fewer if light settles before
    float tolerance; // light is settled when the estimated remaining light, over the light that is there, is less
    bool
        goOn; // continue the last frame's light; else begin with the light of the coarser lattice around it, or with none
    bool ledger; // fill in the energy balance
};
/// Propagates light. `control`: LpvControl of each lattice, its next version on return.
[[nodiscard]] Flux addSteps(fg::FrameGraph& graph, const Lattice& lattice, const Lattice* outer,
                            const StepsRequest& request, fg::BufferHandle& control);

} // namespace tyndall::volumetric_gi
