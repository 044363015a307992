// The volumetric global-illumination plugin: a table of techniques and their settings. Each technique lives in its own folder.

#include "plugin/plugin_api.h"

#include "volumetric_gi/lpv/lpv_technique.h"
#include "volumetric_gi/octaves/octaves_pass.h"

namespace tyndall::volumetric_gi {
namespace {

constexpr plugin::TechniqueInfo kTechniques[] = {
    {"octaves", "Octaves of multiple scattering",
     "Baseline: multiple scattering as reduced copies of single scattering, inside the march.",
     terms(Term::LVVE, Term::LXVVE), 1},
    {"lpv", "Light propagation volume",
     "Light that surfaces reflect and media scatter, propagated in a lattice: all indirect light.",
     kIndirectOnSurfaces | kIndirectInMedia,
     0}, // one lattice a scene: too coarse for landscapes, until it has cascades
};
/// Of all techniques.
struct CommonSettings {
    int32_t paper; // index into kModeNames
};
constexpr const char* kModeNames[] = {"corrected", "paper"};
const SettingDesc kCommonSettings[] = {
    TYNDALL_ENUM(CommonSettings, paper, "gi.mode", "Equations", kModeNames, 0,
                 "corrected, or as the techniques' papers print them, as far as that can work."),
};

constexpr uint32_t kLpv = 1; // index in the table
constexpr plugin::PluginInfo kInfo{"volumetric_gi", "0.1.0",
                                   "Global illumination in scenes with participating media.",
                                   kTechniques, uint32_t(std::size(kTechniques))};

class VolumetricGi final : public plugin::Plugin {
public:
    const plugin::PluginInfo& info() const override { return kInfo; }

    uint32_t settingsGroupCount() const override { return 3; }
    void settingsGroup(uint32_t index, const SettingDesc** fields, uint32_t* count,
                       void** values) override {
        const auto give = [&](std::span<const SettingDesc> all, void* of) {
            *fields = all.data();
            *count = uint32_t(all.size());
            *values = of;
        };
        if (index == 0) return give(kCommonSettings, &common_);
        if (index == 1) return give(octavesSettings(), &octaves_);
        give(lpvSettings(), &lpv_.settings());
    }
    void presets(const PresetEntry** entries, uint32_t* count) const override {
        *entries = presets_.data();
        *count = uint32_t(presets_.size());
    }

    bool setup(plugin::Host& host, char*, uint32_t) override {
        host_ = &host;
        return true; // its shaders are among the engine's
    }
    void sceneChanged(const plugin::SceneChange&) override {
    } // the march reads everything anew each frame

    plugin::FrameOutputs addPasses(fg::FrameGraph& graph, uint32_t technique,
                                   const plugin::FrameInputs& inputs) override {
        if (technique == kLpv) return lpv_.addPasses(graph, inputs, *host_, common_.paper != 0);
        plugin::FrameOutputs outputs;
        outputs.inScatter = addOctavesPass(graph, inputs, octaves_);
        return outputs;
    }
    fg::TextureHandle addPostPasses(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                    fg::TextureHandle color) override {
        return lpv_.addPostPasses(graph, inputs, color);
    }
    void destroy() override { delete this; }

private:
    plugin::Host* host_ = nullptr;
    CommonSettings common_{};
    OctavesSettings octaves_{};
    LpvTechnique lpv_;
    std::vector<PresetEntry> presets_ = [] {
        std::vector<PresetEntry> all(octavesPresets().begin(), octavesPresets().end());
        all.insert(all.end(), lpvPresets().begin(), lpvPresets().end());
        return all;
    }();
};

} // namespace
} // namespace tyndall::volumetric_gi

TYNDALL_PLUGIN(volumetric_gi, []() -> tyndall::plugin::Plugin* {
    return new tyndall::volumetric_gi::VolumetricGi;
})
