// The one source that knows tinygltf, which parses the model. It is handed the text of what the rules have judged, and
// neither files nor pictures: those go through readFile and decodeImage with their limits.
#include <algorithm>
#include <cmath>
#include <exception>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_FS
#include <tiny_gltf.h>

#include "core/check.h"
#include "scene/gltf_document.h"
#include "scene/gltf_rules.h"
#include "scene/gltf_workrounds.h"

namespace tyndall::gltf {
namespace {

using tinygltf::Value;

// Values of extensions. tinygltf leaves out members that are empty.

const Value& member(const Value& value, const char* key) {
    static const Value none;
    return value.IsObject() ? value.Get(key) : none;
}

const Value& extension(const tinygltf::ExtensionMap& extensions, const char* name) {
    static const Value none;
    const auto found = extensions.find(name);
    return found == extensions.end() ? none : found->second;
}

double numberOr(const Value& value, const char* key, double otherwise) {
    const Value& found = member(value, key);
    return found.IsNumber() ? found.GetNumberAsDouble() : otherwise;
}

vec2 pairOr(const Value& value, const char* key, const vec2& otherwise) {
    const Value& found = member(value, key);
    return found.ArrayLen() == 2 ? vec2(float(found.Get(0).GetNumberAsDouble()),
                                        float(found.Get(1).GetNumberAsDouble()))
                                 : otherwise;
}

Attributes attributesOf(const Value& value) {
    Attributes attributes;
    const Value& found = member(value, "attributes");
    for (const std::string& name : found.Keys())
        attributes[name] = found.Get(name).GetNumberAsInt();
    return attributes;
}

dvec3 vectorOr(const std::vector<double>& numbers, const dvec3& otherwise) {
    return numbers.size() == 3 ? dvec3(numbers[0], numbers[1], numbers[2]) : otherwise;
}

// From tinygltf's model to the document.

BufferView viewOf(const tinygltf::BufferView& from, uint64_t stride) {
    BufferView view{size_t(from.buffer), from.byteOffset, from.byteLength, stride, {}};
    if (const Value& meshopt = extension(from.extensions, "EXT_meshopt_compression");
        meshopt.IsObject()) {
        const auto number = [&](const char* key) { return uint64_t(numberOr(meshopt, key, 0)); };
        view.packed = PackedView{number("buffer"),
                                 number("byteOffset"),
                                 number("byteLength"),
                                 number("byteStride"),
                                 number("count"),
                                 {},
                                 "NONE"};
        view.packed->mode = member(meshopt, "mode").Get<std::string>();
        if (const Value& filter = member(meshopt, "filter"); filter.IsString())
            view.packed->filter = filter.Get<std::string>();
    }
    return view;
}

std::string_view typeName(int type) {
    switch (type) {
    case TINYGLTF_TYPE_SCALAR: return "SCALAR";
    case TINYGLTF_TYPE_VEC2: return "VEC2";
    case TINYGLTF_TYPE_VEC3: return "VEC3";
    case TINYGLTF_TYPE_VEC4: return "VEC4";
    case TINYGLTF_TYPE_MAT2: return "MAT2";
    case TINYGLTF_TYPE_MAT3: return "MAT3";
    case TINYGLTF_TYPE_MAT4: return "MAT4";
    default: CHECK(false, "accessor type " + std::to_string(type));
    }
}

Accessor accessorOf(const tinygltf::Accessor& from) {
    Accessor accessor{from.bufferView,     from.byteOffset, from.count, from.componentType,
                      typeName(from.type), from.normalized, {}};
    if (from.sparse.isSparse)
        accessor.sparse = Sparse{uint64_t(from.sparse.count),
                                 size_t(from.sparse.indices.bufferView),
                                 size_t(from.sparse.values.bufferView),
                                 uint64_t(from.sparse.indices.byteOffset),
                                 uint64_t(from.sparse.values.byteOffset),
                                 from.sparse.indices.componentType};
    return accessor;
}

Mesh meshOf(const tinygltf::Mesh& from, const std::vector<int>& indices) {
    Mesh mesh{from.name, from.weights, {}};
    for (size_t i = 0; i < from.primitives.size(); ++i) {
        const tinygltf::Primitive& primitive = from.primitives[i];
        mesh.primitives.push_back({primitive.attributes,
                                   primitive.targets,
                                   indices[i],
                                   primitive.material,
                                   primitive.mode,
                                   {}});
        if (const Value& draco = extension(primitive.extensions, "KHR_draco_mesh_compression");
            draco.IsObject())
            mesh.primitives.back().draco =
                Draco{size_t(numberOr(draco, "bufferView", 0)), attributesOf(draco)};
    }
    return mesh;
}

Node nodeOf(const tinygltf::Node& from) {
    Node node;
    node.name = from.name;
    if (from.matrix.size() == 16) {
        node.matrix.emplace();
        for (int i = 0; i < 16; ++i) (*node.matrix)[i / 4][i % 4] = from.matrix[size_t(i)];
    }
    node.translation = vectorOr(from.translation, node.translation);
    node.scale = vectorOr(from.scale, node.scale);
    if (const auto& r = from.rotation; r.size() == 4) node.rotation = {r[0], r[1], r[2], r[3]};
    node.children = from.children;
    node.weights = from.weights;
    node.mesh = from.mesh;
    node.skin = from.skin;
    node.camera = from.camera;
    node.light = int(numberOr(extension(from.extensions, "KHR_lights_punctual"), "light", kNone));
    node.instances = attributesOf(extension(from.extensions, "EXT_mesh_gpu_instancing"));
    return node;
}

template <typename Info> TextureRef referenceOf(const Info& from) {
    TextureRef reference;
    const Value& transform = extension(from.extensions, "KHR_texture_transform");
    reference.texture = from.index;
    reference.uvSet = int(numberOr(transform, "texCoord", from.texCoord));
    reference.offset = pairOr(transform, "offset", reference.offset);
    reference.scale = pairOr(transform, "scale", reference.scale);
    reference.rotation = float(numberOr(transform, "rotation", 0));
    return reference;
}

Material materialOf(const tinygltf::Material& from) {
    const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
    const Value& specular = extension(from.extensions, "KHR_materials_specular");
    const auto strength = float(numberOr(
        extension(from.extensions, "KHR_materials_emissive_strength"), "emissiveStrength", 1));
    Material material;
    material.name = from.name;
    for (int i = 0; i < 4; ++i) material.baseColor[i] = float(pbr.baseColorFactor[size_t(i)]);
    material.metallic = float(pbr.metallicFactor);
    material.roughness = float(pbr.roughnessFactor);
    material.specular = float(numberOr(specular, "specularFactor", 1));
    material.emissive =
        glm::min(vec3(vectorOr(from.emissiveFactor, dvec3(0))) * strength, vec3(1e30f));
    material.normalScale = float(from.normalTexture.scale);
    material.occlusionStrength = float(from.occlusionTexture.strength);
    material.alphaMode = from.alphaMode == "MASK"    ? AlphaMode::Mask
                         : from.alphaMode == "BLEND" ? AlphaMode::Blend
                                                     : AlphaMode::Opaque;
    material.alphaCutoff = float(from.alphaCutoff);
    material.doubleSided = from.doubleSided;
    material.unlit = extension(from.extensions, "KHR_materials_unlit").IsObject();
    material.baseColorTexture = referenceOf(pbr.baseColorTexture);
    material.metallicRoughnessTexture = referenceOf(pbr.metallicRoughnessTexture);
    material.normalTexture = referenceOf(from.normalTexture);
    material.occlusionTexture = referenceOf(from.occlusionTexture);
    material.emissiveTexture = referenceOf(from.emissiveTexture);
    return material;
}

Texture textureOf(const tinygltf::Texture& from) {
    const Value& webp = extension(from.extensions, "EXT_texture_webp");
    return {int(numberOr(webp, "source", from.source)), from.sampler};
}

Wrap wrapOf(int code) {
    return code == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? Wrap::ClampToEdge
           : code == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::MirroredRepeat
                                                           : Wrap::Repeat;
}

Sampler samplerOf(const tinygltf::Sampler& from) {
    Sampler sampler;
    if (from.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST) sampler.magnify = Filter::Nearest;
    switch (from.minFilter) { // left out: trilinear
    case TINYGLTF_TEXTURE_FILTER_NEAREST:
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST:
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR: sampler.minify = Filter::Nearest; break;
    default: break;
    }
    switch (from.minFilter) {
    case TINYGLTF_TEXTURE_FILTER_NEAREST:
    case TINYGLTF_TEXTURE_FILTER_LINEAR: sampler.mip = MipFilter::None; break;
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST:
    case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST: sampler.mip = MipFilter::Nearest; break;
    default: break;
    }
    sampler.wrapU = wrapOf(from.wrapS);
    sampler.wrapV = wrapOf(from.wrapT);
    return sampler;
}

Camera cameraOf(const tinygltf::Camera& from) {
    Camera camera;
    camera.name = from.name;
    if (from.type == "orthographic") {
        camera.type = CameraType::Orthographic;
        camera.ymag = std::abs(from.orthographic.ymag);
    } else {
        camera.yfov = from.perspective.yfov;
    }
    camera.znear = std::max(
        from.type == "orthographic" ? from.orthographic.znear : from.perspective.znear, 1e-9);
    return camera;
}

Light lightOf(const tinygltf::Light& from) {
    Light light;
    light.name = from.name;
    light.type = from.type == "directional" ? LightType::Directional
                 : from.type == "spot"      ? LightType::Spot
                                            : LightType::Point;
    light.color = vec3(vectorOr(from.color, dvec3(light.color)));
    light.intensity = float(from.intensity);
    if (light.type != LightType::Directional) light.range = float(from.range);
    if (light.type == LightType::Spot) {
        light.innerConeAngle = float(from.spot.innerConeAngle);
        light.outerConeAngle = std::max(float(from.spot.outerConeAngle), 1e-4f);
    }
    return light;
}

Document documentOf(const tinygltf::Model& model, Withheld withheld) {
    Document document;
    document.buffers = std::move(withheld.buffers);
    document.images = std::move(withheld.images);
    for (size_t i = 0; i < model.bufferViews.size(); ++i)
        document.views.push_back(viewOf(model.bufferViews[i], withheld.strides[i]));
    for (const auto& from : model.accessors) document.accessors.push_back(accessorOf(from));
    for (size_t i = 0; i < model.meshes.size(); ++i)
        document.meshes.push_back(meshOf(model.meshes[i], withheld.indices[i]));
    for (const auto& from : model.nodes) document.nodes.push_back(nodeOf(from));
    for (const auto& from : model.skins)
        document.skins.push_back({from.joints, from.inverseBindMatrices});
    for (const auto& from : model.scenes) document.scenes.push_back(from.nodes);
    document.scene = model.defaultScene;
    for (const auto& from : model.materials) document.materials.push_back(materialOf(from));
    for (const auto& from : model.textures) document.textures.push_back(textureOf(from));
    for (const auto& from : model.samplers) document.samplers.push_back(samplerOf(from));
    for (const auto& from : model.cameras) document.cameras.push_back(cameraOf(from));
    for (const auto& from : model.lights) document.lights.push_back(lightOf(from));
    document.extensions = model.extensionsUsed;
    document.animations = model.animations.size();
    return document;
}

/// tinygltf's messages are lines; an error is a sentence.
std::string oneLine(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    while (text.ends_with(' ')) text.pop_back();
    return text.substr(0, 500);
}

} // namespace

Result<Document> parse(Json gltf) {
    keepWhatRulesJudge(gltf);
    Withheld withheld = withhold(gltf);
    const std::string text = gltf.dump();
    gltf.clear();
    if (text.size() > std::numeric_limits<unsigned>::max())
        return Error{fmt::format("{} bytes of JSON are more than is read", text.size())};
    tinygltf::Model model;
    std::string wrong, unused;
    try {
        if (tinygltf::TinyGLTF().LoadASCIIFromString(&model, &wrong, &unused, text.data(),
                                                     unsigned(text.size()), ""))
            return documentOf(model, std::move(withheld));
    } catch (const std::exception& exception) { // nlohmann's, inside tinygltf
        wrong = exception.what();
    }
    return Error{"tinygltf cannot read the model: " + oneLine(wrong)};
}

Result<std::string> dataOfUri(std::string_view uri) {
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const size_t comma = uri.find(',');
    if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64"))
        return Error{"is a data URI that is not base64"};
    std::string_view text = uri.substr(comma + 1);
    while (text.ends_with('=')) text.remove_suffix(1);
    // tinygltf stops at such a character and keeps what came before.
    if (text.find_first_not_of(kDigits) != std::string_view::npos)
        return Error{"is a data URI with a character that is not base64"};
    // Less than one byte: tinygltf calls that a failure.
    if (text.size() < 2) return std::string();
    // tinygltf knows seven media types and refuses all others (image/webp); which it is does not matter here.
    std::string known = "data:application/octet-stream;base64,", mediaType;
    known += text;
    std::vector<unsigned char> bytes;
    CHECK(tinygltf::DecodeDataURI(&bytes, mediaType, known, 0, false),
          "tinygltf decodes base64 that has been looked at");
    return std::string(bytes.begin(), bytes.end());
}

} // namespace tyndall::gltf
