// Materials, textures, samplers, images.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scene/gltf_model.h"
#include "scene/image_decode.h"
#include "scene/json_convert.h"

namespace tyndall {
namespace {

constexpr uint64_t kMaxPixels = uint64_t(1) << 30; // of all images of a file: 4 GiB decoded
constexpr std::string_view kAlphaModes[] = {"OPAQUE", "MASK", "BLEND"};

const Json& extensionOf(const Json& json, const char* name) {
    static const Json none = nullptr;
    const auto extensions = json.find("extensions");
    if (extensions == json.end()) return none;
    const auto found = extensions->find(name);
    return found == extensions->end() ? none : *found;
}

Wrap wrapOf(int code) {
    return code == 33071 ? Wrap::ClampToEdge : code == 33648 ? Wrap::MirroredRepeat : Wrap::Repeat;
}

Sampler readSampler(const Json& json) {
    Sampler sampler;
    sampler.magnify = json.value("magFilter", 9729) == 9728 ? Filter::Nearest : Filter::Linear;
    const int minify = json.value("minFilter", 9987);
    sampler.minify =
        minify == 9728 || minify == 9984 || minify == 9986 ? Filter::Nearest : Filter::Linear;
    sampler.mip = minify < 9984   ? MipFilter::None
                  : minify < 9986 ? MipFilter::Nearest
                                  : MipFilter::Linear;
    sampler.wrapU = wrapOf(json.value("wrapS", 10497));
    sampler.wrapV = wrapOf(json.value("wrapT", 10497));
    return sampler;
}

vec2 pairOr(const Json& json, const char* key, const vec2& otherwise) {
    const auto found = json.find(key);
    return found == json.end() ? otherwise
                               : vec2((*found)[0].get<float>(), (*found)[1].get<float>());
}

} // namespace

Result<void> GltfModel::readMaterials() {
    const Json& materials = file_.array("materials");
    for (size_t i = 0; i < materials.size(); ++i) {
        const Json& json = materials[i];
        const std::string pointer = fmt::format("/materials/{}", i);
        const Json pbr = json.value("pbrMetallicRoughness", Json::object());
        Material material;
        material.name = json.value("name", std::string());
        material.metallic = floatOr(pbr, "metallicFactor", 1.0f);
        material.roughness = floatOr(pbr, "roughnessFactor", 1.0f);
        if (const auto color = pbr.find("baseColorFactor"); color != pbr.end())
            material.baseColor = vec4(vec3(toVector(*color)), (*color)[3].get<float>());
        const float strength =
            floatOr(extensionOf(json, "KHR_materials_emissive_strength"), "emissiveStrength", 1.0f);
        material.emissive =
            glm::min(colorOr(json, "emissiveFactor", vec3(0)) * strength, vec3(1e30f));
        const Json& specular = extensionOf(json, "KHR_materials_specular");
        material.specular = floatOr(specular, "specularFactor", 1.0f);
        for (const char* key : {"specularTexture", "specularColorFactor", "specularColorTexture"})
            if (specular.contains(key))
                file_.note(fmt::format("{} of KHR_materials_specular is ignored", key));
        material.alphaMode =
            AlphaMode(indexOf(kAlphaModes, json.value("alphaMode", std::string("OPAQUE"))));
        material.alphaCutoff = floatOr(json, "alphaCutoff", 0.5f);
        material.doubleSided = json.value("doubleSided", false);
        material.unlit = extensionOf(json, "KHR_materials_unlit").is_object();

        const auto read = [&](const Json& from, const char* key, TextureRef& to) -> Result<void> {
            const auto info = from.find(key);
            if (info == from.end()) return {};
            auto reference = readTextureRef(*info, pointer + "/" + key);
            if (!reference) return reference.error();
            to = *reference;
            return {};
        };
        if (auto done = read(pbr, "baseColorTexture", material.baseColorTexture); !done)
            return done;
        if (auto done = read(pbr, "metallicRoughnessTexture", material.metallicRoughnessTexture);
            !done)
            return done;
        if (auto done = read(json, "normalTexture", material.normalTexture); !done) return done;
        if (auto done = read(json, "occlusionTexture", material.occlusionTexture); !done)
            return done;
        if (auto done = read(json, "emissiveTexture", material.emissiveTexture); !done) return done;
        material.normalScale = floatOr(json.value("normalTexture", Json::object()), "scale", 1.0f);
        material.occlusionStrength =
            floatOr(json.value("occlusionTexture", Json::object()), "strength", 1.0f);
        scene_.materials.push_back(std::move(material));
    }
    return {};
}

Result<TextureRef> GltfModel::readTextureRef(const Json& info, const std::string& pointer) {
    TextureRef reference;
    auto texture = readTexture(info.at("index").get<size_t>());
    if (!texture) return texture.error();
    reference.texture = *texture;
    const Json& transform = extensionOf(info, "KHR_texture_transform");
    size_t set = info.value("texCoord", size_t(0));
    if (transform.is_object()) {
        set = transform.value("texCoord", set);
        reference.offset = pairOr(transform, "offset", reference.offset);
        reference.scale = pairOr(transform, "scale", reference.scale);
        reference.rotation = floatOr(transform, "rotation", 0.0f);
    }
    if (set >= size_t(kMaxUvSets)) {
        file_.note(
            fmt::format("{} uses TEXCOORD_{}, but only {} sets are read; the texture is left out",
                        pointer, set, kMaxUvSets));
        return TextureRef{};
    }
    reference.uvSet = int(set);
    return reference;
}

/// kNone where the texture has no picture that can be read.
Result<int> GltfModel::readTexture(size_t index) {
    if (const auto found = textures_.find(index); found != textures_.end()) return found->second;
    const Json& json = file_.array("textures")[index];
    const Json& webp = extensionOf(json, "EXT_texture_webp");
    const auto source = webp.is_object() ? webp.find("source") : json.find("source");
    if (!webp.is_object() && source == json.end()) {
        file_.note(fmt::format("/textures/{} has no picture of a kind that is read; it is left out",
                               index));
        return textures_[index] = kNone;
    }
    auto image = readImage(source->get<size_t>());
    if (!image) return image.error();
    if (*image == kNone) return textures_[index] = kNone;
    Texture texture;
    texture.image = *image;
    if (const auto sampler = json.find("sampler"); sampler != json.end())
        texture.sampler = readSampler(file_.array("samplers")[sampler->get<size_t>()]);
    scene_.textures.push_back(texture);
    return textures_[index] = int(scene_.textures.size() - 1);
}

/// kNone, with a note, where the picture is missing or damaged: the model is worth showing without it.
Result<int> GltfModel::readImage(size_t index) {
    if (const auto found = images_.find(index); found != images_.end()) return found->second;
    const Json& json = file_.array("images")[index];
    const std::string pointer = fmt::format("/images/{}", index);
    if (auto goOn = file_.progress(0.2f, json.value("uri", pointer).substr(0, 80)); !goOn)
        return goOn.error();
    const auto bytes = file_.imageBytes(index);
    auto image =
        bytes ? decodeImage({reinterpret_cast<const uint8_t*>((*bytes)->data()), (*bytes)->size()})
              : Result<ImageData>(bytes.error());
    if (!image) {
        file_.note(fmt::format("{} is left out: {}", pointer, image.message()));
        return images_[index] = kNone;
    }
    pixels_ += uint64_t(image->width) * uint64_t(image->height);
    if (pixels_ > kMaxPixels)
        return file_.at(
            pointer,
            fmt::format(
                "brings the pictures of this file over {} million pixels, more than is read",
                kMaxPixels / 1000000));
    image->name = json.value("name", std::string());
    if (image->name.empty() && !json.value("uri", std::string("data:")).starts_with("data:"))
        image->name = json.at("uri").get<std::string>();
    scene_.images.push_back(std::move(*image));
    return images_[index] = int(scene_.images.size() - 1);
}

} // namespace tyndall
