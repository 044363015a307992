#include "renderer/texture_upload.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/log.h"
#include "gl/context.h"
#include "gl/texture.h"
#include "renderer/texture_scale.h"

namespace tyndall {
namespace {

constexpr int kLeastSide = 256; // where not even this has room, nothing has

GLenum wrapMode(Wrap wrap) {
    switch (wrap) {
    case Wrap::ClampToEdge: return GL_CLAMP_TO_EDGE;
    case Wrap::MirroredRepeat: return GL_MIRRORED_REPEAT;
    case Wrap::Repeat: break;
    }
    return GL_REPEAT;
}

GLenum minifyMode(const Sampler& sampler) {
    const bool linear = sampler.minify == Filter::Linear;
    switch (sampler.mip) {
    case MipFilter::None: return linear ? GL_LINEAR : GL_NEAREST;
    case MipFilter::Nearest: return linear ? GL_LINEAR_MIPMAP_NEAREST : GL_NEAREST_MIPMAP_NEAREST;
    case MipFilter::Linear: break;
    }
    return linear ? GL_LINEAR_MIPMAP_LINEAR : GL_NEAREST_MIPMAP_LINEAR;
}

/// One channel, 0..1, halved with a box; odd edges fold their last row or column into the one before.
struct AlphaLevel {
    int width, height;
    std::vector<float> values;
};

AlphaLevel halved(const AlphaLevel& level) {
    AlphaLevel next{std::max(1, level.width / 2), std::max(1, level.height / 2), {}};
    next.values.resize(size_t(next.width) * size_t(next.height));
    for (int y = 0; y < next.height; ++y) {
        const int y0 = y * level.height / next.height,
                  y1 = std::max(y0 + 1, (y + 1) * level.height / next.height);
        for (int x = 0; x < next.width; ++x) {
            const int x0 = x * level.width / next.width,
                      x1 = std::max(x0 + 1, (x + 1) * level.width / next.width);
            float sum = 0;
            for (int j = y0; j < y1; ++j)
                for (int i = x0; i < x1; ++i)
                    sum += level.values[size_t(j) * size_t(level.width) + size_t(i)];
            next.values[size_t(y) * size_t(next.width) + size_t(x)] =
                sum / float((y1 - y0) * (x1 - x0));
        }
    }
    return next;
}

/// The value above or at which `covered` of the values lie; half-way to the next one below, so that rounding cannot matter.
float cutoffForCoverage(std::vector<float> values, double covered) {
    const size_t count = values.size();
    const size_t kept = std::min(count, size_t(std::lround(covered * double(count))));
    if (kept == 0) return std::nextafter(*std::max_element(values.begin(), values.end()), 2.0f);
    if (kept == count) return 0.0f;
    const auto next = values.begin() + ptrdiff_t(kept);
    std::nth_element(values.begin(), next, values.end(), std::greater<>());
    return 0.5f * (*std::min_element(values.begin(), next) + *next);
}

} // namespace

gl::SamplerSpec samplerSpec(const Sampler& sampler, float anisotropy) {
    gl::SamplerSpec spec;
    spec.minFilter = minifyMode(sampler);
    spec.magFilter = sampler.magnify == Filter::Linear ? GL_LINEAR : GL_NEAREST;
    spec.wrapS = wrapMode(sampler.wrapU);
    spec.wrapT = wrapMode(sampler.wrapV);
    // Anisotropy blends texels, which would undo what NEAREST asks for.
    const bool blends = sampler.minify == Filter::Linear && sampler.mip == MipFilter::Linear;
    spec.anisotropy = blends ? anisotropy : 1.0f;
    return spec;
}

std::array<float, 16> alphaCutoffs(const ImageData& image, float cutoff) {
    std::array<float, 16> cutoffs;
    cutoffs.fill(cutoff);
    AlphaLevel level{image.width, image.height, {}};
    level.values.resize(size_t(image.width) * size_t(image.height));
    size_t above = 0;
    for (size_t i = 0; i < level.values.size(); ++i) {
        level.values[i] = float(image.rgba[4 * i + 3]) / 255.0f;
        above += level.values[i] >= cutoff;
    }
    // All or nothing stays so in every level.
    if (level.values.empty() || above == 0 || above == level.values.size()) return cutoffs;
    const double covered = double(above) / double(level.values.size());
    for (size_t mip = 1; mip < cutoffs.size(); ++mip) {
        if (level.width == 1 && level.height == 1) {
            cutoffs[mip] = cutoffs[mip - 1];
            continue;
        }
        level = halved(level);
        // With a handful of texels a level cannot have the right coverage; the last level that can speaks for them.
        cutoffs[mip] =
            level.values.size() >= 16 ? cutoffForCoverage(level.values, covered) : cutoffs[mip - 1];
    }
    return cutoffs;
}

TextureUpload::TextureUpload(fg::Executor& executor) : executor_(executor) {
    gl::Texture texture("white", {GL_TEXTURE_2D, GL_RGBA8, 1, 1, 1, 1});
    const uint8_t white[4] = {255, 255, 255, 255};
    texture.write(white, sizeof white);
    white_ = executor_.registerTexture("white", std::move(texture), gl::nearestClamp());
}

TextureUpload::~TextureUpload() {
    forget();
    executor_.release(white_);
}

void TextureUpload::forget() {
    for (const auto& [key, texture] : textures_) executor_.release(texture);
    textures_.clear();
}

Result<fg::StaticTexture> TextureUpload::uploadImage(const ImageData& image, ColorSpace space,
                                                     const gl::SamplerSpec& sampler) {
    const std::string name =
        fmt::format("texture {}{}", image.name, space == ColorSpace::Srgb ? " (sRGB)" : "");
    gl::TextureSpec spec;
    spec.internalFormat = space == ColorSpace::Srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8;
    spec.width = image.width;
    spec.height = image.height;
    const double fits =
        double(gl::currentCapabilities().limits.textureSize) / std::max(image.width, image.height);
    if (fits < 1) {
        spec.width = std::max(1, int(std::lround(image.width * fits)));
        spec.height = std::max(1, int(std::lround(image.height * fits)));
    }
    spec.mips = gl::fullMipCount(spec.width, spec.height);
    Result<gl::Texture> texture = gl::Texture::create(name, spec);
    // A driver may take the sides, but not that many bytes.
    while (!texture && std::max(spec.width, spec.height) > kLeastSide) {
        spec.width = std::max(1, spec.width / 2);
        spec.height = std::max(1, spec.height / 2);
        spec.mips = gl::fullMipCount(spec.width, spec.height);
        texture = gl::Texture::create(name, spec);
    }
    if (!texture) return texture.error();
    if (spec.width == image.width && spec.height == image.height) {
        texture->write(image.rgba.data(), image.rgba.size());
    } else {
        log::warningOnce(name, fmt::format("image '{}' of {}x{} pixels is scaled down to {}x{}, "
                                           "since this driver has no room for more",
                                           image.name, image.width, image.height, spec.width,
                                           spec.height));
        const ImageData smaller = scaledDown(image, spec.width, spec.height, space);
        texture->write(smaller.rgba.data(), smaller.rgba.size());
    }
    texture->generateMips();
    return executor_.registerTexture(name, std::move(*texture), sampler);
}

Result<fg::StaticTexture> TextureUpload::obtain(const Scene& scene, int index, ColorSpace space) {
    if (index == kNone || size_t(index) >= scene.textures.size()) return white_;
    const Texture& texture = scene.textures[size_t(index)];
    if (texture.image == kNone || size_t(texture.image) >= scene.images.size()) return white_;
    const ImageData& image = scene.images[size_t(texture.image)];
    if (image.rgba.empty()) return white_;
    const Sampler& s = texture.sampler;
    const SamplerKey samplerKey{int(s.magnify), int(s.minify), int(s.mip), int(s.wrapU),
                                int(s.wrapV)};
    const Key key{texture.image, space, samplerKey};
    if (const auto found = textures_.find(key); found != textures_.end()) return found->second;

    const gl::SamplerSpec sampler = samplerSpec(s, anisotropy_);
    // The same texels with another sampler are a view of the first.
    for (const auto& [other, uploaded] : textures_) {
        if (std::get<0>(other) != texture.image || std::get<1>(other) != space) continue;
        const gl::Texture& first = executor_.texture(uploaded);
        gl::Texture view = first.view(image.name, GL_TEXTURE_2D, first.spec().internalFormat, 0,
                                      first.spec().mips, 0, 1);
        return textures_[key] = executor_.registerTexture(image.name, std::move(view), sampler);
    }
    Result<fg::StaticTexture> uploaded = uploadImage(image, space, sampler);
    if (uploaded) textures_[key] = *uploaded;
    return uploaded;
}

} // namespace tyndall
