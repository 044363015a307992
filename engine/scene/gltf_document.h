#pragma once
// What a glTF file says, in types of our own: everything but the bytes of its buffers and pictures. Private to the folder.
//
// tinygltf parses it; gltf_parse.cpp is the one source that knows tinygltf. All indices are in range, because the rules
// (gltf_rules.h) have been applied before. What the scene has a type for is in that type, with indices of the file.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "scene/json_parse.h"
#include "scene/scene.h"

namespace tyndall::gltf {

struct Buffer {
    std::optional<std::string> uri;
    uint64_t byteLength = 0;
};

/// EXT_meshopt_compression.
struct PackedView {
    size_t buffer = 0;
    uint64_t offset = 0, length = 0, stride = 0, count = 0;
    std::string mode, filter = "NONE";
};

struct BufferView {
    size_t buffer = 0;
    uint64_t offset = 0, length = 0;
    uint64_t stride = 0; // 0: tightly packed
    std::optional<PackedView> packed;
};

struct Sparse {
    uint64_t count = 0;
    size_t indexView = 0, valueView = 0;
    uint64_t indexOffset = 0, valueOffset = 0;
    int indexType = 0;
};

struct Accessor {
    int view = kNone; // kNone: zeros
    uint64_t offset = 0, count = 0;
    int componentType = 0;
    std::string_view type; // "SCALAR" to "MAT4"
    bool normalized = false;
    std::optional<Sparse> sparse;
};

/// Accessors by semantic ("POSITION").
using Attributes = std::map<std::string, int>;

/// KHR_draco_mesh_compression; `attributes` are Draco's own numbers.
struct Draco {
    size_t view = 0;
    Attributes attributes;
};

struct Primitive {
    Attributes attributes;
    std::vector<Attributes> targets;
    int indices = kNone, material = kNone, mode = 4;
    std::optional<Draco> draco;
};

struct Mesh {
    std::string name;
    std::vector<double> weights;
    std::vector<Primitive> primitives;
};

struct Node {
    std::string name;
    std::optional<dmat4> matrix;
    dvec3 translation{0}, scale{1};
    dvec4 rotation{0, 0, 0, 1}; // x, y, z, w, as written
    std::vector<int> children;
    std::vector<double> weights;
    int mesh = kNone, skin = kNone, camera = kNone, light = kNone;
    Attributes instances; // EXT_mesh_gpu_instancing
};

struct Skin {
    std::vector<int> joints;
    int inverseBind = kNone;
};

struct Texture {
    int image = kNone, sampler = kNone;
};

struct Image {
    std::string name;
    std::optional<std::string> uri;
    int view = kNone;
};

struct Document {
    std::vector<Buffer> buffers;
    std::vector<BufferView> views;
    std::vector<Accessor> accessors;
    std::vector<Mesh> meshes;
    std::vector<Node> nodes;
    std::vector<Skin> skins;
    std::vector<std::vector<int>> scenes; // their nodes
    int scene = kNone;                    // the default one
    std::vector<Material> materials;      // texture references hold indices of `textures`
    std::vector<Texture> textures;
    std::vector<Sampler> samplers;
    std::vector<Image> images;
    std::vector<Camera> cameras;
    std::vector<Light> lights; // KHR_lights_punctual
    std::vector<std::string> extensions; // used ones
    size_t animations = 0;
};

/// `gltf` must have passed the rules; it is used up. Error (without the file's name): what tinygltf says.
Result<Document> parse(Json gltf);

/// The payload of "data:…;base64,…". Errors (without the place): another encoding, a character that is not base64.
Result<std::string> dataOfUri(std::string_view uri);

} // namespace tyndall::gltf
