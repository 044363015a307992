#pragma once
// Light that surfaces scatter into media: surfels, splatted onto intervals of eye rays in an interleaved framebuffer. docs/techniques/surfels.md says how it works.

#include <string>
#include <vector>

#include "volumetric_gi/shared/gi_technique.h"
#include "volumetric_gi/surfels/surfel_patches.h"
#include "volumetric_gi/surfels/interval_map.h"
#include "volumetric_gi/surfels/surfel_splats.h"
#include "volumetric_gi/surfels/surfels_settings.h"
#include "volumetric_gi/surfels/surfels_show.h"

namespace tyndall::volumetric_gi {

class SurfelsTechnique final : public GiTechnique {
public:
    explicit SurfelsTechnique(SharedParts& shared) : GiTechnique(shared), scene_(shared.traced) {}
    const plugin::TechniqueInfo& info() const override;
    plugin::SettingsTable settings() override;
    plugin::FrameOutputs addPasses(fg::FrameGraph& graph,
                                   const plugin::FrameInputs& inputs) override;
    fg::TextureHandle addDebugView(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                   fg::TextureHandle color) override;

private:
    /// Why there is nothing to do in this frame; null where there is.
    const char* whyNothing(const plugin::FrameInputs& inputs);
    void makePlan(const plugin::FrameInputs& inputs);
    void updateTriangles(const plugin::FrameInputs& inputs);
    [[nodiscard]] Bounds mediaBounds() const;
    /// The surfels of this frame and how they are splatted, on whatever receives their light.
    SplatRequest splats(fg::FrameGraph& graph, const plugin::FrameInputs& inputs);
    void addMedia(fg::FrameGraph& graph, const plugin::FrameInputs& inputs, SplatRequest request,
                  plugin::FrameOutputs& outputs);
    [[nodiscard]] IntervalRequest intervals(const plugin::FrameInputs& inputs) const;

    SurfelsSettings settings_{};
    SurfelsSettings used_{}; // in this frame
    TracedScene& scene_;
    std::vector<dvec3> corners_; // of all triangles, render space
    std::vector<SurfelTriangles> triangles_;
    uint64_t trianglesKey_ = 0;
    SurfelPlan plan_;
    uint64_t planKey_ = 0;
    float numbers_[2] = {}; // for the frame's statistics
    SurfelsOfFrame made_; // handles of this frame alone
    std::vector<uint32_t> interleave_;
    std::string said_; // the last failure
};

} // namespace tyndall::volumetric_gi
