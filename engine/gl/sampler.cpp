#include "gl/sampler.h"

#include <fmt/format.h>

#include <algorithm>

#include "gl/context.h"

namespace tyndall::gl {

SamplerSpec nearestClamp() {
    SamplerSpec spec;
    spec.minFilter = spec.magFilter = GL_NEAREST;
    spec.wrapS = spec.wrapT = spec.wrapR = GL_CLAMP_TO_EDGE;
    return spec;
}

SamplerSpec linearClamp() {
    SamplerSpec spec = nearestClamp();
    spec.minFilter = spec.magFilter = GL_LINEAR;
    return spec;
}

GLuint SamplerCache::get(const SamplerSpec& spec) {
    Object& sampler = samplers_[spec.key()];
    if (sampler) return sampler.id();
    GLuint id = 0;
    glCreateSamplers(1, &id);
    sampler = Object(ObjectKind::Sampler, id);
    sampler.label(fmt::format("sampler {}", samplers_.size()));
    glSamplerParameteri(id, GL_TEXTURE_MIN_FILTER, GLint(spec.minFilter));
    glSamplerParameteri(id, GL_TEXTURE_MAG_FILTER, GLint(spec.magFilter));
    glSamplerParameteri(id, GL_TEXTURE_WRAP_S, GLint(spec.wrapS));
    glSamplerParameteri(id, GL_TEXTURE_WRAP_T, GLint(spec.wrapT));
    glSamplerParameteri(id, GL_TEXTURE_WRAP_R, GLint(spec.wrapR));
    glSamplerParameterfv(id, GL_TEXTURE_BORDER_COLOR, spec.border);
    if (spec.compare != GL_NONE) {
        glSamplerParameteri(id, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
        glSamplerParameteri(id, GL_TEXTURE_COMPARE_FUNC, GLint(spec.compare));
    }
    const Capabilities& capabilities = currentCapabilities();
    if (spec.anisotropy > 1.0f && capabilities.has("GL_EXT_texture_filter_anisotropic") &&
        !capabilities.needs(Workaround::NoAnisotropy))
        glSamplerParameterf(id, GL_TEXTURE_MAX_ANISOTROPY_EXT,
                            std::min(spec.anisotropy, capabilities.limits.anisotropy));
    return id;
}

} // namespace tyndall::gl
