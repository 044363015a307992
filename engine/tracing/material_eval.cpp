#include "tracing/material_eval.h"

#include <algorithm>
#include <cmath>

namespace tyndall::tracing {
namespace {

int wrapped(int64_t i, int size, Wrap wrap) {
    switch (wrap) {
    case Wrap::ClampToEdge: return int(std::clamp<int64_t>(i, 0, size - 1));
    case Wrap::MirroredRepeat: {
        const int64_t period = 2 * int64_t(size), m = ((i % period) + period) % period;
        return int(m < size ? m : period - 1 - m);
    }
    case Wrap::Repeat: break;
    }
    return int(((i % size) + size) % size);
}

bool usable(const TextureRef& ref, const Scene& scene) {
    return ref.texture != kNone && scene.textures[size_t(ref.texture)].image != kNone &&
           !scene.images[size_t(scene.textures[size_t(ref.texture)].image)].rgba.empty();
}

} // namespace

MaterialReader::MaterialReader(const Scene& scene) : scene_(scene) {
    for (size_t i = 0; i < 256; ++i) {
        const double c = double(i) / 255;
        linear_[i] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    }
}

dvec4 MaterialReader::sample(const TextureRef& ref, const VertexValues& vertex, bool srgb) const {
    const Texture& texture = scene_.textures[size_t(ref.texture)];
    const ImageData& image = scene_.images[size_t(texture.image)];
    // KHR_texture_transform: offset · rotation · scale, the rotation clockwise as its specification prints it.
    const dvec2 uv = vertex.uvs[size_t(ref.uvSet)] * dvec2(ref.scale);
    const double c = std::cos(double(ref.rotation)), s = std::sin(double(ref.rotation));
    const dvec2 at = dvec2(c * uv.x + s * uv.y, -s * uv.x + c * uv.y) + dvec2(ref.offset);
    const auto texel = [&](int64_t x, int64_t y) {
        const int column = wrapped(x, image.width, texture.sampler.wrapU),
                  row = wrapped(y, image.height, texture.sampler.wrapV);
        const uint8_t* p = &image.rgba[4 * (size_t(row) * size_t(image.width) + size_t(column))];
        if (srgb) return dvec4(linear_[p[0]], linear_[p[1]], linear_[p[2]], p[3] / 255.0);
        return dvec4(p[0], p[1], p[2], p[3]) / 255.0;
    };
    constexpr double kFarthest = 1e9; // coordinates beyond have no texel
    const double x = std::clamp(at.x * image.width, -kFarthest, kFarthest),
                 y = std::clamp(at.y * image.height, -kFarthest, kFarthest);
    if (std::isnan(x) || std::isnan(y)) return texel(0, 0);
    if (texture.sampler.magnify == Filter::Nearest)
        return texel(int64_t(std::floor(x)), int64_t(std::floor(y)));
    const double x0 = std::floor(x - 0.5), y0 = std::floor(y - 0.5);
    const double fx = x - 0.5 - x0, fy = y - 0.5 - y0;
    const int64_t i = int64_t(x0), j = int64_t(y0);
    return (1 - fy) * ((1 - fx) * texel(i, j) + fx * texel(i + 1, j)) +
           fy * ((1 - fx) * texel(i, j + 1) + fx * texel(i + 1, j + 1));
}

double MaterialReader::coverage(const Material& material, const VertexValues& vertex) const {
    if (material.alphaMode == AlphaMode::Opaque) return 1;
    double alpha = double(material.baseColor.w) * vertex.color.w;
    if (usable(material.baseColorTexture, scene_))
        alpha *= sample(material.baseColorTexture, vertex, true).w;
    if (material.alphaMode == AlphaMode::Mask) return alpha < double(material.alphaCutoff) ? 0 : 1;
    return std::clamp(alpha, 0.0, 1.0);
}

MaterialValues MaterialReader::evaluate(const Material& material,
                                        const VertexValues& vertex) const {
    const auto unit = [](double v) { return std::clamp(v, 0.0, 1.0); };
    MaterialValues values;
    dvec4 base = dvec4(material.baseColor) * vertex.color;
    if (usable(material.baseColorTexture, scene_))
        base *= sample(material.baseColorTexture, vertex, true);
    values.baseColor = material.unlit ? dvec3(base) : glm::clamp(dvec3(base), dvec3(0), dvec3(1));
    values.metallic = double(material.metallic);
    values.roughness = double(material.roughness);
    if (usable(material.metallicRoughnessTexture, scene_)) {
        const dvec4 texel = sample(material.metallicRoughnessTexture, vertex, false);
        values.roughness *= texel.y;
        values.metallic *= texel.z;
    }
    values.metallic = unit(values.metallic);
    values.roughness = unit(values.roughness);
    values.specular = unit(double(material.specular));
    values.emissive = dvec3(material.emissive);
    if (usable(material.emissiveTexture, scene_) && values.emissive != dvec3(0))
        values.emissive *= dvec3(sample(material.emissiveTexture, vertex, true));
    if (usable(material.normalTexture, scene_)) {
        values.normalTexel = dvec3(sample(material.normalTexture, vertex, false)) * 2.0 - 1.0;
        values.normalTexel.x *= double(material.normalScale);
        values.normalTexel.y *= double(material.normalScale);
        values.hasNormalTexel = true;
    }
    return values;
}

double MaterialReader::brightestEmission(const Material& material) const {
    const dvec3 factor(material.emissive);
    if (!usable(material.emissiveTexture, scene_)) return luminanceOf(factor);
    const ImageData& image =
        scene_.images[size_t(scene_.textures[size_t(material.emissiveTexture.texture)].image)];
    double brightest = 0;
    for (size_t i = 0; i + 3 < image.rgba.size(); i += 4)
        brightest = std::max(brightest, luminanceOf(factor * dvec3(linear_[image.rgba[i]],
                                                                   linear_[image.rgba[i + 1]],
                                                                   linear_[image.rgba[i + 2]])));
    return brightest;
}

} // namespace tyndall::tracing
