#include "renderer/environment_map.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/check.h"
#include "gl/context.h"
#include "gl/sampler.h"
#include "gl/texture.h"

namespace tyndall {
namespace {

bool usable(const std::shared_ptr<const Image>& image) {
    return image && image->width > 0 && image->height > 0 && image->channels > 0;
}

Image finestLevel(const Environment& environment) {
    if (!usable(environment.image)) {
        Image constant(1, 1, 3);
        for (int c = 0; c < 3; ++c) constant.pixels[size_t(c)] = environment.radiance[c];
        return constant;
    }
    const Image& source = *environment.image;
    Image level(source.width, source.height, 3);
    for (int y = 0; y < level.height; ++y)
        for (int x = 0; x < level.width; ++x)
            for (int c = 0; c < 3; ++c)
                level.at(x, y)[c] =
                    source.at(x, y)[source.channels >= 3 ? c : 0] * environment.intensity;
    return level;
}

/// A pixel that is broken in one channel is black in all.
bool scrub(Image& level) {
    bool black = true;
    for (size_t i = 0; i + 2 < level.pixels.size(); i += 3) {
        float* p = &level.pixels[i];
        const bool broken = !(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])) ||
                            std::min({p[0], p[1], p[2]}) < 0;
        if (broken) p[0] = p[1] = p[2] = 0;
        black = black && p[0] == 0 && p[1] == 0 && p[2] == 0;
    }
    return black;
}

/// Half the size (rounded down, at least 1); means weighted by solid angle, every texel of `level` counted in one texel of the result.
Image halved(const Image& level) {
    Image next(std::max(1, level.width / 2), std::max(1, level.height / 2), 3);
    for (int y = 0; y < next.height; ++y) {
        const int y0 = y * level.height / next.height, y1 = (y + 1) * level.height / next.height;
        for (int x = 0; x < next.width; ++x) {
            const int x0 = x * level.width / next.width, x1 = (x + 1) * level.width / next.width;
            dvec3 sum(0);
            double weights = 0;
            for (int j = y0; j < y1; ++j) {
                const double weight =
                    std::cos(kPi * j / level.height) - std::cos(kPi * (j + 1) / level.height);
                for (int i = x0; i < x1; ++i) {
                    sum += weight * dvec3(double(level.at(i, j)[0]), double(level.at(i, j)[1]),
                                          double(level.at(i, j)[2]));
                    weights += weight;
                }
            }
            for (int c = 0; c < 3; ++c) next.at(x, y)[c] = float(sum[c] / weights);
        }
    }
    return next;
}

gl::SamplerSpec mapSampler() {
    gl::SamplerSpec spec;
    spec.wrapS = GL_REPEAT;
    spec.wrapT = GL_CLAMP_TO_EDGE;
    return spec;
}

} // namespace

EnvironmentLevels makeEnvironmentLevels(const Environment& environment) {
    EnvironmentLevels result;
    result.levels.push_back(finestLevel(environment));
    result.black = scrub(result.levels.front());
    while (result.levels.back().width > 1 || result.levels.back().height > 1)
        result.levels.push_back(halved(result.levels.back()));
    return result;
}

EnvironmentMap::~EnvironmentMap() {
    if (map_.id) executor_.release(map_);
}

Result<void> EnvironmentMap::update(const Scene& scene) {
    if (scene_ == &scene && seen_ == scene.versions.environment) return {};
    scene_ = nullptr; // until it has succeeded
    if (map_.id) executor_.release(map_);
    map_ = {};
    black_ = true;
    const Environment& environment = scene.environment;
    const int limit = gl::currentCapabilities().limits.textureSize;
    if (usable(environment.image) &&
        (environment.image->width > limit || environment.image->height > limit))
        return Error{fmt::format(
            "environment '{}' is {}x{} pixels; this driver takes textures up to {} pixels a side",
            environment.file, environment.image->width, environment.image->height, limit)};
    const EnvironmentLevels made = makeEnvironmentLevels(environment);
    if (!made.black) {
        const Image& finest = made.levels.front();
        gl::TextureSpec spec;
        spec.internalFormat = GL_RGBA32F;
        spec.width = finest.width;
        spec.height = finest.height;
        spec.mips = int(made.levels.size());
        Result<gl::Texture> texture = gl::Texture::create("environment.map", spec);
        if (!texture) return texture.error();
        for (int mip = 0; mip < spec.mips; ++mip) {
            const Image& level = made.levels[size_t(mip)];
            std::vector<float> texels(size_t(level.width) * size_t(level.height) * 4, 1.0f);
            for (size_t i = 0; i < texels.size() / 4; ++i)
                std::copy_n(&level.pixels[3 * i], 3, &texels[4 * i]);
            texture->write(texture->mipRegion(mip), texels.data(), texels.size() * sizeof(float));
        }
        map_ = executor_.registerTexture("environment.map", std::move(*texture), mapSampler());
        const double rotation = double(environment.rotation);
        data_.rotation = vec4(float(std::cos(rotation)), float(std::sin(rotation)),
                              float(spec.width), float(spec.height));
        data_.levels = vec4(float(spec.mips - 1), 0, 0, 0);
    }
    black_ = made.black;
    scene_ = &scene;
    seen_ = scene.versions.environment;
    return {};
}

EnvironmentResources EnvironmentMap::resources() const {
    CHECK(!black_, "a black environment has no map: leave it out");
    return {map_, data_};
}

} // namespace tyndall
