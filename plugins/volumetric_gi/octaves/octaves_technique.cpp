#include "volumetric_gi/octaves/octaves_technique.h"

#include "shared/octaves.h"

namespace tyndall::volumetric_gi {
namespace {

const SettingDesc kOctavesSettings[] = {
    TYNDALL_INT(OctavesSettings, count, "octaves.count", "Octaves", "", 0, 16, 7,
                "Octaves beyond single scattering; 0 turns the technique off."),
    TYNDALL_FLOAT(
        OctavesSettings, scatteringFactor, "octaves.scatteringFactor", "Scattering factor", "", 0,
        1, 0.5,
        "Each octave scatters so much of the one before; energy stays bounded while it is no larger than the extinction factor."),
    TYNDALL_FLOAT(OctavesSettings, extinctionFactor, "octaves.extinctionFactor",
                  "Extinction factor", "", 0, 1, 0.5,
                  "Each octave's light meets so much of the optical depth of the one before."),
    TYNDALL_FLOAT(OctavesSettings, phaseFactor, "octaves.phaseFactor", "Phase factor", "", 0, 1,
                  0.5, "Each octave scatters with so much of the anisotropy of the one before."),
};

constexpr PresetEntry kOctavesPresets[] = {
    {Quality::Low, "octaves.count", "3"},
    {Quality::Medium, "octaves.count", "5"},
    {Quality::High, "octaves.count", "7"},
    {Quality::Ultra, "octaves.count", "10"},
};

} // namespace

const plugin::TechniqueInfo& OctavesTechnique::info() const {
    static constexpr TermSet kSets[] = {terms(Term::LVVE, Term::LXVVE)};
    static constexpr plugin::TechniqueInfo kInfo{
        .name = "octaves",
        .title = "Octaves of multiple scattering",
        .help = "Baseline: multiple scattering as reduced copies of single scattering, inside the march.",
        .claims = kSets[0],
        .sets = kSets,
        .setCount = 1,
        .media = kAllMedia,
        .separatesMedia = 1,
        .automatic = 1,
        .cost = 4,
        .errorOnSurfaces = 1,
        .errorInMedia = 0.44f};
    return kInfo;
}

plugin::SettingsTable OctavesTechnique::settings() {
    return table(kOctavesSettings, &settings_, kOctavesPresets);
}

plugin::FrameOutputs OctavesTechnique::addPasses(fg::FrameGraph& graph,
                                                 const plugin::FrameInputs& inputs) {
    const OctavesSettings& settings = settings_;
    struct Data {
        ViewResources view;
        LightResources lights;
        MediaResources media;
        fg::TextureHandle depth, inScatter;
        gpu::OctavesParams params;
    };
    plugin::FrameOutputs outputs;
    outputs.inMedia = graph
        .addPass<Data>(
            "gi.octaves.march",
            [&](fg::Builder& builder, Data& data) {
                if (inputs.media.count == 0) return builder.skip("no medium in the scene");
                if (settings.count == 0) return builder.skip("setting octaves.count is 0");
                if (inputs.lights.lightCount == 0) return builder.skip("no light in the scene");
                data.view = inputs.view;
                data.lights = readLights(builder, inputs.lights);
                data.media = readMedia(builder, inputs.media);
                data.depth = builder.read(inputs.gbuffer.depth);
                data.inScatter = builder.create(
                    "gi.octaves.inScatter",
                    fg::texture2D(fg::Format::RGBA32F, inputs.view.width, inputs.view.height));
                data.params = {inputs.lights.lightCount,
                               uint32_t(settings.count),
                               settings.scatteringFactor,
                               settings.extinctionFactor,
                               settings.phaseFactor,
                               inputs.kinds,
                               0,
                               0};
            },
            [](const Data& data, fg::PassContext& context) {
                auto command = context.compute("gi/octaves/march.comp",
                                               {{"PHASE_GROUPS", int32_t(data.media.phaseGroups)},
                                                {"MEDIA_KINDS", mediaKinds(data.media, true)},
                                                {"SOFT_SHADOWS", data.lights.softShadows}});
                bindView(command, data.view);
                bindLights(command, data.lights);
                bindMedia(command, data.media);
                command.bind("depth", data.depth)
                    .bind("inScatter", data.inScatter)
                    .params(data.params)
                    .dispatchOver(data.inScatter);
            })
        .inScatter;
    return outputs;
}

std::unique_ptr<GiTechnique> makeOctaves(SharedParts& shared) {
    return std::make_unique<OctavesTechnique>(shared);
}

} // namespace tyndall::volumetric_gi
