#pragma once
// What is near, for everything that takes its scale from the scene: lattices, shadow maps, nearest distances, the supplied camera. A thing that is so far
// away that it is a speck from here sets none of them.

#include <vector>

#include "scene/scene.h"

namespace tyndall {

/// Things that stand near each other: the gap to all the rest is more than a few times their size. World space, metres.
struct SceneCluster {
    Bounds things;    // surfaces and media with an end
    Bounds content;   // of those, without the landscape (Scene::contentBounds)
    Bounds withLamps; // `things`, and the lamps among them
};

/// A homogeneous medium that is many times larger than light goes in it: what is far off in it does not matter.
struct WideMedium {
    Bounds box;         // world
    double visible = 0; // metres, of which light is attenuated to a fiftieth
    double spread = 0;  // metres in which what scatters falls to 1e-5 by absorption; infinite without absorption
};

struct SceneClusters {
    std::vector<SceneCluster> clusters; // the largest first
    std::vector<WideMedium> wide;
};

/// Of what is visible. Linear in the number of things, but for scenes of many clusters: past 64 all the rest counts as one.
[[nodiscard]] SceneClusters findClusters(const Scene& scene, bool withoutMedia = false);

/// Where somebody stands and looks. World space.
struct Viewer {
    dvec3 eye{0}, forward{0, 0, -1};
    double halfAngle = 0.5; // radians, of the cone around all that is seen
};

/// All that matters from where somebody stands. World space; empty for an empty scene.
struct SceneReach {
    Bounds surroundings; // of all that is more than a speck
    Bounds content;      // of that what is seen, without the landscape: where detail goes
    Bounds withLamps;    // surroundings, and the lamps among them
    Bounds seen;         // of every cluster in view, specks too
    bool operator==(const SceneReach& other) const;
};

/// Clusters count that are wider than a hundredth of their distance; of wide media around the eye, what light can come from. Turning the viewer changes
/// nothing in scenes of one cluster; walking in a wide medium moves its part by whole steps.
[[nodiscard]] SceneReach reachOf(const SceneClusters& scene, const Viewer& viewer);

/// The same for nobody in particular: of the largest cluster alone.
[[nodiscard]] SceneReach reachOfLargest(const SceneClusters& scene);

} // namespace tyndall
