#include "app/load_scene.h"

#include <fmt/format.h>

#include "core/log.h"
#include "core/settings.h"

namespace tyndall {

Outcome loadScene(const ViewOptions& options, JobControl& job, Scene& scene) {
    const std::string& path = options.scene;
    if (!options.grid.empty() && !isBareVolume(path))
        return wrongInput(fmt::format(
            "--grid {}: it chooses a grid of a bare .vdb or .nvdb, which '{}' is not; in a scene file the key \"grid\" of a medium does",
            options.grid, path));
    Result<LoadedScene> loaded = [&] {
        JobPhase phase(job, "loading " + path);
        LoadOptions load;
        load.grid = options.grid;
        load.progress = [&](float fraction, const std::string& what) {
            phase.update(double(fraction), what);
            return !job.cancelled();
        };
        return tyndall::loadScene(path, load);
    }();
    if (job.cancelled())
        return failed("interrupted while the scene was loaded; nothing was written");
    if (!loaded.ok()) return wrongInput(loaded.message());
    for (const std::string& what : loaded->supplied) log::info("supplied: " + what);
    for (const std::string& note : loaded->notes) log::info("note: " + note);
    if (options.time != 0)
        log::info(
            fmt::format("note: --time {}: nothing in a scene is played yet, so it has no effect",
                        options.time));
    scene = std::move(loaded->scene);
    return {};
}

Result<int> findCamera(const Scene& scene, const std::string& name) {
    if (name.empty()) {
        if (scene.activeCamera != kNone) return scene.activeCamera;
        return Error{fmt::format("the scene '{}' has no camera to look through", scene.name)};
    }
    std::string known;
    std::vector<std::string_view> names;
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        if (node.camera == kNone) continue;
        if (node.name == name) return int(i);
        names.emplace_back(node.name);
        known += (known.empty() ? "'" : ", '") + node.name + "'";
    }
    const std::string nearest = nearestName(name, names);
    return Error{fmt::format("--camera {}: the scene has no camera of this name; {}", name,
                             !nearest.empty() ? "did you mean '" + nearest + "'?"
                             : known.empty()  ? "it has none at all"
                                              : "it has " + known)};
}

} // namespace tyndall
