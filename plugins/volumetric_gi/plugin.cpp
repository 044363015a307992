// The volumetric global-illumination plugin: a table of techniques and their settings. Each technique lives in its own folder.

#include "plugin/plugin_api.h"

#include "volumetric_gi/lpv/lpv_technique.h"
#include "volumetric_gi/octaves/octaves_pass.h"
#include "volumetric_gi/vpl/vpl_technique.h"

namespace tyndall::volumetric_gi {
namespace {

constexpr plugin::TechniqueInfo kTechniques[] = {
    {"octaves", "Octaves of multiple scattering",
     "Baseline: multiple scattering as reduced copies of single scattering, inside the march.",
     terms(Term::LVVE, Term::LXVVE), 1},
    {"lpv", "Light propagation volume",
     "Light that surfaces reflect and media scatter, propagated in a lattice: all indirect light.",
     kIndirectOnSurfaces | kIndirectInMedia,
     0}, // seconds a frame without a GPU: who wants it asks for it
    {"vpl", "Virtual point lights",
     "Light of random walks, gathered from the virtual lights that they leave: all indirect light.",
     kIndirectOnSurfaces | kIndirectInMedia, 0},
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

constexpr uint32_t kLpv = 1, kVpl = 2; // indices in the table
constexpr plugin::PluginInfo kInfo{"volumetric_gi", "0.1.0",
                                   "Global illumination in scenes with participating media.",
                                   kTechniques, uint32_t(std::size(kTechniques))};

class VolumetricGi final : public plugin::Plugin {
public:
    const plugin::PluginInfo& info() const override { return kInfo; }

    uint32_t settingsGroupCount() const override { return 4; }
    void settingsGroup(uint32_t index, const SettingDesc** fields, uint32_t* count,
                       void** values) override {
        const auto give = [&](std::span<const SettingDesc> all, void* of) {
            *fields = all.data();
            *count = uint32_t(all.size());
            *values = of;
        };
        if (index == 0) return give(kCommonSettings, &common_);
        if (index == 1) return give(octavesSettings(), &octaves_);
        if (index == 2) return give(lpvSettings(), &lpv_.settings());
        give(vplSettings(), &vpl_.settings());
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
        if (technique == kVpl) return vpl_.addPasses(graph, inputs, *host_);
        plugin::FrameOutputs outputs;
        outputs.inScatter = addOctavesPass(graph, inputs, octaves_);
        return outputs;
    }
    fg::TextureHandle addPostPasses(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                    fg::TextureHandle color) override {
        return vpl_.addPostPasses(graph, inputs, lpv_.addPostPasses(graph, inputs, color));
    }
    void destroy() override { delete this; }

private:
    plugin::Host* host_ = nullptr;
    CommonSettings common_{};
    OctavesSettings octaves_{};
    LpvTechnique lpv_;
    VplTechnique vpl_;
    std::vector<PresetEntry> presets_ = [] {
        std::vector<PresetEntry> all(octavesPresets().begin(), octavesPresets().end());
        all.insert(all.end(), lpvPresets().begin(), lpvPresets().end());
        all.insert(all.end(), vplPresets().begin(), vplPresets().end());
        return all;
    }();
};

} // namespace
} // namespace tyndall::volumetric_gi

TYNDALL_PLUGIN(volumetric_gi, []() -> tyndall::plugin::Plugin* {
    return new tyndall::volumetric_gi::VolumetricGi;
})
