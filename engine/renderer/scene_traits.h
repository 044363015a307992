#pragma once
// What the scene can have in a picture, as makePlan() asks for it.

#include "scene/scene.h"
#include "transport/plan.h"

namespace tyndall {

/// `mediaEnabled`: the setting media.enabled.
SceneTraits sceneTraits(const Scene& scene, bool mediaEnabled);

} // namespace tyndall
