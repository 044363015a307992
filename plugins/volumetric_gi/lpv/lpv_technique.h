#pragma once
// Light propagation volumes (Billeter, Sintorn and Assarsson 2012), corrected: a lattice that is seeded with the light that surfaces reflect
// and media scatter once, and in which it is propagated with extinction and scattering. docs/techniques/lpv.md tells how.

#include "plugin/plugin_api.h"
#include "shared/lpv.h"
#include "volumetric_gi/lpv/lpv_settings.h"
#include "volumetric_gi/rsm/rsm_views.h"

namespace tyndall::volumetric_gi {

class LpvTechnique {
public:
    [[nodiscard]] LpvSettings& settings() { return settings_; }
    /// Light of the lattice on surfaces and in media, as far as `inputs.terms` asks for it.
    /// Says once through `host` how many lights have no map.
    plugin::FrameOutputs addPasses(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                   plugin::Host& host);

private:
    struct Lattice {
        fg::BufferHandle medium, sources, links, flux;
    };
    fg::BufferHandle addMedium(fg::FrameGraph& graph, const plugin::FrameInputs& inputs) const;
    fg::BufferHandle addLinks(fg::FrameGraph& graph, const plugin::FrameInputs& inputs) const;
    fg::BufferHandle addSources(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                const Lattice& lattice, plugin::Host& host);
    fg::BufferHandle addSteps(fg::FrameGraph& graph, const Lattice& lattice, uint64_t key);
    [[nodiscard]] uint64_t sourceKey(const plugin::FrameInputs& inputs) const;

    LpvSettings settings_{};
    gpu::LpvParams params_{};
    uint64_t cells_ = 0;
    uint64_t latticeKey_ = 0;  // of place and size
    uint32_t saidLeftOut_ = 0; // lights without maps, when it was last said
    uint64_t stateKey_ = 0;    // sourceKey() of what is in the flux buffers
};

} // namespace tyndall::volumetric_gi
