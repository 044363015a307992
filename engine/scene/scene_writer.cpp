#include "scene/scene_writer.h"

#include <charconv>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/image.h"
#include "scene/json_parse.h"
#include "scene/primitives.h"

namespace tyndall {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kAlphaModes[] = {"OPAQUE", "MASK", "BLEND"};
constexpr std::string_view kLightTypes[] = {"directional", "point", "spot", "rect"};
constexpr std::string_view kShapes[] = {"everywhere", "box", "sphere", "height"};
constexpr std::string_view kPhases[] = {"henyey-greenstein", "rayleigh", "cornette-shanks"};
constexpr std::string_view kInterpolations[] = {"LINEAR", "STEP", "CUBICSPLINE"};
constexpr size_t kLineLength = 110;

Json number(double value) {
    if (value == std::floor(value) && std::abs(value) < 1e15) return int64_t(value);
    return value;
}

/// 0.1f as 0.1 and not as 0.10000000149011612.
Json number(float value) {
    char text[64];
    const auto [end, error] = std::to_chars(text, text + sizeof text, value);
    (void)error; // 64 characters hold any float
    double shortest = 0;
    std::from_chars(text, end, shortest);
    return number(shortest);
}

template <glm::length_t N, typename T> Json numbers(const glm::vec<N, T>& value) {
    Json array = Json::array();
    for (glm::length_t i = 0; i < N; ++i) array.push_back(number(value[i]));
    return array;
}

template <typename T> void put(Json& json, const char* key, const T& value, const T& usual) {
    if (value == usual) return;
    if constexpr (std::is_same_v<T, float> || std::is_same_v<T, double>)
        json[key] = number(value);
    else if constexpr (std::is_same_v<T, bool> || std::is_same_v<T, std::string>)
        json[key] = value;
    else
        json[key] = numbers(value);
}

/// Short values on one line, long ones a line for each member.
void print(const Json& json, std::string& text, size_t indent) {
    const std::string flat = json.dump();
    if (!json.is_structured() || (indent > 0 && flat.size() + indent <= kLineLength)) {
        // A space after commas and colons, outside strings.
        bool inString = false;
        for (size_t i = 0; i < flat.size(); ++i) {
            text += flat[i];
            if (flat[i] == '\\')
                text += flat[++i];
            else if (flat[i] == '"')
                inString = !inString;
            else if (!inString && (flat[i] == ',' || flat[i] == ':'))
                text += ' ';
        }
        return;
    }
    text += json.is_object() ? "{" : "[";
    bool first = true;
    for (const auto& [key, value] : json.items()) {
        text += (first ? "\n" : ",\n") + std::string(indent + 2, ' ');
        if (json.is_object()) text += Json(key).dump() + ": ";
        print(value, text, indent + 2);
        first = false;
    }
    text += "\n" + std::string(indent, ' ') + (json.is_object() ? "}" : "]");
}

class SceneWriter {
public:
    SceneWriter(const Scene& scene, fs::path folder) : scene_(scene), folder_(std::move(folder)) {}

    Result<std::string> write() {
        chooseNames();
        Json json = {{"tyndall", 1}};
        put(json, "name", scene_.name, std::string());
        Json nodes = Json::array();
        for (size_t i = 0; i < scene_.nodes.size(); ++i) {
            if (scene_.nodes[i].source != kNone) continue;
            auto written = node(i);
            if (!written) return written.error();
            nodes.push_back(std::move(*written));
        }
        if (!nodes.empty()) json["nodes"] = std::move(nodes);
        if (scene_.activeCamera != kNone) put(json, "camera", cameraName(), std::string());
        if (Json written = environment(); !written.empty())
            json["environment"] = std::move(written);
        if (scene_.ev100 != 0) json["exposure"]["ev100"] = number(scene_.ev100);
        for (const std::string& setting : scene_.settings) {
            const size_t equals = setting.find('=');
            json["settings"][setting.substr(0, equals)] = settingValue(setting.substr(equals + 1));
        }
        std::string text;
        print(json, text, 0);
        return text + "\n";
    }

private:
    /// Names of nodes that others refer to must be there and unique.
    void chooseNames() {
        std::set<std::string> taken;
        std::vector<bool> needed(scene_.nodes.size(), false);
        for (const Node& node : scene_.nodes)
            if (node.source == kNone && node.parent != kNone) needed[size_t(node.parent)] = true;
        if (scene_.activeCamera != kNone) needed[size_t(scene_.activeCamera)] = true;
        for (size_t i = 0; i < scene_.nodes.size(); ++i) {
            std::string name = scene_.nodes[i].name;
            if (scene_.nodes[i].source == kNone) {
                if (name.empty() && needed[i]) name = fmt::format("node {}", i);
                const std::string base = name;
                for (int n = 2; !name.empty() && !taken.insert(name).second; ++n)
                    name = fmt::format("{} {}", base, n);
            }
            names_.push_back(std::move(name));
        }
    }

    [[nodiscard]] std::string cameraName() const { return names_[size_t(scene_.activeCamera)]; }

    [[nodiscard]] std::string file(const std::string& name) const {
        const fs::path to = fs::absolute(folder_.empty() ? "." : folder_);
        const fs::path from = scene_.path.empty() ? to : fs::absolute(scene_.path).parent_path();
        if (from.lexically_normal() == to.lexically_normal() || fs::path(name).is_absolute())
            return name;
        return (from / name)
            .lexically_normal()
            .lexically_relative(to.lexically_normal())
            .generic_string();
    }

    Result<Json> node(size_t index) const {
        const Node& node = scene_.nodes[index];
        Json json = Json::object();
        put(json, "name", names_[index], std::string());
        if (node.parent != kNone) json["parent"] = names_[size_t(node.parent)];
        if (!node.gltf.empty()) json["gltf"] = file(node.gltf);
        if (node.primitive) {
            json["primitive"] = {
                {"shape", std::string(kPrimitiveShapeNames[size_t(node.primitive->shape)])}};
            put(json["primitive"], "size", node.primitive->size, dvec3(1));
            if (Json written =
                    material(scene_.materialOf(scene_.meshes[size_t(node.meshes.at(0))]));
                !written.empty())
                json["material"] = std::move(written);
        } else if (!node.meshes.empty()) {
            return Error{fmt::format(
                "node '{}' has a mesh that no file brought in, so that a scene file cannot hold it",
                node.name)};
        }
        if (node.light != kNone) json["light"] = light(scene_.lights[size_t(node.light)]);
        if (node.medium != kNone) json["medium"] = medium(scene_.media[size_t(node.medium)], node);
        if (node.camera != kNone) json["camera"] = camera(scene_.cameras[size_t(node.camera)]);
        transform(json, node);
        put(json, "visible", node.visible, true);
        if (node.animations.size() == 1)
            json["animate"] = animation(node.animations[0]);
        else
            for (const Animation& one : node.animations) json["animate"].push_back(animation(one));
        return json;
    }

    static void transform(Json& json, const Node& node) {
        if (node.matrix) {
            for (int i = 0; i < 16; ++i)
                json["matrix"].push_back(number((*node.matrix)[i / 4][i % 4]));
            return;
        }
        put(json, "translation", node.translation, dvec3(0));
        const dvec4 rotation(node.rotation.x, node.rotation.y, node.rotation.z, node.rotation.w);
        put(json, "rotation", rotation, dvec4(0, 0, 0, 1));
        put(json, "scale", node.scale, dvec3(1));
    }

    [[nodiscard]] Json material(const Material& material) const {
        Json json = Json::object();
        if (material.baseColor != vec4(1))
            json["baseColor"] = material.baseColor.w == 1 ? numbers(vec3(material.baseColor))
                                                          : numbers(material.baseColor);
        put(json, "metallic", material.metallic, 0.0f);
        put(json, "roughness", material.roughness, 1.0f);
        put(json, "specular", material.specular, 1.0f);
        put(json, "emissive", material.emissive, vec3(0));
        put(json, "alphaMode", std::string(kAlphaModes[size_t(material.alphaMode)]),
            std::string("OPAQUE"));
        put(json, "alphaCutoff", material.alphaCutoff, 0.5f);
        put(json, "doubleSided", material.doubleSided, false);
        put(json, "unlit", material.unlit, false);
        put(json, "normalScale", material.normalScale, 1.0f);
        put(json, "occlusionStrength", material.occlusionStrength, 1.0f);
        const std::pair<const char*, const TextureRef*> textures[] = {
            {"baseColorTexture", &material.baseColorTexture},
            {"metallicRoughnessTexture", &material.metallicRoughnessTexture},
            {"normalTexture", &material.normalTexture},
            {"occlusionTexture", &material.occlusionTexture},
            {"emissiveTexture", &material.emissiveTexture}};
        for (const auto& [key, reference] : textures)
            if (reference->texture != kNone)
                json[key] = file(
                    scene_.images[size_t(scene_.textures[size_t(reference->texture)].image)].file);
        return json;
    }

    static Json light(const Light& light) {
        Json json = {{"type", std::string(kLightTypes[size_t(light.type)])}};
        if (light.type == LightType::Rect) {
            json["size"] = numbers(light.size);
            json["radiance"] = numbers(light.radiance);
        } else {
            put(json, "color", light.color, vec3(1));
            json["intensity"] = number(light.intensity);
            put(json, "radius", light.radius, 0.0f);
        }
        if (light.type == LightType::Point || light.type == LightType::Spot)
            put(json, "range", light.range, 0.0f);
        if (light.type == LightType::Spot) {
            put(json, "innerConeAngle", light.innerConeAngle, 0.0f);
            put(json, "outerConeAngle", light.outerConeAngle, float(kPi / 4));
        }
        put(json, "castsShadows", light.castsShadows, true);
        return json;
    }

    static Json camera(const Camera& camera) {
        const Camera usual;
        const bool perspective = camera.type == CameraType::Perspective;
        Json json = {{"type", perspective ? "perspective" : "orthographic"}};
        if (perspective)
            put(json, "yfov", camera.yfov, usual.yfov);
        else
            put(json, "ymag", camera.ymag, usual.ymag);
        put(json, "znear", camera.znear, usual.znear);
        return json;
    }

    [[nodiscard]] Json medium(const Medium& medium, const Node& node) const {
        Json json;
        if (medium.particles)
            particleSource(json, medium, node);
        else if (medium.kind == MediumKind::Grid)
            gridSource(json, medium, node);
        else {
            json["type"] = "homogeneous";
            json["shape"] = std::string(kShapes[size_t(medium.kind)]);
            if (medium.kind == MediumKind::Box || medium.kind == MediumKind::Sphere)
                put(json, "size", medium.size, dvec3(1));
            if (medium.kind == MediumKind::Height)
                put(json, "scaleHeight", medium.scaleHeight, 1.0);
        }
        put(json, "scattering", medium.scattering, vec3(0));
        put(json, "absorption", medium.absorption, vec3(0));
        put(json, "anisotropy", medium.anisotropy, 0.0f);
        put(json, "phase", std::string(kPhases[size_t(medium.phase)]),
            std::string("henyey-greenstein"));
        if (!medium.temperatureGridName.empty()) {
            json["emission"] = {{"temperatureGrid", medium.temperatureGridName}};
            put(json["emission"], "scale", medium.temperatureScale, 1.0f);
        } else {
            put(json, "emission", medium.emission, vec3(0));
        }
        return json;
    }

    void gridSource(Json& json, const Medium& medium, const Node& node) const {
        json["type"] = "grid";
        json["file"] = file(medium.file);
        put(json, "grid", medium.gridName, std::string());
        if (!node.sequence) return;
        json["frames"] = {node.sequence->first, node.sequence->last};
        put(json, "fps", node.sequence->fps, 24.0);
        put(json, "loop", node.sequence->loop, false);
    }

    void particleSource(Json& json, const Medium& medium, const Node& node) const {
        json["type"] = "particles";
        if (!medium.file.empty()) json["file"] = file(medium.file);
        if (!node.particles) return;
        json["generate"] = {{"kind", node.particles->kind},
                            {"count", node.particles->count},
                            {"seed", node.particles->seed}};
        put(json["generate"], "radius", node.particles->radius, 1.0);
    }

    static Json animation(const Animation& animation) {
        Json json = {{"property", animation.property}};
        for (const double time : animation.times) json["times"].push_back(number(time));
        for (const double value : animation.values) json["values"].push_back(number(value));
        put(json, "interpolation", std::string(kInterpolations[size_t(animation.interpolation)]),
            std::string("LINEAR"));
        return json;
    }

    [[nodiscard]] Json environment() const {
        const Environment& environment = scene_.environment;
        Json json = Json::object();
        if (environment.file.empty()) {
            put(json, "radiance", environment.radiance, vec3(0));
            return json;
        }
        json["file"] = file(environment.file);
        put(json, "intensity", environment.intensity, 1.0f);
        put(json, "rotation", environment.rotation, 0.0f);
        return json;
    }

    /// As a number or a switch where that reads back as the same text.
    static Json settingValue(const std::string& text) {
        if (text == "true" || text == "false") return text == "true";
        const Json parsed = Json::parse(text, nullptr, false);
        return parsed.is_number() && parsed.dump() == text ? parsed : Json(text);
    }

    const Scene& scene_;
    fs::path folder_;
    std::vector<std::string> names_;
};

} // namespace

Result<std::string> sceneFileText(const Scene& scene, const fs::path& folder) {
    try {
        return SceneWriter(scene, folder).write();
    } catch (const Json::exception&) {
        return Error{fmt::format(
            "scene '{}' holds a name that is not UTF-8, so that a scene file cannot hold it",
            scene.path.string())};
    }
}

Result<void> writeSceneFile(const Scene& scene, const fs::path& path) {
    const auto text = sceneFileText(scene, path.parent_path());
    if (!text) return text.error();
    return writeFileAtomically(path, *text);
}

} // namespace tyndall
