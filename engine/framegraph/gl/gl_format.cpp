#include "framegraph/gl/gl_format.h"

#include <iterator>

#include "core/check.h"

namespace tyndall::fg {

GLenum glFormat(Format format) {
    static constexpr GLenum kFormats[] = {GL_R8,         GL_RGBA8,          GL_SRGB8_ALPHA8,
                                          GL_RG16_SNORM, GL_RGBA16,         GL_R16F,
                                          GL_RG16F,      GL_RGBA16F,        GL_R32F,
                                          GL_RG32F,      GL_RGBA32F,        GL_R16UI,
                                          GL_R32UI,      GL_RG32UI,         GL_RGBA32UI,
                                          GL_R32I,       GL_R11F_G11F_B10F, GL_DEPTH_COMPONENT32F};
    CHECK(size_t(format) < std::size(kFormats), "not a format");
    return kFormats[size_t(format)];
}

GLenum glTarget(TextureKind kind) {
    switch (kind) {
    case TextureKind::Tex2D: return GL_TEXTURE_2D;
    case TextureKind::Tex2DArray: return GL_TEXTURE_2D_ARRAY;
    case TextureKind::Tex3D: return GL_TEXTURE_3D;
    }
    CHECK(false, "not a kind of texture");
}

gl::TextureSpec glSpec(const TextureDesc& desc) {
    return {
        glTarget(desc.kind), glFormat(desc.format), desc.width, desc.height, desc.depth, desc.mips};
}

bool isFloatColor(Format format) {
    switch (format) {
    case Format::R16F:
    case Format::RG16F:
    case Format::RGBA16F:
    case Format::R32F:
    case Format::RG32F:
    case Format::RGBA32F:
    case Format::R11G11B10F: return true;
    default: return false;
    }
}

gl::SamplerSpec samplerFor(GLenum internalFormat, int mips, bool shadow) {
    const gl::FormatClass formatClass = gl::formatInfo(internalFormat).formatClass;
    if (formatClass == gl::FormatClass::Depth && shadow) {
        gl::SamplerSpec spec = gl::linearClamp();
        spec.compare = GL_GEQUAL;
        return spec;
    }
    gl::SamplerSpec spec =
        formatClass == gl::FormatClass::Float ? gl::linearClamp() : gl::nearestClamp();
    if (mips > 1)
        spec.minFilter = formatClass == gl::FormatClass::Float ? GL_LINEAR_MIPMAP_LINEAR
                                                               : GL_NEAREST_MIPMAP_NEAREST;
    return spec;
}

bool isShadowSampler(GLenum uniformType) {
    return uniformType == GL_SAMPLER_2D_SHADOW || uniformType == GL_SAMPLER_2D_ARRAY_SHADOW;
}

bool isSampler2D(GLenum uniformType) {
    return uniformType == GL_SAMPLER_2D || uniformType == GL_SAMPLER_2D_SHADOW ||
           uniformType == GL_INT_SAMPLER_2D || uniformType == GL_UNSIGNED_INT_SAMPLER_2D;
}

} // namespace tyndall::fg
