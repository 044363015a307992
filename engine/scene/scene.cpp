#include "scene/scene.h"

#include <algorithm>

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

/// Of each visible mesh, instance and bounded medium; none is empty.
std::vector<Bounds> Scene::worldBoxes(bool withMedia) const {
    const std::vector<dmat4> world = worldTransforms();
    const std::vector<bool> visible = worldVisibility();
    std::vector<Bounds> boxes;
    const auto add = [&](const Bounds& local, const dmat4& worldFromLocal) {
        if (!local.empty()) boxes.push_back(local.transformed(worldFromLocal));
    };
    for (size_t i = 0; i < nodes.size(); ++i) {
        if (!visible[i]) continue;
        const Node& node = nodes[i];
        for (const int mesh : node.meshes) {
            const Bounds& local = meshes[size_t(mesh)].bounds;
            if (node.instances.empty()) add(local, world[i]);
            for (const dmat4& instance : node.instances) add(local, world[i] * instance);
        }
        if (withMedia && node.medium != kNone)
            add(localBounds(media[size_t(node.medium)]), world[i]);
    }
    return boxes;
}

Bounds Scene::worldBounds() const {
    Bounds bounds;
    for (const Bounds& box : worldBoxes(true)) bounds.include(box);
    return bounds;
}

Bounds Scene::contentBounds(bool withMedia) const {
    constexpr double kManyTimes = 6;
    constexpr double kFlatScene = 0.25, kFlatBox = 0.05; // least extent over longest
    const auto longest = [](const Bounds& b) {
        const dvec3 extent = b.extent();
        return std::max({extent.x, extent.y, extent.z});
    };
    const auto isFlat = [&](const Bounds& b, double ratio) {
        const dvec3 extent = b.extent();
        return std::min({extent.x, extent.y, extent.z}) <= ratio * longest(b);
    };
    std::vector<Bounds> boxes = worldBoxes(withMedia);
    std::sort(boxes.begin(), boxes.end(),
              [&](const Bounds& a, const Bounds& b) { return longest(a) < longest(b); });
    std::vector<Bounds> smaller(1); // of all boxes before each
    for (const Bounds& box : boxes) {
        smaller.push_back(smaller.back());
        smaller.back().include(box);
    }
    const Bounds& all = smaller.back();
    if (all.empty() || !isFlat(all, kFlatScene)) return all;
    for (size_t i = boxes.size(); i-- > 1 && isFlat(boxes[i], kFlatBox);)
        if (longest(boxes[i]) > kManyTimes * longest(smaller[i])) return smaller[i];
    return all;
}

} // namespace tyndall
