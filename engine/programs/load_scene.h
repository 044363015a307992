#pragma once
// What every command that renders does first: read the scene, say what was supplied, find the camera.

#include <string>

#include "core/progress.h"
#include "programs/outcome.h"
#include "scene/scene_file.h"

namespace tyndall {

/// Reads `path` with progress on stderr; what was supplied and noted goes to the log.
Outcome loadSceneForCommand(const std::string& path, ProgressStyle style, Scene& scene);

/// The node with the camera of this name; the scene's own where it is empty. Errors name what there is.
Result<int> findCamera(const Scene& scene, const std::string& name);

} // namespace tyndall
