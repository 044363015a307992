#pragma once
// Light propagation volumes (Billeter, Sintorn and Assarsson 2012), corrected: light that surfaces reflect and media scatter once
// is injected into lattices and propagated with extinction and scattering. docs/techniques/lpv-explained.md explains it.

#include <array>
#include <string>
#include <vector>

#include "shared/lpv.h"
#include "volumetric_gi/lpv/lpv_lattice.h"
#include "volumetric_gi/lpv/lpv_light.h"
#include "volumetric_gi/lpv/lpv_settings.h"
#include "volumetric_gi/rsm/rsm_views.h"
#include "volumetric_gi/shared/gi_technique.h"

namespace tyndall::volumetric_gi {

class LpvTechnique final : public GiTechnique {
public:
    using GiTechnique::GiTechnique;
    const plugin::TechniqueInfo& info() const override;
    plugin::SettingsTable settings() override;
    /// Light of the lattices on surfaces and in media, for `inputs.terms`: all of it, or light that surfaces or media (or both) have
    /// scattered once before. Logs once how many lights have no map.
    /// gi.mode=paper: the scheme as the paper prints it, in one lattice around the scene and from nothing in each frame.
    plugin::FrameOutputs addPasses(fg::FrameGraph& graph,
                                   const plugin::FrameInputs& inputs) override;
    /// A slice of the finest lattice, if settings select one.
    fg::TextureHandle addDebugView(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                   fg::TextureHandle color) override;

private:
    void addSources(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                    std::vector<Lattice>& lattices, const LpvSettings& settings);
    LatticeLight addLight(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                          std::vector<Lattice>& lattices, const SharedPlaces& places,
                          fg::BufferHandle& control);
    void nameStatistics(size_t lattices);
    [[nodiscard]] uint64_t sourceKey(const plugin::FrameInputs& inputs, uint64_t place) const;

    LpvSettings settings_{};
    uint32_t saidLeftOut_ = 0; // lights without maps, when last logged
    // sourceKey() of the contents of the deposits and of the flux buffers.
    std::array<uint64_t, gpu::kLpvMostLevels> depositKeys_{}, stateKeys_{};
    Lattice finest_; // of this frame
    LatticeLight light_;
    std::vector<std::string> statisticNames_;
    std::vector<plugin::Statistic> statistics_;
};

} // namespace tyndall::volumetric_gi
