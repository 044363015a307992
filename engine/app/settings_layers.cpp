#include "app/settings_layers.h"

#include <fmt/format.h>

namespace tyndall {
namespace {

/// Assigns, and remembers who had the last word on the technique.
class Layers {
public:
    explicit Layers(Renderer& renderer) : renderer_(renderer) {}

    Outcome assign(const std::string& assignment, const std::string& origin) {
        const Result<void> done = renderer_.settings().assign(assignment);
        if (!done.ok()) return wrongInput(origin + done.message());
        if (assignment.starts_with(std::string(kTechniqueSetting) + "=")) techniqueIsOf_ = origin;
        return {};
    }
    /// What cannot be rendered in this scene is said before it is uploaded.
    [[nodiscard]] Outcome checkTechnique(const Scene& scene, TermSet terms) const {
        const std::string gi = renderer_.settings().get(kTechniqueSetting).value();
        const bool media = renderer_.settings().get("media.enabled").value() == "true";
        const Result<FramePlan> plan =
            makePlan(gi, terms, renderer_.techniques(), sceneTraits(scene, media));
        return plan.ok() ? Outcome{} : wrongInput(techniqueIsOf_ + plan.message());
    }

private:
    Renderer& renderer_;
    std::string techniqueIsOf_; // the option or the file, as messages begin
};

} // namespace

SettingsSnapshot snapshotOf(const SettingsRegistry& settings) {
    SettingsSnapshot snapshot;
    for (const SettingsGroup& group : settings.groups())
        for (const SettingDesc& field : group.fields)
            snapshot[field.key] = settingToText(field, group.values);
    return snapshot;
}

Outcome applySettings(Renderer& renderer, const SettingsLayers& layers, const Scene& scene,
                      TermSet terms,
                      SettingsSnapshot* afterScene) {
    Layers applied(renderer);
    const std::string ofScene = fmt::format("'{}': /settings: ", layers.sceneFile);
    for (const std::string& assignment : layers.ofScene)
        if (Outcome done = applied.assign(assignment, ofScene); !done.ok()) return done;
    if (afterScene) *afterScene = snapshotOf(renderer.settings());
    if (layers.preset) renderer.settings().applyPreset(*layers.preset);
    for (const std::string& assignment : layers.assignments)
        if (Outcome done = applied.assign(assignment, "--set: "); !done.ok()) return done;
    if (!layers.gi.empty())
        if (Outcome done = applied.assign(fmt::format("{}={}", kTechniqueSetting, layers.gi),
                                          "--gi " + layers.gi + ": ");
            !done.ok())
            return done;
    return applied.checkTechnique(scene, terms);
}

} // namespace tyndall
