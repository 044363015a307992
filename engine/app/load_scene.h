#pragma once
// Reading a scene as a job, and finding a camera in it: what comes first wherever one is rendered.

#include <string>

#include "app/job.h"
#include "app/options.h"
#include "app/outcome.h"
#include "scene/scene_file.h"

namespace tyndall {

/// Reads SCENE and --grid as programs accept them. What was supplied and noted goes to the log. When the job is cancelled `scene` stays as it
/// is. Errors: as tyndall::loadScene, or that it was interrupted.
Outcome loadScene(const ViewOptions& options, JobControl& job, Scene& scene);

/// The node with the camera of this name; the scene's own where it is empty. Errors name what there is.
Result<int> findCamera(const Scene& scene, const std::string& name);

} // namespace tyndall
