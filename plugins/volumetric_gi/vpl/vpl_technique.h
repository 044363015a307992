#pragma once
// Instant multiple scattering (Engelhardt, Novák and Dachsbacher 2010): virtual point lights of random walks through surfaces and media, gathered on
// surfaces and along eye rays, with clamping and bias compensation. docs/techniques/vpl-explained.md explains it.

#include <array>
#include <string>
#include <vector>

#include "volumetric_gi/shared/gi_technique.h"
#include "volumetric_gi/vpl/vpl_gather.h"
#include "volumetric_gi/vpl/compensation_light.h"
#include "volumetric_gi/vpl/vpl_settings.h"
#include "volumetric_gi/vpl/vpl_show.h"

namespace tyndall::volumetric_gi {

class VplTechnique final : public GiTechnique {
public:
    using GiTechnique::GiTechnique;
    const plugin::TechniqueInfo& info() const override;
    plugin::SettingsTable settings() override;
    /// Light of virtual lights on surfaces and in media, for `inputs.terms`.
    plugin::FrameOutputs addPasses(fg::FrameGraph& graph,
                                   const plugin::FrameInputs& inputs) override;
    /// Debug views, where settings select one.
    fg::TextureHandle addDebugView(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                   fg::TextureHandle color) override;

private:
    fg::BufferHandle addStatistics(fg::FrameGraph& graph);
    void makeLights(const plugin::FrameInputs& inputs);
    void makeMaps(uint32_t generation);
    void renewSome(const WalkOrder& order, uint64_t lightsKey);
    void choose(const plugin::FrameInputs& inputs, const WalkOrder& order, uint32_t candidates);
    [[nodiscard]] bool followsWhatIsMissed(const plugin::FrameInputs& inputs) const;
    void makePathLight(const plugin::FrameInputs& inputs);
    void setClamps(const plugin::FrameInputs& inputs, gpu::VplParams& params) const;
    [[nodiscard]] VplGather gather(const plugin::FrameInputs& inputs) const;

    VplSettings settings_{}, used_{}; // used_: in this frame, as gi.mode has it
    TracedScene& scene_ = shared_.traced;
    VplSet set_;
    std::vector<uint32_t> maps_; // of rays
    SurfacePoints points_;       // for maps that are splatted
    Walks walks_;                // through proxy media, if those are used
    uint64_t lightsKey_ = 0, walksKey_ = 0;
    uint64_t turnsKey_ = 0,
             wantedKey_ =
                 0; // of the inputs of all walks, and of the wanted lights
    uint32_t stale_ = 0,
             nextTurn_ = 0;    // walks of an earlier scene; the next one to renew
    uint32_t walksTraced_ = 0; // in this frame
    uint64_t pathLightVersion_ = 0;
    CompensationLight pathLight_; // light of compensation paths
    struct {
        float walks = 0, choice = 0, maps = 0, near = 0;
    } times_; // of this frame, milliseconds
    std::string said_;
    VplBuffers buffers_; // of this frame
    VplGather gather_;
    VplGathered gathered_;
    std::array<float, 9> statistics_{};
};

} // namespace tyndall::volumetric_gi
