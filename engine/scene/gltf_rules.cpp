#include "scene/gltf_rules.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scene/json_schema.h"

namespace tyndall {
namespace {

constexpr std::array<std::string_view, 10> kUnderstood = {
    "KHR_materials_unlit",     "KHR_materials_emissive_strength", "KHR_materials_specular",
    "KHR_texture_transform",   "KHR_mesh_quantization",           "KHR_lights_punctual",
    "EXT_mesh_gpu_instancing", "KHR_draco_mesh_compression",      "EXT_meshopt_compression",
    "EXT_texture_webp",
};

// What arithmetic in single precision (rounding error 6e-8) has left after many steps; exporters write it.
constexpr double kRoundingError = 1e-5;

// In the subset of JSON Schema of json_schema.h, with its `tolerance` (kRoundingError). Only what is read; other keys may hold anything.
constexpr char kRules[] = R"RULES({
 "type": "object", "required": ["asset"],
 "properties": {
  "asset": {"type": "object", "required": ["version"], "properties": {"version": {"type": "string"}, "minVersion": {"type": "string"}}},
  "extensionsUsed": {"type": "array", "maxItems": 1000, "items": {"type": "string"}},
  "extensionsRequired": {"type": "array", "maxItems": 1000, "items": {"type": "string"}},
  "scene": {"$ref": "#/$defs/index"},
  "scenes": {"type": "array", "maxItems": 100000, "items": {"type": "object", "properties": {"name": {"type": "string"}, "nodes": {"$ref": "#/$defs/indices"}}}},
  "nodes": {"type": "array", "maxItems": 1000000, "items": {"$ref": "#/$defs/node"}},
  "meshes": {"type": "array", "maxItems": 1000000, "items": {"type": "object", "required": ["primitives"], "properties": {
    "name": {"type": "string"}, "weights": {"$ref": "#/$defs/numbers"},
    "primitives": {"type": "array", "items": {"$ref": "#/$defs/primitive"}}}}},
  "accessors": {"type": "array", "maxItems": 1000000, "items": {"$ref": "#/$defs/accessor"}},
  "bufferViews": {"type": "array", "maxItems": 1000000, "items": {"$ref": "#/$defs/bufferView"}},
  "buffers": {"type": "array", "maxItems": 100000, "items": {"type": "object", "required": ["byteLength"], "properties": {
    "uri": {"type": "string"}, "byteLength": {"$ref": "#/$defs/bytes"}}}},
  "images": {"type": "array", "maxItems": 100000, "items": {"type": "object", "properties": {
    "name": {"type": "string"}, "uri": {"type": "string"}, "mimeType": {"type": "string"}, "bufferView": {"$ref": "#/$defs/index"}}}},
  "textures": {"type": "array", "maxItems": 100000, "items": {"type": "object", "properties": {
    "sampler": {"$ref": "#/$defs/index"}, "source": {"$ref": "#/$defs/index"},
    "extensions": {"type": "object", "properties": {"EXT_texture_webp": {"type": "object", "required": ["source"],
      "properties": {"source": {"$ref": "#/$defs/index"}}}}}}}},
  "samplers": {"type": "array", "maxItems": 100000, "items": {"type": "object", "properties": {
    "magFilter": {"enum": [9728, 9729]}, "minFilter": {"enum": [9728, 9729, 9984, 9985, 9986, 9987]},
    "wrapS": {"enum": [10497, 33071, 33648]}, "wrapT": {"enum": [10497, 33071, 33648]}}}},
  "materials": {"type": "array", "maxItems": 100000, "items": {"$ref": "#/$defs/material"}},
  "cameras": {"type": "array", "maxItems": 100000, "items": {"$ref": "#/$defs/camera"}},
  "skins": {"type": "array", "maxItems": 100000, "items": {"type": "object", "required": ["joints"], "properties": {
    "inverseBindMatrices": {"$ref": "#/$defs/index"}, "joints": {"$ref": "#/$defs/indices"}}}},
  "animations": {"type": "array", "maxItems": 100000},
  "extensions": {"type": "object", "properties": {"KHR_lights_punctual": {"type": "object", "required": ["lights"], "properties": {
    "lights": {"type": "array", "maxItems": 100000, "items": {"$ref": "#/$defs/light"}}}}}}
 },
 "$defs": {
  "index": {"type": "integer", "minimum": 0, "maximum": 2147483647},
  "indices": {"type": "array", "items": {"$ref": "#/$defs/index"}},
  "attributes": {"type": "object", "additionalProperties": {"$ref": "#/$defs/index"}},
  "bytes": {"type": "integer", "minimum": 0, "maximum": 1099511627776},
  "count": {"type": "integer", "minimum": 0, "maximum": 4294967295},
  "number": {"type": "number", "minimum": -1e30, "maximum": 1e30},
  "positive": {"type": "number", "minimum": 0, "maximum": 1e30, "tolerance": 1e-5},
  "numbers": {"type": "array", "items": {"$ref": "#/$defs/number"}},
  "unit": {"type": "number", "minimum": 0, "maximum": 1, "tolerance": 1e-5},
  "vec2": {"type": "array", "minItems": 2, "maxItems": 2, "items": {"$ref": "#/$defs/number"}},
  "vec3": {"type": "array", "minItems": 3, "maxItems": 3, "items": {"$ref": "#/$defs/number"}},
  "vec4": {"type": "array", "minItems": 4, "maxItems": 4, "items": {"$ref": "#/$defs/number"}},
  "color": {"type": "array", "minItems": 3, "maxItems": 3, "items": {"$ref": "#/$defs/positive"}},
  "color4": {"type": "array", "minItems": 4, "maxItems": 4, "items": {"$ref": "#/$defs/unit"}},
  "componentType": {"enum": [5120, 5121, 5122, 5123, 5125, 5126]},
  "node": {"type": "object", "properties": {
    "name": {"type": "string"}, "children": {"$ref": "#/$defs/indices"}, "mesh": {"$ref": "#/$defs/index"},
    "camera": {"$ref": "#/$defs/index"}, "skin": {"$ref": "#/$defs/index"},
    "matrix": {"type": "array", "minItems": 16, "maxItems": 16, "items": {"$ref": "#/$defs/number"}},
    "translation": {"$ref": "#/$defs/vec3"}, "rotation": {"$ref": "#/$defs/vec4"}, "scale": {"$ref": "#/$defs/vec3"},
    "weights": {"$ref": "#/$defs/numbers"},
    "extensions": {"type": "object", "properties": {
      "KHR_lights_punctual": {"type": "object", "required": ["light"], "properties": {"light": {"$ref": "#/$defs/index"}}},
      "EXT_mesh_gpu_instancing": {"type": "object", "required": ["attributes"], "properties": {"attributes": {"$ref": "#/$defs/attributes"}}}}}}},
  "primitive": {"type": "object", "required": ["attributes"], "properties": {
    "attributes": {"$ref": "#/$defs/attributes"}, "indices": {"$ref": "#/$defs/index"}, "material": {"$ref": "#/$defs/index"},
    "mode": {"type": "integer", "minimum": 0, "maximum": 6},
    "targets": {"type": "array", "maxItems": 1000, "items": {"$ref": "#/$defs/attributes"}},
    "extensions": {"type": "object", "properties": {"KHR_draco_mesh_compression": {"type": "object", "required": ["bufferView", "attributes"],
      "properties": {"bufferView": {"$ref": "#/$defs/index"}, "attributes": {"$ref": "#/$defs/attributes"}}}}}}},
  "accessor": {"type": "object", "required": ["componentType", "count", "type"], "properties": {
    "bufferView": {"$ref": "#/$defs/index"}, "byteOffset": {"$ref": "#/$defs/bytes"}, "componentType": {"$ref": "#/$defs/componentType"},
    "normalized": {"type": "boolean"}, "count": {"$ref": "#/$defs/count"},
    "type": {"enum": ["SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"]},
    "sparse": {"type": "object", "required": ["count", "indices", "values"], "properties": {
      "count": {"$ref": "#/$defs/index"},
      "indices": {"type": "object", "required": ["bufferView", "componentType"], "properties": {
        "bufferView": {"$ref": "#/$defs/index"}, "byteOffset": {"$ref": "#/$defs/index"}, "componentType": {"enum": [5121, 5123, 5125]}}},
      "values": {"type": "object", "required": ["bufferView"], "properties": {
        "bufferView": {"$ref": "#/$defs/index"}, "byteOffset": {"$ref": "#/$defs/index"}}}}}}},
  "bufferView": {"type": "object", "required": ["buffer", "byteLength"], "properties": {
    "buffer": {"$ref": "#/$defs/index"}, "byteOffset": {"$ref": "#/$defs/bytes"}, "byteLength": {"$ref": "#/$defs/bytes"},
    "byteStride": {"type": "integer", "minimum": 1, "maximum": 256},
    "extensions": {"type": "object", "properties": {"EXT_meshopt_compression": {"type": "object",
      "required": ["buffer", "byteLength", "byteStride", "count", "mode"], "properties": {
      "buffer": {"$ref": "#/$defs/index"}, "byteOffset": {"$ref": "#/$defs/bytes"}, "byteLength": {"$ref": "#/$defs/bytes"},
      "byteStride": {"type": "integer", "minimum": 1, "maximum": 256}, "count": {"$ref": "#/$defs/count"},
      "mode": {"enum": ["ATTRIBUTES", "TRIANGLES", "INDICES"]},
      "filter": {"enum": ["NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"]}}}}}}},
  "texture": {"type": "object", "required": ["index"], "properties": {
    "index": {"$ref": "#/$defs/index"}, "texCoord": {"$ref": "#/$defs/index"}, "scale": {"$ref": "#/$defs/number"}, "strength": {"$ref": "#/$defs/unit"},
    "extensions": {"type": "object", "properties": {"KHR_texture_transform": {"type": "object", "properties": {
      "offset": {"$ref": "#/$defs/vec2"}, "scale": {"$ref": "#/$defs/vec2"}, "rotation": {"$ref": "#/$defs/number"},
      "texCoord": {"$ref": "#/$defs/index"}}}}}}},
  "material": {"type": "object", "properties": {
    "name": {"type": "string"}, "emissiveFactor": {"$ref": "#/$defs/color"}, "alphaMode": {"enum": ["OPAQUE", "MASK", "BLEND"]},
    "alphaCutoff": {"$ref": "#/$defs/positive"}, "doubleSided": {"type": "boolean"},
    "normalTexture": {"$ref": "#/$defs/texture"}, "occlusionTexture": {"$ref": "#/$defs/texture"}, "emissiveTexture": {"$ref": "#/$defs/texture"},
    "pbrMetallicRoughness": {"type": "object", "properties": {
      "baseColorFactor": {"$ref": "#/$defs/color4"}, "metallicFactor": {"$ref": "#/$defs/unit"}, "roughnessFactor": {"$ref": "#/$defs/unit"},
      "baseColorTexture": {"$ref": "#/$defs/texture"}, "metallicRoughnessTexture": {"$ref": "#/$defs/texture"}}},
    "extensions": {"type": "object", "properties": {
      "KHR_materials_unlit": {"type": "object"},
      "KHR_materials_emissive_strength": {"type": "object", "properties": {"emissiveStrength": {"$ref": "#/$defs/positive"}}},
      "KHR_materials_specular": {"type": "object", "properties": {"specularFactor": {"$ref": "#/$defs/unit"}}}}}}},
  "camera": {"type": "object", "required": ["type"], "properties": {
    "name": {"type": "string"}, "type": {"enum": ["perspective", "orthographic"]},
    "perspective": {"type": "object", "required": ["yfov", "znear"], "properties": {
      "yfov": {"type": "number", "minimum": 0.000001, "exclusiveMaximum": 3.141592}, "znear": {"type": "number", "minimum": 1e-30, "maximum": 1e30}}},
    "orthographic": {"type": "object", "required": ["ymag", "znear"], "properties": {"ymag": {"$ref": "#/$defs/number"}, "znear": {"$ref": "#/$defs/positive"}}}}},
  "light": {"type": "object", "required": ["type"], "properties": {
    "name": {"type": "string"}, "type": {"enum": ["directional", "point", "spot"]}, "color": {"$ref": "#/$defs/color"},
    "intensity": {"$ref": "#/$defs/positive"}, "range": {"$ref": "#/$defs/positive"},
    "spot": {"type": "object", "properties": {
      "innerConeAngle": {"type": "number", "minimum": 0, "maximum": 1.5707964, "tolerance": 1e-5}, "outerConeAngle": {"type": "number", "minimum": 0, "maximum": 1.5707964, "tolerance": 1e-5}}}}}
 }
})RULES";

const Json& rules() {
    static const Json parsed = Json::parse(kRules);
    return parsed;
}

struct Reference {
    std::string_view place;  // "*": every element or member
    std::string_view target; // the array it indexes
};

constexpr Reference kReferences[] = {
    {"scene", "scenes"},
    {"scenes/*/nodes/*", "nodes"},
    {"nodes/*/children/*", "nodes"},
    {"nodes/*/mesh", "meshes"},
    {"nodes/*/camera", "cameras"},
    {"nodes/*/skin", "skins"},
    {"nodes/*/extensions/KHR_lights_punctual/light", "extensions/KHR_lights_punctual/lights"},
    {"nodes/*/extensions/EXT_mesh_gpu_instancing/attributes/*", "accessors"},
    {"meshes/*/primitives/*/attributes/*", "accessors"},
    {"meshes/*/primitives/*/indices", "accessors"},
    {"meshes/*/primitives/*/material", "materials"},
    {"meshes/*/primitives/*/targets/*/*", "accessors"},
    {"meshes/*/primitives/*/extensions/KHR_draco_mesh_compression/bufferView", "bufferViews"},
    {"accessors/*/bufferView", "bufferViews"},
    {"accessors/*/sparse/indices/bufferView", "bufferViews"},
    {"accessors/*/sparse/values/bufferView", "bufferViews"},
    {"bufferViews/*/buffer", "buffers"},
    {"bufferViews/*/extensions/EXT_meshopt_compression/buffer", "buffers"},
    {"images/*/bufferView", "bufferViews"},
    {"textures/*/sampler", "samplers"},
    {"textures/*/source", "images"},
    {"textures/*/extensions/EXT_texture_webp/source", "images"},
    {"materials/*/normalTexture/index", "textures"},
    {"materials/*/occlusionTexture/index", "textures"},
    {"materials/*/emissiveTexture/index", "textures"},
    {"materials/*/pbrMetallicRoughness/baseColorTexture/index", "textures"},
    {"materials/*/pbrMetallicRoughness/metallicRoughnessTexture/index", "textures"},
    {"skins/*/inverseBindMatrices", "accessors"},
    {"skins/*/joints/*", "nodes"},
};

size_t sizeOf(const Json& gltf, std::string_view target) {
    const Json* here = &gltf;
    while (!target.empty()) {
        const size_t slash = target.find('/');
        const auto found = here->find(std::string(target.substr(0, slash)));
        if (found == here->end()) return 0;
        here = &*found;
        target = slash == std::string_view::npos ? std::string_view() : target.substr(slash + 1);
    }
    return here->size();
}

/// Follows `place` and judges every index that it leads to.
Result<void> checkReference(const Json& here, std::string_view place, const std::string& pointer,
                            size_t size, std::string_view target) {
    if (place.empty()) {
        if (here.get<uint64_t>() < size) return {};
        return Error{
            fmt::format("{} is {}, but '{}' has {} elements", pointer, here.dump(), target, size)};
    }
    const size_t slash = place.find('/');
    const std::string step(place.substr(0, slash));
    const std::string_view rest =
        slash == std::string_view::npos ? std::string_view() : place.substr(slash + 1);
    if (step == "*") {
        for (const auto& [key, member] : here.items())
            if (auto inside = checkReference(member, rest, pointer + "/" + key, size, target);
                !inside)
                return inside;
        return {};
    }
    const auto found = here.find(step);
    return found == here.end() ? Result<void>()
                               : checkReference(*found, rest, pointer + "/" + step, size, target);
}

std::string outside(const std::string& first, size_t count) {
    const std::string others =
        count > 1 ? fmt::format(" (also in {} other places)", count - 1) : "";
    return fmt::format("{}, a rounding error outside of glTF's limits; the limit is taken{}", first,
                       others);
}

/// The last row of a matrix. Returns how many of its numbers had to be set.
Result<size_t> settleMatrix(Json& matrix, const std::string& pointer) {
    size_t settled = 0;
    for (const size_t place : {3, 7, 11, 15}) {
        const double right = place == 15 ? 1 : 0;
        const double wrong = std::abs(matrix[place].get<double>() - right);
        if (wrong > kRoundingError)
            return Error{
                pointer +
                " is not affine: its last row (elements 3, 7, 11 and 15) must be 0, 0, 0, 1"};
        if (wrong == 0) continue;
        matrix[place] = right;
        ++settled;
    }
    return settled;
}

/// Matrices must be affine. Quaternions are normalised later whatever their length; it is said where that is more than rounding.
Result<void> checkTransforms(Json& gltf, std::vector<std::string>& notes) {
    const auto nodes = gltf.find("nodes");
    if (nodes == gltf.end()) return {};
    std::string firstMatrix, firstRotation;
    size_t matrices = 0, rotations = 0;
    for (size_t i = 0; i < nodes->size(); ++i) {
        Json& node = (*nodes)[i];
        if (const auto matrix = node.find("matrix"); matrix != node.end()) {
            const std::string pointer = fmt::format("/nodes/{}/matrix", i);
            const auto settled = settleMatrix(*matrix, pointer);
            if (!settled) return settled.error();
            if (*settled > 0 && matrices++ == 0)
                firstMatrix = pointer + " has a last row that is not 0, 0, 0, 1";
        }
        if (const auto rotation = node.find("rotation"); rotation != node.end()) {
            double squares = 0;
            for (const Json& component : *rotation)
                squares += component.get<double>() * component.get<double>();
            if (std::abs(std::sqrt(squares) - 1) > kRoundingError && rotations++ == 0)
                firstRotation =
                    fmt::format("/nodes/{}/rotation has the length {:.6g}", i, std::sqrt(squares));
        }
    }
    if (matrices > 0) notes.push_back(outside(firstMatrix, matrices));
    if (rotations > 0)
        notes.push_back(
            fmt::format("{} instead of 1 and is normalised{}", firstRotation,
                        rotations > 1 ? fmt::format(" (so are {} others)", rotations - 1) : ""));
    return {};
}

} // namespace

Result<void> checkGltfRules(Json& gltf, std::vector<std::string>& notes) {
    if (const Rounded rounded = roundIntoLimits(gltf, rules()); rounded.count > 0)
        notes.push_back(outside(rounded.first, rounded.count));
    if (auto valid = validateJson(gltf, rules()); !valid) return valid;
    for (const Reference& reference : kReferences)
        if (auto valid = checkReference(gltf, reference.place, "", sizeOf(gltf, reference.target),
                                        reference.target);
            !valid)
            return valid;
    if (auto valid = checkTransforms(gltf, notes); !valid) return valid;
    const Json cameras = gltf.value("cameras", Json::array());
    for (size_t i = 0; i < cameras.size(); ++i)
        if (const auto type = cameras[i].at("type").get<std::string>(); !cameras[i].contains(type))
            return Error{fmt::format("/cameras/{} is {} but lacks the key '{}'", i, type, type)};
    const Json& asset = gltf.at("asset");
    if (const std::string version = asset.at("version").get<std::string>();
        !version.starts_with("2."))
        return Error{fmt::format("/asset/version is '{}', but only glTF 2.x is read",
                                 version.substr(0, 40))};
    if (const std::string version = asset.value("minVersion", std::string("2.0")); version != "2.0")
        return Error{fmt::format("/asset/minVersion is '{}', but only glTF 2.0 is understood",
                                 version.substr(0, 40))};
    return {};
}

void keepWhatRulesJudge(Json& gltf) { keepJudged(gltf, rules()); }

Result<void> checkGltfExtensions(const Json& gltf, std::vector<std::string>& notes) {
    const auto understood = [](const std::string& name) {
        return std::find(kUnderstood.begin(), kUnderstood.end(), name) != kUnderstood.end();
    };
    for (const Json& name : gltf.value("extensionsRequired", Json::array()))
        if (!understood(name.get<std::string>()))
            return Error{fmt::format("/extensionsRequired names '{}', which is not supported",
                                     name.get<std::string>().substr(0, 80))};
    for (const Json& material : gltf.value("materials", Json::array()))
        for (const char* key : {"specularTexture", "specularColorFactor", "specularColorTexture"})
            if (material.contains(Json::json_pointer("/extensions/KHR_materials_specular") / key))
                notes.push_back(fmt::format("{} of KHR_materials_specular is ignored", key));
    for (const Json& name : gltf.value("extensionsUsed", Json::array()))
        if (!understood(name.get<std::string>()))
            notes.push_back(fmt::format("the extension {} is not supported and ignored",
                                        name.get<std::string>().substr(0, 80)));
    return {};
}

} // namespace tyndall
