// Nodes of the default scene, and what they carry.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "scene/gltf_model.h"

namespace tyndall {
namespace {

dquat unitOrIdentity(const dvec4& q) {
    const double length = glm::length(q);
    return length > 1e-12 ? dquat(q.w / length, q.x / length, q.y / length, q.z / length)
                          : dquat(1, 0, 0, 0);
}

} // namespace

Result<void> GltfModel::build() {
    if (auto read = readMaterials(); !read) return read;
    if (auto read = readNodes(); !read) return read;
    if (auto read = attachMeshes(); !read) return read;
    noteStaticPose();
    return {};
}

Result<void> GltfModel::readNodes() {
    if (auto ordered = orderNodes(roots()); !ordered) return ordered;
    for (const Placed& placed : order_) {
        auto node = readNode(placed.node);
        if (!node) return node.error();
        node->parent = placed.parent;
        if (scene_.activeCamera == kNone && node->camera != kNone)
            scene_.activeCamera = int(scene_.nodes.size());
        scene_.nodes.push_back(std::move(*node));
    }
    return {};
}

/// The nodes that the default scene names; without any scene, all that are nobody's children.
std::vector<int> GltfModel::roots() const {
    const gltf::Document& document = file_.document();
    if (!document.scenes.empty()) return document.scenes[size_t(std::max(document.scene, 0))];
    std::vector<bool> isChild(document.nodes.size(), false);
    for (const gltf::Node& node : document.nodes)
        for (const int child : node.children) isChild[size_t(child)] = true;
    std::vector<int> top;
    for (size_t i = 0; i < isChild.size(); ++i)
        if (!isChild[i]) top.push_back(int(i));
    return top;
}

Result<void> GltfModel::orderNodes(const std::vector<int>& top) {
    const std::vector<gltf::Node>& nodes = file_.document().nodes;
    std::vector<bool> reached(nodes.size(), false);
    const auto reach = [&](int node, int parent) -> Result<void> {
        if (reached[size_t(node)])
            return file_.at(
                fmt::format("/nodes/{}", node),
                "is reached twice; every node must have one parent, and none may be below itself");
        reached[size_t(node)] = true;
        order_.push_back({size_t(node), parent});
        return {};
    };
    for (const int node : top)
        if (auto done = reach(node, kNone); !done) return done;
    for (size_t i = 0; i < order_.size();
         ++i) // grows while it runs: breadth first, so that parents come first
        for (const int child : nodes[order_[i].node].children)
            if (auto done = reach(child, int(i)); !done) return done;
    return {};
}

Result<Node> GltfModel::readNode(size_t index) {
    const gltf::Node& written = file_.document().nodes[index];
    const std::string pointer = fmt::format("/nodes/{}", index);
    Node node;
    node.name = written.name;
    node.matrix = written.matrix;
    node.translation = written.translation;
    node.scale = written.scale;
    node.rotation = unitOrIdentity(written.rotation);
    if (written.camera != kNone) {
        auto read = readCamera(size_t(written.camera));
        if (!read) return read.error();
        node.camera = *read;
    }
    if (written.light != kNone) node.light = readLight(size_t(written.light));
    auto instances = readInstances(written.instances,
                                   pointer + "/extensions/EXT_mesh_gpu_instancing/attributes");
    if (!instances) return instances.error();
    node.instances = std::move(*instances);
    return node;
}

Result<std::vector<dmat4>> GltfModel::readInstances(const gltf::Attributes& attributes,
                                                    const std::string& pointer) {
    SharedFloats translation, rotation, scale;
    size_t count = 0;
    for (const auto& [name, accessor] : attributes) {
        SharedFloats* to = name == "TRANSLATION" ? &translation
                           : name == "ROTATION"  ? &rotation
                           : name == "SCALE"     ? &scale
                                                 : nullptr;
        const size_t elements = file_.document().accessors[size_t(accessor)].count;
        if (count != 0 && elements != count)
            return file_.at(
                pointer + "/" + name,
                fmt::format("has {} elements, but another attribute {}", elements, count));
        count = elements;
        if (!to) continue; // attributes of one's own: nothing here uses them
        auto values = file_.floats(size_t(accessor), name == "ROTATION" ? "VEC4" : "VEC3");
        if (!values) return values.error();
        *to = *values;
    }
    if (auto fits = file_.charge(count * 16, pointer); !fits) return fits.error();
    std::vector<dmat4> instances;
    instances.reserve(count);
    for (size_t i = 0; i < count; ++i) {
        Node one;
        if (translation)
            one.translation =
                dvec3(translation->at(i)[0], translation->at(i)[1], translation->at(i)[2]);
        if (scale) one.scale = dvec3(scale->at(i)[0], scale->at(i)[1], scale->at(i)[2]);
        if (rotation)
            one.rotation = unitOrIdentity(
                {rotation->at(i)[0], rotation->at(i)[1], rotation->at(i)[2], rotation->at(i)[3]});
        instances.push_back(one.localTransform());
    }
    return instances;
}

/// Meshes come after all nodes because a skin needs the pose of its joints.
Result<void> GltfModel::attachMeshes() {
    const std::vector<gltf::Node>& nodes = file_.document().nodes;
    const std::vector<gltf::Mesh>& meshes = file_.document().meshes;
    const std::vector<dmat4> world = scene_.worldTransforms();
    std::vector<dmat4> rootFromNode(nodes.size(),
                                    dmat4(1.0)); // a joint outside the scene stays at the origin
    for (size_t i = 0; i < order_.size(); ++i) rootFromNode[order_[i].node] = world[i];
    for (size_t i = 0; i < order_.size(); ++i) {
        const gltf::Node& node = nodes[order_[i].node];
        if (node.mesh == kNone) continue;
        const auto index = size_t(node.mesh);
        if (auto goOn =
                file_.progress(0.3f + 0.6f * float(i) / float(order_.size()), meshes[index].name);
            !goOn)
            return goOn;
        const bool skinned = node.skin != kNone, ownWeights = !node.weights.empty();
        if (!skinned && !ownWeights)
            if (const auto found = meshes_.find(index); found != meshes_.end()) {
                scene_.nodes[i].meshes = found->second;
                continue;
            }
        std::vector<dmat4> joints;
        Shape shape;
        shape.weights = ownWeights ? node.weights : meshes[index].weights;
        if (skinned) {
            auto matrices = skinMatrices(file_, size_t(node.skin), rootFromNode);
            if (!matrices) return matrices.error();
            joints = std::move(*matrices);
            shape.joints = &joints;
        }
        auto read = readMesh(index, shape);
        if (!read) return read.error();
        if (!skinned) {
            scene_.nodes[i].meshes = *read;
            if (!ownWeights) meshes_[index] = std::move(*read);
            continue;
        }
        // A skinned mesh follows its joints and not its node: it hangs at the root of the file.
        Node posed;
        posed.name = scene_.nodes[i].name;
        posed.meshes = std::move(*read);
        scene_.nodes.push_back(std::move(posed));
    }
    return {};
}

Result<int> GltfModel::readCamera(size_t index) {
    if (const auto found = cameras_.find(index); found != cameras_.end()) return found->second;
    const Camera& camera = file_.document().cameras[index];
    if (camera.type == CameraType::Orthographic && !(camera.ymag > 0))
        return file_.at(fmt::format("/cameras/{}/orthographic/ymag", index), "must not be 0");
    scene_.cameras.push_back(camera);
    return cameras_[index] = int(scene_.cameras.size() - 1);
}

int GltfModel::readLight(size_t index) {
    if (const auto found = lights_.find(index); found != lights_.end()) return found->second;
    Light light = file_.document().lights[index];
    if (light.type == LightType::Spot && light.innerConeAngle >= light.outerConeAngle) {
        file_.note(fmt::format(
            "light {} has an inner cone that is not inside its outer one; it is made a little smaller",
            index));
        light.innerConeAngle = 0.999f * light.outerConeAngle;
    }
    scene_.lights.push_back(std::move(light));
    return lights_[index] = int(scene_.lights.size() - 1);
}

void GltfModel::noteStaticPose() {
    const gltf::Document& document = file_.document();
    if (!document.skins.empty()) file_.note("skins are shown in their rest pose");
    if (document.animations > 0) file_.note("animations are not played");
    if (document.scenes.size() > 1)
        file_.note(fmt::format("one of {} scenes is shown", document.scenes.size()));
}

} // namespace tyndall
