// What nodes carry, and what belongs to the whole scene.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/image.h"
#include "scene/image_decode.h"
#include "scene/json_convert.h"
#include "scene/scene_reader.h"

namespace tyndall {
namespace {

constexpr std::string_view kAlphaModes[] = {"OPAQUE", "MASK", "BLEND"};
constexpr std::string_view kLightTypes[] = {"directional", "point", "spot", "rect"};

std::string settingText(const Json& value) {
    if (value.is_string()) return value.get<std::string>();
    return value.dump(); // shortest text that reads back as the same number
}

} // namespace

Result<int> SceneReader::readMaterial(const Json& json, const std::string& pointer,
                                      const std::string& name) {
    Material material;
    material.name = name;
    material.metallic = floatOr(json, "metallic",
                                0.0f); // unlike glTF: a bare primitive is matt and white, not metal
    material.roughness = floatOr(json, "roughness", material.roughness);
    material.specular = floatOr(json, "specular", material.specular);
    material.emissive = colorOr(json, "emissive", material.emissive);
    material.alphaCutoff = floatOr(json, "alphaCutoff", material.alphaCutoff);
    material.normalScale = floatOr(json, "normalScale", material.normalScale);
    material.occlusionStrength = floatOr(json, "occlusionStrength", material.occlusionStrength);
    material.doubleSided = json.value("doubleSided", false);
    material.unlit = json.value("unlit", false);
    material.alphaMode =
        AlphaMode(indexOf(kAlphaModes, json.value("alphaMode", std::string("OPAQUE"))));
    if (const auto color = json.find("baseColor"); color != json.end())
        material.baseColor =
            vec4(vec3(toVector(*color)), color->size() == 4 ? (*color)[3].get<float>() : 1.0f);
    const std::pair<const char*, TextureRef*> textures[] = {
        {"baseColorTexture", &material.baseColorTexture},
        {"metallicRoughnessTexture", &material.metallicRoughnessTexture},
        {"normalTexture", &material.normalTexture},
        {"occlusionTexture", &material.occlusionTexture},
        {"emissiveTexture", &material.emissiveTexture}};
    for (const auto& [key, reference] : textures) {
        const auto file = json.find(key);
        if (file == json.end()) continue;
        auto texture = readTexture(file->get<std::string>(), pointer + "/" + key);
        if (!texture) return texture.error();
        reference->texture = *texture;
    }
    scene_.materials.push_back(std::move(material));
    return int(scene_.materials.size() - 1);
}

Result<int> SceneReader::readTexture(const std::string& file, const std::string& pointer) {
    if (const auto found = textures_.find(file); found != textures_.end()) return found->second;
    const auto bytes = readFile(resolved(file));
    if (!bytes) return at(pointer + ":", bytes.message());
    auto image = decodeImage({reinterpret_cast<const uint8_t*>(bytes->data()), bytes->size()});
    if (!image) return at(pointer, fmt::format("is '{}', but {}", file, image.message()));
    image->name = image->file = file;
    Texture texture;
    texture.image = int(scene_.images.size());
    scene_.images.push_back(std::move(*image));
    scene_.textures.push_back(texture);
    return textures_[file] = int(scene_.textures.size() - 1);
}

Result<int> SceneReader::readLight(const Json& json, const std::string& pointer,
                                   const std::string& name) {
    Light light;
    light.name = name;
    const std::string type = json.at("type").get<std::string>();
    light.type = LightType(indexOf(kLightTypes, type));
    Result<void> keys;
    switch (light.type) {
    case LightType::Directional:
        keys = onlyKeys(json, pointer, "a directional light",
                        {"type", "color", "intensity", "radius", "castsShadows"});
        break;
    case LightType::Point:
        keys = onlyKeys(json, pointer, "a point light",
                        {"type", "color", "intensity", "range", "radius", "castsShadows"});
        break;
    case LightType::Spot:
        keys = onlyKeys(json, pointer, "a spot light",
                        {"type", "color", "intensity", "range", "radius", "innerConeAngle",
                         "outerConeAngle", "castsShadows"});
        break;
    case LightType::Rect:
        keys =
            onlyKeys(json, pointer, "a rect light", {"type", "size", "radiance", "castsShadows"});
        break;
    }
    if (!keys) return keys.error();
    light.color = colorOr(json, "color", light.color);
    light.intensity = floatOr(json, "intensity", light.intensity);
    light.range = floatOr(json, "range", light.range);
    light.radius = floatOr(json, "radius", light.radius);
    light.innerConeAngle = floatOr(json, "innerConeAngle", light.innerConeAngle);
    light.outerConeAngle = floatOr(json, "outerConeAngle", light.outerConeAngle);
    light.radiance = colorOr(json, "radiance", light.radiance);
    light.castsShadows = json.value("castsShadows", true);
    if (const auto size = json.find("size"); size != json.end())
        light.size = {(*size)[0].get<float>(), (*size)[1].get<float>()};
    if (light.type == LightType::Spot && !(light.innerConeAngle < light.outerConeAngle))
        return at(pointer + "/innerConeAngle",
                  fmt::format("is {} but must be less than outerConeAngle, {}",
                              light.innerConeAngle, light.outerConeAngle));
    if (light.type == LightType::Directional && light.radius > float(kPi / 2))
        return at(
            pointer + "/radius",
            fmt::format("is {} but must be at most pi/2: a directional light's radius is an angle",
                        light.radius));
    scene_.lights.push_back(std::move(light));
    return int(scene_.lights.size() - 1);
}

Result<int> SceneReader::readCamera(const Json& json, const std::string& pointer,
                                    const std::string& name) {
    Camera camera;
    camera.name = name;
    const bool perspective = json.at("type").get<std::string>() == "perspective";
    camera.type = perspective ? CameraType::Perspective : CameraType::Orthographic;
    const auto keys =
        perspective ? onlyKeys(json, pointer, "a perspective camera", {"type", "yfov", "znear"})
                    : onlyKeys(json, pointer, "an orthographic camera", {"type", "ymag", "znear"});
    if (!keys) return keys.error();
    camera.yfov = json.value("yfov", camera.yfov);
    camera.ymag = json.value("ymag", camera.ymag);
    camera.znear = json.value("znear", camera.znear);
    scene_.cameras.push_back(std::move(camera));
    return int(scene_.cameras.size() - 1);
}

Result<void> SceneReader::readEnvironment(const Json& json) {
    Environment& environment = scene_.environment;
    const auto file = json.find("file");
    if (file == json.end()) {
        if (auto keys =
                onlyKeys(json, "/environment", "an environment without a file", {"radiance"});
            !keys)
            return keys;
        environment.radiance = colorOr(json, "radiance", environment.radiance);
        return {};
    }
    if (auto keys = onlyKeys(json, "/environment", "an environment from a file",
                             {"file", "intensity", "rotation"});
        !keys)
        return keys;
    environment.file = file->get<std::string>();
    environment.intensity = floatOr(json, "intensity", environment.intensity);
    environment.rotation = floatOr(json, "rotation", environment.rotation);
    if (auto goOn = progress(0.9f, environment.file); !goOn) return goOn;
    auto image = readHdr(resolved(environment.file));
    if (!image) return at("/environment/file:", image.message());
    size_t repaired = 0;
    for (float& value : image->pixels)
        if (!(value >= 0 && value <= 1e30f)) {
            value = 0;
            ++repaired;
        }
    if (repaired > 0)
        loaded_.notes.push_back(fmt::format("{}: {} negative or non-finite values were set to 0",
                                            environment.file, repaired));
    environment.image = std::make_shared<const Image>(std::move(*image));
    return {};
}

Result<void> SceneReader::readWholeScene(const Json& json) {
    if (const auto environment = json.find("environment"); environment != json.end())
        if (auto read = readEnvironment(*environment); !read) return read;
    if (const auto exposure = json.find("exposure"); exposure != json.end())
        scene_.ev100 = floatOr(*exposure, "ev100", 0.0f);
    if (const auto settings = json.find("settings"); settings != json.end())
        for (const auto& [key, value] : settings->items()) {
            if (key.empty() || key.find('=') != std::string::npos)
                return at("/settings", fmt::format("has the key '{}', which is no setting", key));
            scene_.settings.push_back(key + "=" + settingText(value));
        }
    return chooseCamera(json);
}

Result<void> SceneReader::chooseCamera(const Json& json) {
    const auto wanted = json.find("camera");
    std::map<std::string, int> cameras;
    for (size_t i = 0; i < scene_.nodes.size(); ++i) {
        if (scene_.nodes[i].camera == kNone) continue;
        if (scene_.activeCamera == kNone && wanted == json.end()) scene_.activeCamera = int(i);
        cameras.emplace(scene_.nodes[i].name,
                        int(i)); // the file's own nodes come before those of glTF files
    }
    if (wanted == json.end()) return {};
    const auto found = cameras.find(wanted->get<std::string>());
    if (found == cameras.end()) {
        std::string list;
        for (const auto& [name, unused] : cameras) list += (list.empty() ? "" : ", ") + name;
        return at("/camera",
                  fmt::format("is '{}', which is not the name of a node with a camera; there is {}",
                              wanted->get<std::string>(), list.empty() ? "none" : list));
    }
    scene_.activeCamera = found->second;
    return {};
}

} // namespace tyndall
