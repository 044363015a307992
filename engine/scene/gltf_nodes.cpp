// Nodes of the default scene, and what they carry.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scene/gltf_model.h"
#include "scene/json_convert.h"

namespace tyndall {
namespace {

constexpr std::string_view kLightTypes[] = {"directional", "point", "spot"};

/// The member of an extension of a node, or null.
const Json& extensionMember(const Json& json, const char* extension, const char* member) {
    static const Json none = nullptr;
    const auto extensions = json.find("extensions");
    if (extensions == json.end()) return none;
    const auto found = extensions->find(extension);
    return found == extensions->end() ? none : found->at(member);
}

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
    const auto top = roots();
    if (!top) return top.error();
    if (auto ordered = orderNodes(*top); !ordered) return ordered;
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
Result<std::vector<size_t>> GltfModel::roots() const {
    const Json &scenes = file_.array("scenes"), &nodes = file_.array("nodes");
    if (!scenes.empty()) {
        const Json& chosen = scenes[file_.json().value("scene", size_t(0))];
        return chosen.value("nodes", std::vector<size_t>());
    }
    std::vector<bool> isChild(nodes.size(), false);
    for (const Json& node : nodes)
        for (const Json& child : node.value("children", Json::array()))
            isChild[child.get<size_t>()] = true;
    std::vector<size_t> top;
    for (size_t i = 0; i < nodes.size(); ++i)
        if (!isChild[i]) top.push_back(i);
    return top;
}

Result<void> GltfModel::orderNodes(const std::vector<size_t>& top) {
    const Json& nodes = file_.array("nodes");
    std::vector<bool> reached(nodes.size(), false);
    const auto reach = [&](size_t node, int parent) -> Result<void> {
        if (reached[node])
            return file_.at(
                fmt::format("/nodes/{}", node),
                "is reached twice; every node must have one parent, and none may be below itself");
        reached[node] = true;
        order_.push_back({node, parent});
        return {};
    };
    for (const size_t node : top)
        if (auto done = reach(node, kNone); !done) return done;
    for (size_t i = 0; i < order_.size();
         ++i) // grows while it runs: breadth first, so that parents come first
        for (const Json& child : nodes[order_[i].node].value("children", Json::array()))
            if (auto done = reach(child.get<size_t>(), int(i)); !done) return done;
    return {};
}

Result<Node> GltfModel::readNode(size_t index) {
    const Json& json = file_.array("nodes")[index];
    const std::string pointer = fmt::format("/nodes/{}", index);
    Node node;
    node.name = json.value("name", std::string());
    if (auto read = readTransform(json, pointer, node); !read) return read.error();
    if (const auto camera = json.find("camera"); camera != json.end()) {
        auto read = readCamera(camera->get<size_t>());
        if (!read) return read.error();
        node.camera = *read;
    }
    if (const Json& light = extensionMember(json, "KHR_lights_punctual", "light");
        !light.is_null()) {
        auto read = readLight(light.get<size_t>());
        if (!read) return read.error();
        node.light = *read;
    }
    if (const Json& attributes = extensionMember(json, "EXT_mesh_gpu_instancing", "attributes");
        !attributes.is_null()) {
        auto read =
            readInstances(attributes, pointer + "/extensions/EXT_mesh_gpu_instancing/attributes");
        if (!read) return read.error();
        node.instances = std::move(*read);
    }
    return node;
}

Result<void> GltfModel::readTransform(const Json& json, const std::string& pointer, Node& node) {
    if (const auto matrix = json.find("matrix"); matrix != json.end()) {
        dmat4 value;
        for (int i = 0; i < 16; ++i) value[i / 4][i % 4] = (*matrix)[size_t(i)].get<double>();
        if (value[0][3] != 0 || value[1][3] != 0 || value[2][3] != 0 || value[3][3] != 1)
            return file_.at(
                pointer + "/matrix",
                "is not affine: its last row (elements 3, 7, 11 and 15) must be 0, 0, 0, 1");
        node.matrix = value;
        return {};
    }
    if (const auto translation = json.find("translation"); translation != json.end())
        node.translation = toVector(*translation);
    if (const auto scale = json.find("scale"); scale != json.end()) node.scale = toVector(*scale);
    if (const auto rotation = json.find("rotation"); rotation != json.end())
        node.rotation =
            unitOrIdentity({(*rotation)[0].get<double>(), (*rotation)[1].get<double>(),
                            (*rotation)[2].get<double>(), (*rotation)[3].get<double>()});
    return {};
}

Result<std::vector<dmat4>> GltfModel::readInstances(const Json& attributes,
                                                    const std::string& pointer) {
    SharedFloats translation, rotation, scale;
    size_t count = 0;
    for (const auto& [name, accessor] : attributes.items()) {
        SharedFloats* to = name == "TRANSLATION" ? &translation
                           : name == "ROTATION"  ? &rotation
                           : name == "SCALE"     ? &scale
                                                 : nullptr;
        const size_t elements = file_.accessorCount(accessor.get<size_t>());
        if (count != 0 && elements != count)
            return file_.at(
                pointer + "/" + name,
                fmt::format("has {} elements, but another attribute {}", elements, count));
        count = elements;
        if (!to) continue; // attributes of one's own: nothing here uses them
        auto values = file_.floats(accessor.get<size_t>(), name == "ROTATION" ? "VEC4" : "VEC3");
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
    const Json &nodes = file_.array("nodes"), &meshes = file_.array("meshes");
    const std::vector<dmat4> world = scene_.worldTransforms();
    std::vector<dmat4> rootFromNode(nodes.size(),
                                    dmat4(1.0)); // a joint outside the scene stays at the origin
    for (size_t i = 0; i < order_.size(); ++i) rootFromNode[order_[i].node] = world[i];
    for (size_t i = 0; i < order_.size(); ++i) {
        const Json& json = nodes[order_[i].node];
        const auto mesh = json.find("mesh");
        if (mesh == json.end()) continue;
        const size_t index = mesh->get<size_t>();
        if (auto goOn = file_.progress(0.3f + 0.6f * float(i) / float(order_.size()),
                                       meshes[index].value("name", std::string()));
            !goOn)
            return goOn;
        const bool skinned = json.contains("skin"), ownWeights = json.contains("weights");
        if (!skinned && !ownWeights)
            if (const auto found = meshes_.find(index); found != meshes_.end()) {
                scene_.nodes[i].meshes = found->second;
                continue;
            }
        std::vector<dmat4> joints;
        Shape shape;
        shape.weights = (ownWeights ? json : meshes[index]).value("weights", std::vector<double>());
        if (skinned) {
            auto matrices = skinMatrices(file_, json.at("skin").get<size_t>(), rootFromNode);
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
    const Json& json = file_.array("cameras")[index];
    const std::string type = json.at("type").get<std::string>(),
                      pointer = fmt::format("/cameras/{}", index);
    const auto lens = json.find(type);
    if (lens == json.end())
        return file_.at(pointer, fmt::format("is {} but lacks the key '{}'", type, type));
    Camera camera;
    camera.name = json.value("name", std::string());
    if (type == "perspective") {
        camera.yfov = lens->at("yfov").get<double>();
    } else {
        camera.type = CameraType::Orthographic;
        camera.ymag = std::abs(lens->at("ymag").get<double>());
        if (!(camera.ymag > 0)) return file_.at(pointer + "/orthographic/ymag", "must not be 0");
    }
    camera.znear = std::max(lens->at("znear").get<double>(), 1e-9);
    scene_.cameras.push_back(std::move(camera));
    return cameras_[index] = int(scene_.cameras.size() - 1);
}

Result<int> GltfModel::readLight(size_t index) {
    if (const auto found = lights_.find(index); found != lights_.end()) return found->second;
    const Json& json = file_.json().at("extensions").at("KHR_lights_punctual").at("lights")[index];
    Light light;
    light.name = json.value("name", std::string());
    light.type = LightType(indexOf(kLightTypes, json.at("type").get<std::string>()));
    light.color = colorOr(json, "color", light.color);
    light.intensity = floatOr(json, "intensity", 1.0f);
    if (light.type != LightType::Directional) light.range = floatOr(json, "range", 0.0f);
    if (light.type == LightType::Spot) {
        const Json spot = json.value("spot", Json::object());
        light.innerConeAngle = floatOr(spot, "innerConeAngle", 0.0f);
        light.outerConeAngle = std::max(floatOr(spot, "outerConeAngle", float(kPi / 4)), 1e-4f);
        if (light.innerConeAngle >= light.outerConeAngle) {
            file_.note(fmt::format(
                "light {} has an inner cone that is not inside its outer one; it is made a little smaller",
                index));
            light.innerConeAngle = 0.999f * light.outerConeAngle;
        }
    }
    scene_.lights.push_back(std::move(light));
    return lights_[index] = int(scene_.lights.size() - 1);
}

void GltfModel::noteStaticPose() {
    if (!file_.array("skins").empty()) file_.note("skins are shown in their rest pose");
    if (!file_.array("animations").empty()) file_.note("animations are not played");
    if (file_.array("scenes").size() > 1)
        file_.note(fmt::format("one of {} scenes is shown", file_.array("scenes").size()));
}

} // namespace tyndall
