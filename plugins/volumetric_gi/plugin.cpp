// The volumetric global-illumination plugin: a table of techniques and their settings. Each technique lives in its own folder.

#include "plugin/plugin_api.h"

#include "volumetric_gi/octaves/octaves_pass.h"

namespace tyndall::volumetric_gi {
namespace {

constexpr plugin::TechniqueInfo kTechniques[] = {
    {"octaves", "Octaves of multiple scattering",
     "Baseline: multiple scattering as reduced copies of single scattering, inside the march.",
     terms(Term::LVVE, Term::LXVVE)},
};
constexpr plugin::PluginInfo kInfo{"volumetric_gi", "0.1.0",
                                   "Global illumination in scenes with participating media.",
                                   kTechniques, uint32_t(std::size(kTechniques))};

class VolumetricGi final : public plugin::Plugin {
public:
    const plugin::PluginInfo& info() const override { return kInfo; }

    uint32_t settingsGroupCount() const override { return 1; }
    void settingsGroup(uint32_t, const SettingDesc** fields, uint32_t* count,
                       void** values) override {
        *fields = octavesSettings().data();
        *count = uint32_t(octavesSettings().size());
        *values = &octaves_;
    }
    void presets(const PresetEntry** entries, uint32_t* count) const override {
        *entries = octavesPresets().data();
        *count = uint32_t(octavesPresets().size());
    }

    bool setup(plugin::Host&, char*, uint32_t) override {
        return true;
    } // its shaders are among the engine's
    void sceneChanged(const plugin::SceneChange&) override {
    } // the march reads everything anew each frame

    plugin::FrameOutputs addPasses(fg::FrameGraph& graph, uint32_t,
                                   const plugin::FrameInputs& inputs) override {
        return {.inScatter = addOctavesPass(graph, inputs, octaves_), .surfaceRadiance = {}};
    }
    fg::TextureHandle addPostPasses(fg::FrameGraph&, const plugin::FrameInputs&,
                                    fg::TextureHandle color) override {
        return color;
    }
    void destroy() override { delete this; }

private:
    OctavesSettings octaves_{};
};

} // namespace
} // namespace tyndall::volumetric_gi

TYNDALL_PLUGIN(volumetric_gi, []() -> tyndall::plugin::Plugin* {
    return new tyndall::volumetric_gi::VolumetricGi;
})
