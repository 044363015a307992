#include "scene/scene_file.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/image.h"
#include "scene/scene_edit.h"
#include "scene/scene_mount.h"
#include "scene/scene_reader.h"
#include "scene/zero_config.h"

namespace tyndall {
namespace fs = std::filesystem;
namespace {

constexpr size_t kMaxSceneFileBytes = size_t(1) << 28;

Result<void> readSceneFile(LoadedScene& loaded, const fs::path& path, const LoadOptions& options) {
    const auto text = readFile(path, kMaxSceneFileBytes);
    if (!text) return text.error();
    if (auto read = SceneReader(loaded, options, path).read(*text); !read) return read;
    supplyCamera(loaded);
    return {};
}

Result<void> readGltfFile(LoadedScene& loaded, const fs::path& path, const LoadOptions& options) {
    Node root;
    root.name = loaded.scene.name;
    root.gltf = path.filename().string();
    loaded.scene.nodes.push_back(std::move(root));
    if (auto mounted = GltfMounts().mount(loaded, 0, path, options); !mounted) return mounted;
    for (size_t i = 0; i < loaded.scene.nodes.size() && loaded.scene.activeCamera == kNone; ++i)
        if (loaded.scene.nodes[i].camera != kNone) loaded.scene.activeCamera = int(i);
    const std::optional<Interior> interior = supplyCameraInside(loaded);
    supplyCamera(loaded);
    const bool lamp = supplyLight(loaded, interior);
    supplyExposure(loaded, lamp ? interior : std::nullopt);
    return {};
}

Result<void> readVolumeFile(LoadedScene& loaded, const fs::path& path, const std::string& grid) {
    if (auto medium = supplyMedium(loaded, path, grid); !medium) return medium;
    supplyCamera(loaded);
    supplyLight(loaded);
    supplyExposure(loaded);
    return {};
}

bool finite(const dmat4& matrix) {
    for (int i = 0; i < 16; ++i)
        if (!(std::abs(matrix[i / 4][i % 4]) < 1e30)) return false;
    return true;
}

/// Products of transforms that are fine one by one can leave the range of numbers.
Result<void> checkTransforms(const Scene& scene) {
    const std::vector<dmat4> world = scene.worldTransforms();
    for (size_t i = 0; i < world.size(); ++i) {
        if (!finite(world[i]))
            return Error{fmt::format(
                "{}: node '{}' (number {}) ends up beyond 1e30 metres; smaller scales and distances are wanted",
                scene.path.string(), scene.nodes[i].name, i)};
        for (const dmat4& instance : scene.nodes[i].instances)
            if (!finite(world[i] * instance))
                return Error{fmt::format(
                    "{}: an instance of node '{}' (number {}) ends up beyond 1e30 metres",
                    scene.path.string(), scene.nodes[i].name, i)};
    }
    return {};
}

bool lightFromInfinity(const Scene& scene) {
    if (scene.environment.image || scene.environment.radiance != vec3(0)) return true;
    return std::any_of(scene.lights.begin(), scene.lights.end(),
                       [](const Light& light) { return light.type == LightType::Directional; });
}

void noteEndlessMedia(LoadedScene& loaded) {
    if (!lightFromInfinity(loaded.scene)) return;
    for (const Medium& medium : loaded.scene.media)
        if (medium.kind == MediumKind::Everywhere && medium.extinction() != vec3(0))
            loaded.notes.push_back(fmt::format(
                "medium '{}' has no end, so that no light from infinity (sun, sky) gets through it; "
                "the shape 'height' or 'box' would let it in",
                medium.name));
}

/// Keyframes and sequences are read and written, and shown as they are before the clock starts.
void noteUnplayed(LoadedScene& loaded) {
    std::string moving;
    for (const Node& node : loaded.scene.nodes) {
        if (node.animations.empty() && !node.sequence) continue;
        moving += moving.empty() ? "" : ", ";
        moving += fmt::format("'{}' ({})", node.name, node.sequence ? "frames" : "animate");
    }
    if (!moving.empty())
        loaded.notes.push_back(fmt::format(
            "animations are not played yet: {} stand still as the scene file begins them", moving));
}

Result<LoadedScene> load(const fs::path& path, const LoadOptions& options) {
    LoadedScene loaded;
    loaded.scene.path = path;
    loaded.scene.name = path.stem().string();
    const std::string extension = lowerExtension(path);
    Result<void> read;
    if (extension == ".json")
        read = readSceneFile(loaded, path, options);
    else if (extension == ".gltf" || extension == ".glb")
        read = readGltfFile(loaded, path, options);
    else if (isBareVolume(path))
        read = readVolumeFile(loaded, path, options.grid);
    else
        return Error{fmt::format(
            "{}: '{}' is not the ending of a scene; .scene.json, .gltf, .glb, .vdb and .nvdb are read",
            path.string(), extension)};
    if (!read) return read.error();
    if (auto sane = checkTransforms(loaded.scene); !sane) return sane.error();
    noteEndlessMedia(loaded);
    noteUnplayed(loaded);
    touchEverything(loaded.scene);
    return loaded;
}

} // namespace

bool isBareVolume(const fs::path& path) {
    const std::string extension = lowerExtension(path);
    return extension == ".vdb" || extension == ".nvdb";
}

Result<LoadedScene> loadScene(const fs::path& path, const LoadOptions& options) {
    try {
        return load(path, options);
    } catch (const std::bad_alloc&) {
        return Error{
            fmt::format("{}: there is not enough memory to load this scene", path.string())};
    } catch (const std::length_error&) {
        return Error{
            fmt::format("{}: there is not enough memory to load this scene", path.string())};
    } catch (const fs::filesystem_error& error) {
        return Error{fmt::format("{}: {}", path.string(), error.code().message())};
    }
}

} // namespace tyndall
