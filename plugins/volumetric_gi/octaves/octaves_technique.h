#pragma once
// The baseline technique: multiple scattering as octaves of single scattering (Wrenninge, Kulla and Lundqvist 2013, "Oz: The
// Great and Volumetric"). Octave i scatters scatteringFactor^i as much, lets light through extinctionFactor^i of the
// optical depth and scatters with phaseFactor^i of the anisotropy; bounded when scatteringFactor ≤ extinctionFactor.
// Roughly LVVE and LXVVE together: it knows neither surfaces nor where the light was scattered before.

#include "volumetric_gi/shared/gi_technique.h"

namespace tyndall::volumetric_gi {

struct OctavesSettings {
    int32_t count;
    float scatteringFactor, extinctionFactor, phaseFactor;
};

class OctavesTechnique final : public GiTechnique {
public:
    using GiTechnique::GiTechnique;
    const plugin::TechniqueInfo& info() const override;
    plugin::SettingsTable settings() override;
    /// The octaves 1 … count. Skipped if no medium scatters or count is 0. It has no paper mode of its own.
    plugin::FrameOutputs addPasses(fg::FrameGraph& graph,
                                   const plugin::FrameInputs& inputs) override;

private:
    OctavesSettings settings_{};
};

} // namespace tyndall::volumetric_gi
