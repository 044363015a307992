#pragma once
// A scene back to a scene file.

#include <filesystem>
#include <string>

#include "core/result.h"
#include "scene/scene.h"

namespace tyndall {

/// The scene as the text of a scene file that lies in `folder`: nodes in their order, keys in the order of
/// docs/scene-format.md, values that are the default left out, numbers in the shortest form that reads back the same. What a glTF
/// file brought in stays in that file: only the node that mounts it is written, and edits below it are not.
/// Errors: a node with a mesh that neither a primitive nor a file brought in.
Result<std::string> sceneFileText(const Scene& scene, const std::filesystem::path& folder);

/// Writes that text atomically. Names of files are rewritten when the folder is not the one of Scene::path.
Result<void> writeSceneFile(const Scene& scene, const std::filesystem::path& path);

} // namespace tyndall
