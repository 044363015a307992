#include "volumetric_gi/@name@/@name@_technique.h"

#include "shared/@name@.h"
#include "volumetric_gi/shared/lit_march.h"

namespace tyndall::volumetric_gi {
namespace {

const SettingDesc k@Name@Settings[] = {
    TYNDALL_INT(
        @Name@Settings, directions, "@name@.directions", "Directions", "", 1, 32, 2,
        "Directions in which each segment of a ray samples the media around it. More are less noisy and slower."),
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
        .automatic = 0, // measure it first: tests/bench/harness.py
        // Time over that of direct light alone; relmse on surfaces, for which it has no light, and in media: by kind of scene (transport/scene_class.h).
        .expected = {{2, 1, 1}, {2, 1, 0.12f}, {2, 1, 0.12f}, {2, 1, 0.12f}}};
    return kInfo;
}

plugin::SettingsTable @Name@Technique::settings() {
    return table(k@Name@Settings, &settings_, k@Name@Presets);
}

plugin::FrameOutputs @Name@Technique::addPasses(fg::FrameGraph& graph,
                                                const plugin::FrameInputs& inputs) {
    const gpu::@Name@Params params{uint32_t(settings_.directions), 0, 0, 0};
    plugin::FrameOutputs outputs;
    outputs.inMedia = addLitMarch(
        graph, inputs, {"gi.@name@.march", "gi.@name@.inScatter", "gi/@name@/march.comp"}, params);
    return outputs;
}

std::unique_ptr<GiTechnique> make@Name@(SharedParts& shared) {
    return std::make_unique<@Name@Technique>(shared);
}

} // namespace tyndall::volumetric_gi
