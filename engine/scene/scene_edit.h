#pragma once
// Changes to a scene that keep its version numbers right: every function takes the next number for the thing that
// changed and for its kind in SceneVersions. Whoever edits a scene by hand does the same.

#include <memory>
#include <string>
#include <vector>

#include "core/result.h"
#include "media/particles.h"
#include "scene/scene.h"

namespace tyndall {

/// Replaces the local transform (and any matrix). CHECKs: finite numbers.
void setNodeTransform(Scene& scene, int node, const dvec3& translation, const dquat& rotation,
                      const dvec3& scale);
void setNodeMatrix(Scene& scene, int node, const dmat4& parentFromNode);
void setNodeVisible(Scene& scene, int node, bool visible);

/// Replace the whole thing; its own version and its kind's are new afterwards.
void setMaterial(Scene& scene, int material, Material value);
void setLight(Scene& scene, int light, Light value);
void setMedium(Scene& scene, int medium, Medium value);
/// What the medium consists of: makes its grids anew, for particles that have moved. Returns notes, a sentence each. Errors as
/// makeParticleGrids; the scene is then as it was.
Result<std::vector<std::string>> setParticles(Scene& scene, int medium,
                                              std::shared_ptr<const ParticleSet> particles);
void setActiveCamera(Scene& scene, int node);

/// Appends; the index of the new one. addNode CHECKs that the parent exists.
int addNode(Scene& scene, Node node);
int addMesh(Scene& scene, Mesh mesh);
int addMaterial(Scene& scene, Material material);
int addLight(Scene& scene, Light light);
int addCamera(Scene& scene, Camera camera);
int addMedium(Scene& scene, Medium medium);

/// Removes a node and everything below it. Returns the new index of every old node (kNone: gone); meshes,
/// lights and the rest stay in their arrays, unused.
std::vector<int> removeNode(Scene& scene, int node);
/// Hangs a node under another one (kNone: the root), keeping its local transform, and puts parents first again.
/// Returns the new index of every old node. CHECKs that `parent` is not below `node`.
std::vector<int> reparentNode(Scene& scene, int node, int parent);

/// New numbers for everything, as after loading.
void touchEverything(Scene& scene);

} // namespace tyndall
