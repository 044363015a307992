// Materials, textures, samplers, images.
#include <fmt/format.h>

#include "scene/gltf_model.h"
#include "scene/image_decode.h"

namespace tyndall {
namespace {

constexpr uint64_t kMaxPixels = uint64_t(1) << 30; // of all images of a file: 4 GiB decoded

} // namespace

Result<void> GltfModel::readMaterials() {
    for (const Material& written : file_.document().materials) {
        const std::string pointer = fmt::format("/materials/{}", scene_.materials.size());
        Material material = written;
        const std::pair<const char*, TextureRef*> references[] = {
            {"baseColorTexture", &material.baseColorTexture},
            {"metallicRoughnessTexture", &material.metallicRoughnessTexture},
            {"normalTexture", &material.normalTexture},
            {"occlusionTexture", &material.occlusionTexture},
            {"emissiveTexture", &material.emissiveTexture}};
        for (const auto& [key, reference] : references)
            if (auto read = readTextureRef(*reference, pointer + "/" + key); !read) return read;
        scene_.materials.push_back(std::move(material));
    }
    return {};
}

/// From the file's index of a texture to the scene's.
Result<void> GltfModel::readTextureRef(TextureRef& reference, const std::string& pointer) {
    if (reference.texture == kNone) {
        reference = {}; // without a texture there is nothing to place
        return {};
    }
    auto texture = readTexture(size_t(reference.texture));
    if (!texture) return texture.error();
    reference.texture = *texture;
    if (reference.uvSet < kMaxUvSets) return {};
    file_.note(
        fmt::format("{} uses TEXCOORD_{}, but only {} sets are read; the texture is left out",
                    pointer, reference.uvSet, kMaxUvSets));
    reference = {};
    return {};
}

/// kNone where the texture has no picture that can be read.
Result<int> GltfModel::readTexture(size_t index) {
    if (const auto found = textures_.find(index); found != textures_.end()) return found->second;
    const gltf::Texture& written = file_.document().textures[index];
    if (written.image == kNone) {
        file_.note(fmt::format("/textures/{} has no picture of a kind that is read; it is left out",
                               index));
        return textures_[index] = kNone;
    }
    auto image = readImage(size_t(written.image));
    if (!image) return image.error();
    if (*image == kNone) return textures_[index] = kNone;
    Texture texture;
    texture.image = *image;
    if (written.sampler != kNone)
        texture.sampler = file_.document().samplers[size_t(written.sampler)];
    scene_.textures.push_back(texture);
    return textures_[index] = int(scene_.textures.size() - 1);
}

/// kNone, with a note, where the picture is missing or damaged: the model is worth showing without it.
Result<int> GltfModel::readImage(size_t index) {
    if (const auto found = images_.find(index); found != images_.end()) return found->second;
    const gltf::Image& written = file_.document().images[index];
    const std::string pointer = fmt::format("/images/{}", index);
    if (auto goOn = file_.progress(0.2f, written.uri.value_or(pointer).substr(0, 80)); !goOn)
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
    image->name = written.name;
    if (image->name.empty() && written.uri && !written.uri->starts_with("data:"))
        image->name = *written.uri;
    scene_.images.push_back(std::move(*image));
    return images_[index] = int(scene_.images.size() - 1);
}

} // namespace tyndall
