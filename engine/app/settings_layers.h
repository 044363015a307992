#pragma once
// Whose word a setting is: the scene file's, over it the preset's, over that the command line's. Applied here and nowhere else.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/outcome.h"
#include "renderer/renderer.h"

namespace tyndall {

/// The setting that chooses the technique; `--gi NAME` is short for assigning it.
inline constexpr const char* kTechniqueSetting = "gi.technique";

/// All settings as text, by key.
using SettingsSnapshot = std::map<std::string, std::string>;
[[nodiscard]] SettingsSnapshot snapshotOf(const SettingsRegistry& settings);

/// From the lowest to the highest.
struct SettingsLayers {
    std::string sceneFile;                // for messages
    std::vector<std::string> ofScene;     // KEY=VALUE
    std::optional<Quality> preset;        // --quality
    std::vector<std::string> assignments; // --set KEY=VALUE
    std::string gi;                       // --gi; empty: not given
};

/// Applies the layers to the renderer's settings. `scene`, `terms`: what will be asked of the technique. `afterScene`, which may be null,
/// gets the settings as the scene file alone has them. Errors name the file or the option, and the setting.
Outcome applySettings(Renderer& renderer, const SettingsLayers& layers, const Scene& scene,
                      TermSet terms,
                      SettingsSnapshot* afterScene = nullptr);

} // namespace tyndall
