// The volumetric global-illumination plugin: a table of techniques. Each lives in a folder of its own.

#include <array>

#include "volumetric_gi/shared/gi_technique.h"

/// The table, a line a technique: X(Lpv) stands for makeLpv(), in lpv/lpv_technique.cpp.
#define TYNDALL_TECHNIQUES(X)                                                                      \
    X(Octaves)                                                                                     \
    X(Lpv)                                                                                         \
    X(Vpl)                                                                                         \
    X(Surfels)

namespace tyndall::volumetric_gi {

#define TYNDALL_DECLARE(NAME) std::unique_ptr<GiTechnique> make##NAME(SharedParts& shared);
TYNDALL_TECHNIQUES(TYNDALL_DECLARE)

namespace {

using Make = std::unique_ptr<GiTechnique> (*)(SharedParts&);
#define TYNDALL_MAKE(NAME) make##NAME,
constexpr Make kTechniques[] = {TYNDALL_TECHNIQUES(TYNDALL_MAKE)};

constexpr const char* kModeNames[] = {"corrected", "paper"};
const SettingDesc kSettings[] = {
    TYNDALL_ENUM(
        SharedParts, mode, "gi.mode", "Equations", kModeNames, 0,
        "Equations of the techniques: corrected, or paper, as their papers print them as far as that works."),
};

constexpr plugin::PluginInfo kInfo{"volumetric_gi", "0.1.0",
                                   "Global illumination in scenes with participating media."};

class VolumetricGi final : public plugin::Plugin {
public:
    VolumetricGi() {
        for (size_t i = 0; i < techniques_.size(); ++i) techniques_[i] = kTechniques[i](shared_);
    }

    const plugin::PluginInfo& info() const override { return kInfo; }
    plugin::SettingsTable settings() override {
        return {kSettings, uint32_t(std::size(kSettings)), &shared_, nullptr, 0};
    }
    bool setup(plugin::Host& host, char*, uint32_t) override {
        shared_.host = &host;
        return true; // its shaders are among the engine's
    }
    uint32_t techniqueCount() const override { return uint32_t(techniques_.size()); }
    plugin::Technique* technique(uint32_t index) override { return techniques_[index].get(); }
    fg::TextureHandle addPostPasses(fg::FrameGraph&, const plugin::FrameInputs&,
                                    fg::TextureHandle color) override {
        shared_.traced.endFrame();
        return color;
    }
    void destroy() override { delete this; }

private:
    SharedParts shared_;
    std::array<std::unique_ptr<GiTechnique>, std::size(kTechniques)> techniques_;
};

} // namespace
} // namespace tyndall::volumetric_gi

TYNDALL_PLUGIN(volumetric_gi, []() -> tyndall::plugin::Plugin* {
    return new tyndall::volumetric_gi::VolumetricGi;
})
