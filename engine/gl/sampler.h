#pragma once
// Sampler objects, made once per kind.

#include <map>
#include <string>
#include <tuple>

#include "gl/object.h"

namespace tyndall::gl {

/// How a texture unit reads: GL's enums and their meanings.
struct SamplerSpec {
    GLenum minFilter = GL_LINEAR_MIPMAP_LINEAR;
    GLenum magFilter = GL_LINEAR;
    GLenum wrapS = GL_REPEAT, wrapT = GL_REPEAT, wrapR = GL_CLAMP_TO_EDGE;
    float anisotropy =
        1.0f; // 1: none; more is clamped to what the driver has, and ignored where it has none
    GLenum compare = GL_NONE; // GL_NONE, or the function of a depth comparison (GL_GEQUAL …)
    float border[4] = {0, 0, 0, 0}; // for GL_CLAMP_TO_BORDER

    [[nodiscard]] auto key() const {
        return std::tuple(minFilter, magFilter, wrapS, wrapT, wrapR, anisotropy, compare, border[0],
                          border[1], border[2], border[3]);
    }
};

/// Nearest texel, clamped to the edge.
SamplerSpec nearestClamp();
/// Bilinear (trilinear in 3D) on mip 0, clamped to the edge.
SamplerSpec linearClamp();

/// Owns one sampler per spec. Empty when moved from.
class SamplerCache {
public:
    SamplerCache() = default;
    SamplerCache(SamplerCache&&) = default;
    SamplerCache& operator=(SamplerCache&&) = default;

    /// The GL name of a sampler for `spec`; made on first use, kept as long as the cache.
    GLuint get(const SamplerSpec& spec);
    [[nodiscard]] size_t size() const { return samplers_.size(); }

private:
    std::map<decltype(SamplerSpec{}.key()), Object> samplers_;
};

} // namespace tyndall::gl
