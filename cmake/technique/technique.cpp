#include "volumetric_gi/@name@/@name@_technique.h"

#include "shared/@name@.h"

namespace tyndall::volumetric_gi {
namespace {

const SettingDesc k@Name@Settings[] = {
    TYNDALL_INT(
        @Name@Settings, directions, "@name@.directions", "Directions", "", 1, 32, 2,
        "Directions in which each segment of a ray looks at the media around; more are less noisy and take longer."),
};

constexpr PresetEntry k@Name@Presets[] = {
    {Quality::Low, "@name@.directions", "1"},
    {Quality::Medium, "@name@.directions", "2"},
    {Quality::High, "@name@.directions", "4"},
    {Quality::Ultra, "@name@.directions", "8"},
};

} // namespace

const plugin::TechniqueInfo& @Name@Technique::info() const {
    static constexpr plugin::TechniqueInfo kInfo{
        .name = "@name@",
        .title = "@title@",
        .help = "Light that media scatter twice, as if the media around a point were lit like the point itself.",
        .claims = bit(Term::LVVE),
        .sets = nullptr,
        .setCount = 0,
        .media = kAllMedia,
        .separatesMedia = 0,
        .automatic = 0, // measure it first: docs/benchmarks.md
        .cost = 2,
        .errorOnSurfaces = 1, // it has no light for them
        .errorInMedia = 0.12f};
    return kInfo;
}

plugin::SettingsTable @Name@Technique::settings() {
    return table(k@Name@Settings, &settings_, k@Name@Presets);
}

plugin::FrameOutputs @Name@Technique::addPasses(fg::FrameGraph& graph,
                                                const plugin::FrameInputs& inputs) {
    struct Data {
        ViewResources view;
        LightResources lights;
        MediaResources media;
        fg::TextureHandle depth, inScatter;
        gpu::@Name@Params params;
    };
    plugin::FrameOutputs outputs;
    outputs.inMedia = graph
        .addPass<Data>(
            "gi.@name@.march",
            [&](fg::Builder& builder, Data& data) {
                if (inputs.media.count == 0) return builder.skip("no medium in the scene");
                if (inputs.lights.lightCount == 0) return builder.skip("no light in the scene");
                data.view = inputs.view;
                data.lights = readLights(builder, inputs.lights);
                data.media = readMedia(builder, inputs.media);
                data.depth = builder.read(inputs.gbuffer.depth);
                data.inScatter = builder.create(
                    "gi.@name@.inScatter",
                    fg::texture2D(fg::Format::RGBA32F, inputs.view.width, inputs.view.height));
                data.params = {inputs.lights.lightCount, uint32_t(settings_.directions), 0, 0};
            },
            [](const Data& data, fg::PassContext& context) {
                auto command = context.compute("gi/@name@/march.comp",
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

std::unique_ptr<GiTechnique> make@Name@(SharedParts& shared) {
    return std::make_unique<@Name@Technique>(shared);
}

} // namespace tyndall::volumetric_gi
