#pragma once
// From a file to a scene: scene files (docs/scene-format.md), or directly a .gltf, .glb, .vdb or .nvdb, for which
// a camera, a light and, for a volume, a plausible medium are supplied.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/result.h"
#include "scene/scene.h"

namespace tyndall {

struct LoadedScene {
    Scene scene;
    std::vector<std::string>
        supplied; // "a camera that frames the scene", for the zero-configuration start
    std::vector<std::string> extensions; // that its glTF files use, by their names
    std::vector<std::string>
        notes; // mapped synonyms, ignored extensions, sanitised voxels: one sentence each
};

struct LoadOptions {
    /// 0..1 and what is being read; return false to cancel (an Error "cancelled" results).
    std::function<bool(float fraction, const std::string& what)> progress;
    /// Of a bare .vdb or .nvdb: the density grid's name; "": as importGrid() finds it.
    std::string grid = {};
};

/// Whether `path` is a volume without a scene file around it, by its ending: .vdb or .nvdb.
[[nodiscard]] bool isBareVolume(const std::filesystem::path& path);

/// Loads any SCENE that the programs accept. The error names the file and the place in it (JSON pointer, node, grid).
Result<LoadedScene> loadScene(const std::filesystem::path& path, const LoadOptions& options = {});

} // namespace tyndall
