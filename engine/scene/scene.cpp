#include "scene/scene.h"

#include "core/check.h"

namespace tyndall {
namespace {

const Material kDefaultMaterial{};

Bounds localBounds(const Medium& medium) {
    Bounds bounds;
    if (medium.kind == MediumKind::Box || medium.kind == MediumKind::Sphere) {
        bounds.include(-0.5 * medium.size);
        bounds.include(0.5 * medium.size);
    } else if (medium.kind == MediumKind::Grid && medium.density) {
        bounds = medium.density->indexBounds().transformed(medium.density->worldFromIndex);
    }
    return bounds;
}

} // namespace

dmat4 Node::localTransform() const {
    if (matrix) return *matrix;
    dmat4 result = glm::mat4_cast(rotation);
    for (int axis = 0; axis < 3; ++axis) result[axis] *= scale[axis];
    result[3] = dvec4(translation, 1.0);
    return result;
}

const Material& Scene::materialOf(const Mesh& mesh) const {
    if (mesh.material == kNone) return kDefaultMaterial;
    CHECK(mesh.material >= 0 && size_t(mesh.material) < materials.size(),
          "mesh '" + mesh.name + "'");
    return materials[size_t(mesh.material)];
}

std::vector<dmat4> Scene::worldTransforms() const {
    std::vector<dmat4> world(nodes.size());
    for (size_t i = 0; i < nodes.size(); ++i) {
        const int parent = nodes[i].parent;
        CHECK(parent < int(i), "node '" + nodes[i].name + "' comes before its parent");
        world[i] = parent == kNone ? nodes[i].localTransform()
                                   : world[size_t(parent)] * nodes[i].localTransform();
    }
    return world;
}

std::vector<bool> Scene::worldVisibility() const {
    std::vector<bool> visible(nodes.size());
    for (size_t i = 0; i < nodes.size(); ++i) {
        const int parent = nodes[i].parent;
        visible[i] = nodes[i].visible && (parent == kNone || visible[size_t(parent)]);
    }
    return visible;
}

Bounds Scene::worldBounds() const {
    const std::vector<dmat4> world = worldTransforms();
    const std::vector<bool> visible = worldVisibility();
    Bounds bounds;
    for (size_t i = 0; i < nodes.size(); ++i) {
        if (!visible[i]) continue;
        const Node& node = nodes[i];
        Bounds local;
        for (const int mesh : node.meshes) local.include(meshes[size_t(mesh)].bounds);
        if (node.instances.empty()) bounds.include(local.transformed(world[i]));
        for (const dmat4& instance : node.instances)
            bounds.include(local.transformed(world[i] * instance));
        if (node.medium != kNone)
            bounds.include(localBounds(media[size_t(node.medium)]).transformed(world[i]));
    }
    return bounds;
}

} // namespace tyndall
