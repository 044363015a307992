#pragma once
// LVVE, light that media scatter twice, from light that they scatter once: around each point of the eye's ray the media are taken
// to be lit as they are there. docs/techniques/@name@.md says when that is accurate.

#include "volumetric_gi/shared/gi_technique.h"

namespace tyndall::volumetric_gi {

struct @Name@Settings {
    int32_t directions;
};

class @Name@Technique final : public GiTechnique {
public:
    using GiTechnique::GiTechnique;
    const plugin::TechniqueInfo& info() const override;
    plugin::SettingsTable settings() override;
    /// One march along the eye's rays. Skipped where there is no medium or no light. It has no paper mode.
    plugin::FrameOutputs addPasses(fg::FrameGraph& graph,
                                   const plugin::FrameInputs& inputs) override;

private:
    @Name@Settings settings_{};
};

} // namespace tyndall::volumetric_gi
