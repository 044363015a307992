#include "scene/scene_edit.h"

#include <cmath>
#include <utility>

#include "core/check.h"
#include "media/particle_grids.h"

namespace tyndall {
namespace {

template <typename T> T& at(std::vector<T>& values, int index, const char* what) {
    CHECK(index >= 0 && size_t(index) < values.size(),
          std::string(what) + " " + std::to_string(index) + " is not in the scene");
    return values[size_t(index)];
}

template <typename T>
void replace(std::vector<T>& values, int index, T value, const char* what, Version& kind) {
    value.version = kind = nextVersion();
    at(values, index, what) = std::move(value);
}

template <typename T> int append(std::vector<T>& values, T value, Version& kind) {
    value.version = kind = nextVersion();
    values.push_back(std::move(value));
    return int(values.size() - 1);
}

bool finite(const dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

int remapped(const std::vector<int>& newIndex, int old) {
    return old == kNone ? kNone : newIndex[size_t(old)];
}

/// Puts the nodes of `order` (old indices) in that order and renames every index to a node.
std::vector<int> reorder(Scene& scene, const std::vector<int>& order) {
    std::vector<int> newIndex(scene.nodes.size(), kNone);
    std::vector<Node> nodes;
    nodes.reserve(order.size());
    for (const int old : order) {
        newIndex[size_t(old)] = int(nodes.size());
        nodes.push_back(std::move(scene.nodes[size_t(old)]));
    }
    for (Node& node : nodes) {
        node.parent = remapped(newIndex, node.parent);
        node.source = remapped(newIndex, node.source);
    }
    scene.nodes = std::move(nodes);
    scene.activeCamera = remapped(newIndex, scene.activeCamera);
    scene.versions.structure = scene.versions.transforms = nextVersion();
    return newIndex;
}

/// Old indices with every parent before its children, otherwise in the order that was there.
std::vector<int> parentsFirst(const std::vector<Node>& nodes) {
    std::vector<int> order;
    std::vector<bool> placed(nodes.size(), false);
    std::vector<int> chain;
    for (size_t i = 0; i < nodes.size(); ++i) {
        for (int node = int(i); node != kNone && !placed[size_t(node)];
             node = nodes[size_t(node)].parent)
            chain.push_back(node);
        for (; !chain.empty(); chain.pop_back()) {
            placed[size_t(chain.back())] = true;
            order.push_back(chain.back());
        }
    }
    return order;
}

} // namespace

void setNodeTransform(Scene& scene, int node, const dvec3& translation, const dquat& rotation,
                      const dvec3& scale) {
    CHECK(finite(translation) && finite(scale) && finite({rotation.x, rotation.y, rotation.z}) &&
          std::isfinite(rotation.w));
    Node& target = at(scene.nodes, node, "node");
    target.translation = translation;
    target.rotation = rotation;
    target.scale = scale;
    target.matrix.reset();
    scene.versions.transforms = nextVersion();
}

void setNodeMatrix(Scene& scene, int node, const dmat4& parentFromNode) {
    for (int column = 0; column < 4; ++column) CHECK(finite(dvec3(parentFromNode[column])));
    at(scene.nodes, node, "node").matrix = parentFromNode;
    scene.versions.transforms = nextVersion();
}

void setNodeVisible(Scene& scene, int node, bool visible) {
    at(scene.nodes, node, "node").visible = visible;
    scene.versions.structure = nextVersion();
}

void setMaterial(Scene& scene, int material, Material value) {
    replace(scene.materials, material, std::move(value), "material", scene.versions.materials);
}
void setLight(Scene& scene, int light, Light value) {
    replace(scene.lights, light, std::move(value), "light", scene.versions.lights);
}
void setMedium(Scene& scene, int medium, Medium value) {
    replace(scene.media, medium, std::move(value), "medium", scene.versions.media);
}
Result<std::vector<std::string>> setParticles(Scene& scene, int medium,
                                              std::shared_ptr<const ParticleSet> particles) {
    Medium changed = at(scene.media, medium, "medium");
    Result<std::vector<std::string>> notes = setParticles(changed, std::move(particles));
    if (notes) setMedium(scene, medium, std::move(changed));
    return notes;
}

void setActiveCamera(Scene& scene, int node) {
    CHECK(node == kNone || at(scene.nodes, node, "node").camera != kNone,
          "the active camera is a node with a camera");
    scene.activeCamera = node;
    scene.versions.cameras = nextVersion();
}

int addNode(Scene& scene, Node node) {
    CHECK(node.parent >= kNone && node.parent < int(scene.nodes.size()),
          "node '" + node.name + "' has an unknown parent");
    scene.nodes.push_back(std::move(node));
    scene.versions.structure = scene.versions.transforms = nextVersion();
    return int(scene.nodes.size() - 1);
}

int addMesh(Scene& scene, Mesh mesh) {
    return append(scene.meshes, std::move(mesh), scene.versions.meshes);
}
int addMaterial(Scene& scene, Material material) {
    return append(scene.materials, std::move(material), scene.versions.materials);
}
int addLight(Scene& scene, Light light) {
    return append(scene.lights, std::move(light), scene.versions.lights);
}
int addCamera(Scene& scene, Camera camera) {
    return append(scene.cameras, std::move(camera), scene.versions.cameras);
}
int addMedium(Scene& scene, Medium medium) {
    return append(scene.media, std::move(medium), scene.versions.media);
}

std::vector<int> removeNode(Scene& scene, int node) {
    at(scene.nodes, node, "node");
    std::vector<bool> removed(scene.nodes.size(), false);
    removed[size_t(node)] = true;
    std::vector<int> order;
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        const int parent = scene.nodes[i].parent;
        if (parent != kNone && removed[size_t(parent)]) removed[i] = true; // parents come first
        if (!removed[i]) order.push_back(int(i));
    }
    return reorder(scene, order);
}

std::vector<int> reparentNode(Scene& scene, int node, int parent) {
    Node& moved = at(scene.nodes, node, "node");
    for (int above = parent; above != kNone; above = at(scene.nodes, above, "node").parent)
        CHECK(above != node, "node '" + moved.name + "' cannot hang below itself");
    moved.parent = parent;
    return reorder(scene, parentsFirst(scene.nodes));
}

void touchEverything(Scene& scene) {
    const Version now = nextVersion();
    for (Mesh& mesh : scene.meshes) mesh.version = now;
    for (Material& material : scene.materials) material.version = now;
    for (Light& light : scene.lights) light.version = now;
    for (Camera& camera : scene.cameras) camera.version = now;
    for (Medium& medium : scene.media) medium.version = now;
    scene.environment.version = now;
    scene.versions = {now, now, now, now, now, now, now, now, now};
}

} // namespace tyndall
