#pragma once
// One lattice: what it is made of, and the steps that light takes in it.

#include "plugin/plugin_api.h"
#include "volumetric_gi/lpv/lattice_placement.h"

namespace tyndall::volumetric_gi {

struct Lattice {
    LatticeLevel level;
    fg::BufferHandle medium, links, sources, flux, fluxBefore; // LpvMedium and so on, shared/lpv.h
};

/// What the media are in each cell. Kept while they and the lattice stay.
[[nodiscard]] fg::BufferHandle addLatticeMedium(fg::FrameGraph& graph,
                                                const plugin::FrameInputs& inputs,
                                                const LatticeLevel& level);

/// Which ways between cells surfaces cross. Kept while they and the lattice stay.
[[nodiscard]] fg::BufferHandle addLatticeLinks(fg::FrameGraph& graph,
                                               const plugin::FrameInputs& inputs,
                                               const LatticeLevel& level);

/// Adds the light that comes in from the coarser lattice around it to the sources; returns their next version.
[[nodiscard]] fg::BufferHandle addInflow(fg::FrameGraph& graph, const Lattice& lattice,
                                         const Lattice& outer);

struct Flux {
    fg::BufferHandle now, before; // LpvFlux after the last step and before it
};
struct StepsRequest {
    int lattice;     // number among the lattices, the coarsest is 0
    int most;        // steps; fewer where light is settled before
    float tolerance; // it is when what is left to come, over what there is, is estimated to be less
    bool
        goOn; // from where the last frame left the light; else from that of the coarser lattice around it, or from darkness
    bool ledger; // fill in where the power goes
};
/// Propagates light. `control`: LpvControl of each lattice, its next version on return.
[[nodiscard]] Flux addSteps(fg::FrameGraph& graph, const Lattice& lattice, const Lattice* outer,
                            const StepsRequest& request, fg::BufferHandle& control);

} // namespace tyndall::volumetric_gi
