#include "volumetric_gi/octaves/octaves_technique.h"

#include "shared/octaves.h"
#include "volumetric_gi/shared/lit_march.h"

namespace tyndall::volumetric_gi {
namespace {

const SettingDesc kOctavesSettings[] = {
    TYNDALL_INT(
        OctavesSettings, count, "gi.octaves.count", "Octaves", "", 0, 16, 5,
        "Octaves beyond single scattering. More brighten the inside of dense media and cost march time; 0 turns the technique off."),
    TYNDALL_FLOAT(
        OctavesSettings, scatteringFactor, "gi.octaves.scatteringFactor", "Scattering factor", "", 0,
        1, 0.5,
        "Scattering of each octave over that of the one before. Higher is brighter; energy stays bounded if it is at most the extinction factor."),
    TYNDALL_FLOAT(
        OctavesSettings, extinctionFactor, "gi.octaves.extinctionFactor", "Extinction factor", "", 0,
        1, 0.5,
        "Optical depth to the light of each octave over that of the one before. Lower lets light reach deeper."),
    TYNDALL_FLOAT(
        OctavesSettings, phaseFactor, "gi.octaves.phaseFactor", "Phase factor", "", 0, 1, 0.5,
        "Anisotropy of each octave over that of the one before. Higher keeps the direction of light longer."),
};

constexpr PresetEntry kOctavesPresets[] = {
    {Quality::Low, "gi.octaves.count", "3"},
    {Quality::Medium, "gi.octaves.count", "5"},
    {Quality::High, "gi.octaves.count", "7"},
    {Quality::Ultra, "gi.octaves.count", "10"},
};

} // namespace

const plugin::TechniqueInfo& OctavesTechnique::info() const {
    static constexpr TermSet kSets[] = {terms(Term::LVVE, Term::LXVVE)};
    static constexpr plugin::TechniqueInfo kInfo{
        .name = "octaves",
        .title = "Octaves of multiple scattering",
        .help =
            "Baseline: estimates multiple scattering in media by reduced copies of single scattering.",
        .claims = kSets[0],
        .sets = kSets,
        .setCount = 1,
        .media = kAllMedia,
        .separatesMedia = 1,
        .automatic = 1,
        .expected = {{1, 1, 1}, {4, 1, 7.5f}, {4, 1, 6.9f}, {4, 1, 0.03f}}};
    return kInfo;
}

plugin::SettingsTable OctavesTechnique::settings() {
    return table(kOctavesSettings, &settings_, kOctavesPresets);
}

plugin::FrameOutputs OctavesTechnique::addPasses(fg::FrameGraph& graph,
                                                 const plugin::FrameInputs& inputs) {
    const gpu::OctavesParams params{uint32_t(settings_.count), settings_.scatteringFactor,
                                    settings_.extinctionFactor, settings_.phaseFactor};
    plugin::FrameOutputs outputs;
    outputs.inMedia = addLitMarch(
        graph, inputs, {"gi.octaves.march", "gi.octaves.inScatter", "gi/octaves/march.comp"},
        params, settings_.count == 0 ? "setting gi.octaves.count is 0" : nullptr);
    return outputs;
}

std::unique_ptr<GiTechnique> makeOctaves(SharedParts& shared) {
    return std::make_unique<OctavesTechnique>(shared);
}

} // namespace tyndall::volumetric_gi
