#include "scene/scene_reader.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scene/json_convert.h"
#include "scene/json_schema.h"
#include "scene/mesh_tools.h"
#include "scene/primitives.h"

namespace tyndall {
namespace {

constexpr std::string_view kTransformKeys[] = {"translation", "rotation", "scale"};

/// Parents first, in the file's order otherwise; empty where nodes are each other's ancestors.
std::vector<size_t> parentsFirst(const std::vector<int>& parentOf) {
    enum class State : uint8_t { New, Open, Placed };
    std::vector<State> state(parentOf.size(), State::New);
    std::vector<size_t> order, chain;
    for (size_t i = 0; i < parentOf.size(); ++i) {
        for (int node = int(i); node != kNone && state[size_t(node)] != State::Placed;
             node = parentOf[size_t(node)]) {
            if (state[size_t(node)] == State::Open) return {};
            state[size_t(node)] = State::Open;
            chain.push_back(size_t(node));
        }
        for (; !chain.empty(); chain.pop_back()) {
            state[chain.back()] = State::Placed;
            order.push_back(chain.back());
        }
    }
    return order;
}

} // namespace

Error SceneReader::at(const std::string& pointer, const std::string& sentence) const {
    return Error{file_.string() + ": " + pointer + " " + sentence};
}

std::filesystem::path SceneReader::resolved(const std::string& file) const {
    return file_.parent_path() / file;
}

Result<void> SceneReader::progress(float fraction, const std::string& what) const {
    if (options_.progress && !options_.progress(fraction, what)) return Error{"cancelled"};
    return {};
}

Result<void> SceneReader::onlyKeys(const Json& json, const std::string& pointer,
                                   std::string_view what,
                                   std::initializer_list<std::string_view> allowed) const {
    for (const auto& [key, value] : json.items()) {
        if (std::find(allowed.begin(), allowed.end(), key) != allowed.end()) continue;
        std::string list;
        for (const std::string_view name : allowed)
            list += (list.empty() ? "" : ", ") + std::string(name);
        return at(pointer, fmt::format("has the key '{}', which does not apply to {}; it takes {}",
                                       key, what, list));
    }
    return {};
}

Result<void> SceneReader::read(std::string_view text) {
    const auto json = parseJson(text);
    if (!json) return Error{file_.string() + ": " + json.message()};
    if (auto valid = validateJson(*json, sceneFileSchema()); !valid)
        return Error{file_.string() + ": " + valid.message()};
    return readChecked(*json);
}

Result<void> SceneReader::readChecked(const Json& json) {
    scene_.name = json.value("name", std::string());
    const Json nodes = json.value("nodes", Json::array());
    const auto names = readNames(nodes);
    if (!names) return names.error();
    // A node's index in the scene, by its index in the file; glTF content is appended after all of these.
    std::vector<int> placed(nodes.size(), kNone);
    for (const size_t i : names->order) {
        const int parent = names->parentOf[i];
        placed[i] = int(scene_.nodes.size());
        const std::string pointer = fmt::format("/nodes/{}", i);
        if (auto read =
                readNode(nodes[i], pointer, parent == kNone ? kNone : placed[size_t(parent)]);
            !read)
            return read;
    }
    for (const size_t i : names->order) {
        const std::string mounted = scene_.nodes[size_t(placed[i])].gltf;
        if (mounted.empty()) continue;
        if (auto goOn = progress(fraction_, mounted); !goOn) return goOn;
        if (auto done = mounts_.mount(loaded_, placed[i], resolved(mounted), options_); !done)
            return at(fmt::format("/nodes/{}/gltf:", i), done.message());
    }
    return readWholeScene(json);
}

Result<SceneReader::Names> SceneReader::readNames(const Json& nodes) const {
    Names names;
    for (size_t i = 0; i < nodes.size(); ++i) {
        const auto name = nodes[i].find("name");
        if (name == nodes[i].end()) continue;
        const auto [before, fresh] = names.byName.emplace(name->get<std::string>(), i);
        if (!fresh)
            return at(fmt::format("/nodes/{}/name", i),
                      fmt::format("is '{}' as in /nodes/{}, but names must be unique",
                                  before->first, before->second));
    }
    for (size_t i = 0; i < nodes.size(); ++i) {
        const auto parent = nodes[i].find("parent");
        names.parentOf.push_back(kNone);
        if (parent == nodes[i].end()) continue;
        const auto found = names.byName.find(parent->get<std::string>());
        if (found == names.byName.end())
            return at(fmt::format("/nodes/{}/parent", i),
                      unknownName(parent->get<std::string>(), names.byName));
        names.parentOf.back() = int(found->second);
    }
    names.order = parentsFirst(names.parentOf);
    if (names.order.size() != nodes.size())
        return at("/nodes",
                  "holds parents that are below their own children; parents must form a tree");
    return names;
}

Result<void> SceneReader::readNode(const Json& json, const std::string& pointer, int parent) {
    Node node;
    node.name = json.value("name", std::string());
    node.parent = parent;
    node.visible = json.value("visible", true);
    node.gltf = json.value("gltf", std::string());
    if (auto read = readTransform(json, pointer, node); !read) return read;
    if (json.contains("material") && !json.contains("primitive"))
        return at(pointer, "has a 'material' without a 'primitive' to wear it");
    if (json.contains("primitive"))
        if (auto read = readPrimitive(json, pointer, node); !read) return read;
    if (const auto light = json.find("light"); light != json.end()) {
        auto read = readLight(*light, pointer + "/light", node.name);
        if (!read) return read.error();
        node.light = *read;
    }
    if (const auto camera = json.find("camera"); camera != json.end()) {
        auto read = readCamera(*camera, pointer + "/camera", node.name);
        if (!read) return read.error();
        node.camera = *read;
    }
    if (const auto medium = json.find("medium"); medium != json.end())
        if (auto read = readMedium(*medium, pointer + "/medium", node); !read) return read;
    if (const auto animate = json.find("animate"); animate != json.end())
        if (auto read = readAnimations(*animate, pointer + "/animate", node); !read) return read;
    scene_.nodes.push_back(std::move(node));
    return {};
}

Result<void> SceneReader::readTransform(const Json& json, const std::string& pointer,
                                        Node& node) const {
    if (const auto matrix = json.find("matrix"); matrix != json.end()) {
        for (const std::string_view key : kTransformKeys)
            if (json.contains(key))
                return at(pointer,
                          fmt::format("has both 'matrix' and '{}'; one of them would do", key));
        dmat4 value;
        for (int i = 0; i < 16; ++i) value[i / 4][i % 4] = (*matrix)[size_t(i)].get<double>();
        if (value[0][3] != 0 || value[1][3] != 0 || value[2][3] != 0 || value[3][3] != 1)
            return at(pointer + "/matrix",
                      "is not affine: its last row (elements 3, 7, 11 and 15) must be 0, 0, 0, 1");
        node.matrix = value;
        return {};
    }
    if (const auto translation = json.find("translation"); translation != json.end())
        node.translation = toVector(*translation);
    if (const auto scale = json.find("scale"); scale != json.end()) node.scale = toVector(*scale);
    if (const auto rotation = json.find("rotation"); rotation != json.end()) {
        const dvec4 q((*rotation)[0].get<double>(), (*rotation)[1].get<double>(),
                      (*rotation)[2].get<double>(), (*rotation)[3].get<double>());
        const double length = glm::length(q);
        if (!(length > 1e-9 && length < 1e9))
            return at(pointer + "/rotation",
                      "is not a rotation: a quaternion x, y, z, w of length 1 is wanted");
        // One that is unit already stays as written, to the bit.
        const double by = std::abs(length - 1) < 1e-15 ? 1 : 1 / length;
        node.rotation = dquat(q.w * by, q.x * by, q.y * by, q.z * by);
    }
    return {};
}

Result<void> SceneReader::readPrimitive(const Json& json, const std::string& pointer, Node& node) {
    const Json& description = json.at("primitive");
    Primitive primitive;
    primitive.shape =
        PrimitiveShape(indexOf(kPrimitiveShapeNames, description.at("shape").get<std::string>()));
    const bool flat =
        primitive.shape == PrimitiveShape::Plane || primitive.shape == PrimitiveShape::Disk;
    if (const auto size = description.find("size"); size != description.end()) {
        if (size->size() == 2 && !flat)
            return at(pointer + "/primitive/size",
                      fmt::format("has 2 elements but must have 3 for a {}",
                                  description.at("shape").get<std::string>()));
        // A plane has x and z; with three numbers the middle one means nothing.
        primitive.size = size->size() == 2
                             ? dvec3((*size)[0].get<double>(), 1, (*size)[1].get<double>())
                             : toVector(*size);
        if (flat) primitive.size.y = 1;
    }
    auto material =
        readMaterial(json.value("material", Json::object()), pointer + "/material", node.name);
    if (!material) return material.error();
    Mesh mesh = makePrimitive(primitive);
    mesh.name = node.name;
    mesh.material = *material;
    if (scene_.materials[size_t(*material)].normalTexture.texture != kNone) makeTangents(mesh, 0);
    node.primitive = primitive;
    node.meshes = {int(scene_.meshes.size())};
    scene_.meshes.push_back(std::move(mesh));
    return {};
}

Result<void> SceneReader::readAnimations(const Json& json, const std::string& pointer,
                                         Node& node) const {
    static constexpr std::string_view kNames[] = {"LINEAR", "STEP", "CUBICSPLINE"};
    const bool several = json.is_array();
    for (size_t i = 0; i < (several ? json.size() : 1); ++i) {
        const Json& block = several ? json[i] : json;
        const std::string here = several ? fmt::format("{}/{}", pointer, i) : pointer;
        Animation animation;
        animation.property = block.at("property").get<std::string>();
        animation.interpolation =
            Interpolation(indexOf(kNames, block.value("interpolation", std::string("LINEAR"))));
        animation.times = block.at("times").get<std::vector<double>>();
        for (const Json& value : block.at("values"))
            if (value.is_array())
                for (const Json& number : value) animation.values.push_back(number.get<double>());
            else
                animation.values.push_back(value.get<double>());
        for (size_t k = 1; k < animation.times.size(); ++k)
            if (!(animation.times[k] > animation.times[k - 1]))
                return at(fmt::format("{}/times/{}", here, k),
                          "must be later than the time before");
        const size_t components = animation.property == "rotation"          ? 4
                                  : animation.property == "light.intensity" ? 1
                                                                            : 3;
        const size_t wanted = components * animation.times.size() *
                              (animation.interpolation == Interpolation::CubicSpline ? 3 : 1);
        if (animation.values.size() != wanted)
            return at(here + "/values", fmt::format("holds {} numbers but {} times of '{}' need {}",
                                                    animation.values.size(), animation.times.size(),
                                                    animation.property, wanted));
        if (animation.property.starts_with("light.") && node.light == kNone)
            return at(here + "/property",
                      fmt::format("is '{}' but the node has no light", animation.property));
        node.animations.push_back(std::move(animation));
    }
    return {};
}

} // namespace tyndall
