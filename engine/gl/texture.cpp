#include "gl/texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>

#include "gl/context.h"

namespace tyndall::gl {
namespace {

uint64_t nextSerial() {
    static std::atomic<uint64_t> last{0};
    return ++last;
}

bool isArrayLike(GLenum target) {
    return target == GL_TEXTURE_2D_ARRAY || target == GL_TEXTURE_CUBE_MAP;
}

/// Errors: sizes that this driver does not take.
Result<void> checkLimits(std::string_view name, const TextureSpec& spec, const Limits& limits) {
    const int edge = spec.target == GL_TEXTURE_3D ? limits.texture3DSize : limits.textureSize;
    const int layers = spec.target == GL_TEXTURE_2D_ARRAY ? limits.textureLayers
                       : spec.target == GL_TEXTURE_3D     ? limits.texture3DSize
                                                          : 6;
    if (spec.width <= edge && spec.height <= edge && spec.depth <= layers) return {};
    return Error{fmt::format("texture '{}' of {}x{}x{} is larger than this GPU takes ({}x{}x{})",
                             name, spec.width, spec.height, spec.depth, edge, edge, layers)};
}

void checkSpec(std::string_view name, const TextureSpec& spec) {
    CHECK(spec.target == GL_TEXTURE_2D || spec.target == GL_TEXTURE_2D_ARRAY ||
              spec.target == GL_TEXTURE_3D || spec.target == GL_TEXTURE_CUBE_MAP,
          fmt::format("texture '{}' has target {:#x}", name, spec.target));
    CHECK(spec.width > 0 && spec.height > 0 && spec.depth > 0,
          fmt::format("texture '{}' of {}x{}x{} has no texels", name, spec.width, spec.height,
                      spec.depth));
    CHECK(spec.target != GL_TEXTURE_2D || spec.depth == 1,
          fmt::format("2D texture '{}' has depth {}", name, spec.depth));
    CHECK(spec.target != GL_TEXTURE_CUBE_MAP || (spec.depth == 6 && spec.width == spec.height),
          fmt::format("cube map '{}' needs six square faces", name));
    const int most =
        fullMipCount(spec.width, spec.height, spec.target == GL_TEXTURE_3D ? spec.depth : 1);
    CHECK(spec.mips >= 1 && spec.mips <= most,
          fmt::format("texture '{}' has {} mips, of at most {}", name, spec.mips, most));
}

void allocate(GLuint id, const TextureSpec& spec) {
    if (spec.target == GL_TEXTURE_2D || spec.target == GL_TEXTURE_CUBE_MAP)
        glTextureStorage2D(id, spec.mips, spec.internalFormat, spec.width, spec.height);
    else
        glTextureStorage3D(id, spec.mips, spec.internalFormat, spec.width, spec.height, spec.depth);
}

void checkInside(const char* what, const TextureRegion& region, const TextureRegion& whole) {
    const auto inside = [](int first, int count, int size) {
        return first >= 0 && count >= 0 && first <= size && count <= size - first;
    };
    CHECK(inside(region.x, region.width, whole.width) &&
              inside(region.y, region.height, whole.height) &&
              inside(region.z, region.depth, whole.depth),
          fmt::format("{} of {}x{}x{} texels at {},{},{} to a mip of {}x{}x{}", what, region.width,
                      region.height, region.depth, region.x, region.y, region.z, whole.width,
                      whole.height, whole.depth));
}

/// A texture without mips would else be incomplete, and read as black, where a pass binds no sampler.
void setPlainSampling(GLuint id, const TextureSpec& spec) {
    glTextureParameteri(id, GL_TEXTURE_MIN_FILTER,
                        spec.mips > 1 ? GL_NEAREST_MIPMAP_NEAREST : GL_NEAREST);
    glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    for (GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
        glTextureParameteri(id, wrap, GL_CLAMP_TO_EDGE);
}

} // namespace

int fullMipCount(int width, int height, int depth) {
    int count = 1;
    for (int edge = std::max({width, height, depth}); edge > 1; edge /= 2) ++count;
    return count;
}

int64_t textureBytes(const TextureSpec& spec) {
    int64_t texels = 0;
    for (int mip = 0; mip < spec.mips; ++mip) {
        const int64_t depth =
            spec.target == GL_TEXTURE_3D ? std::max(1, spec.depth >> mip) : spec.depth;
        texels += int64_t(std::max(1, spec.width >> mip)) * std::max(1, spec.height >> mip) * depth;
    }
    return texels * formatInfo(spec.internalFormat).bytesPerTexel;
}

Result<Texture> Texture::create(std::string_view name, const TextureSpec& spec) {
    checkSpec(name, spec);
    if (Result<void> limits = checkLimits(name, spec, currentCapabilities().limits); !limits)
        return limits.error();
    GLuint id = 0;
    glCreateTextures(spec.target, 1, &id);
    while (glGetError() != GL_NO_ERROR) {
    } // so that an error read afterwards is new
    allocate(id, spec);
    if (glGetError() == GL_OUT_OF_MEMORY) {
        glDeleteTextures(1, &id);
        return Error{fmt::format(
            "texture '{}' of {}x{}x{} {}: the GPU has no room for its {} bytes", name, spec.width,
            spec.height, spec.depth, formatInfo(spec.internalFormat).name, textureBytes(spec))};
    }
    setPlainSampling(id, spec);
    Texture texture;
    texture.object_ = Object(ObjectKind::Texture, id, textureBytes(spec));
    texture.object_.label(name);
    texture.spec_ = spec;
    texture.serial_ = nextSerial();
    return texture;
}

Texture::Texture(std::string_view name, const TextureSpec& spec) {
    Result<Texture> created = create(name, spec);
    if (!created.ok()) throw NoRoom(created.message());
    *this = std::move(*created);
}

Texture Texture::view(std::string_view name, GLenum target, GLenum internalFormat, int firstMip,
                      int mips, int firstLayer, int layers) const {
    CHECK(object_, "a view of an empty texture");
    CHECK(formatInfo(internalFormat).bytesPerTexel ==
              formatInfo(spec_.internalFormat).bytesPerTexel,
          fmt::format("view '{}' as {} of a texture of {}", name, formatInfo(internalFormat).name,
                      formatInfo(spec_.internalFormat).name));
    CHECK(firstMip >= 0 && mips >= 1 && firstMip + mips <= spec_.mips,
          fmt::format("view '{}' of mips {}+{} of a texture with {}", name, firstMip, mips,
                      spec_.mips));
    const int layersOfAll = isArrayLike(spec_.target) ? spec_.depth : 1;
    CHECK(firstLayer >= 0 && layers >= 1 && firstLayer + layers <= layersOfAll,
          fmt::format("view '{}' of layers {}+{} of a texture with {}", name, firstLayer, layers,
                      layersOfAll));
    GLuint id = 0;
    glGenTextures(
        1,
        &id); // glTextureView needs a name that was never bound, which glCreateTextures does not give
    glTextureView(id, target, this->id(), internalFormat, GLuint(firstMip), GLuint(mips),
                  GLuint(firstLayer), GLuint(layers));
    Texture result;
    result.object_ = Object(ObjectKind::Texture, id);
    result.object_.label(name);
    const TextureRegion size = mipRegion(firstMip);
    result.spec_ = {target,
                    internalFormat,
                    size.width,
                    size.height,
                    target == GL_TEXTURE_3D ? size.depth : layers,
                    mips};
    result.serial_ = nextSerial();
    setPlainSampling(id, result.spec_);
    return result;
}

TextureRegion Texture::mipRegion(int mip) const {
    CHECK(mip >= 0 && mip < spec_.mips,
          fmt::format("mip {} of a texture with {}", mip, spec_.mips));
    TextureRegion region;
    region.mip = mip;
    region.width = std::max(1, spec_.width >> mip);
    region.height = std::max(1, spec_.height >> mip);
    region.depth = spec_.target == GL_TEXTURE_3D ? std::max(1, spec_.depth >> mip) : spec_.depth;
    return region;
}

void Texture::write(const TextureRegion& region, const void* data, size_t bytes, GLenum format,
                    GLenum type) {
    checkInside("write", region, mipRegion(region.mip));
    const FormatInfo& info = formatInfo(spec_.internalFormat);
    if (format == 0) {
        const size_t expected = size_t(region.width) * size_t(region.height) *
                                size_t(region.depth) * info.bytesPerTexel;
        CHECK(bytes == expected,
              fmt::format("write of {} bytes where {} are needed", bytes, expected));
        format = info.transferFormat;
        type = info.transferType;
    }
    if (spec_.target == GL_TEXTURE_2D)
        glTextureSubImage2D(id(), region.mip, region.x, region.y, region.width, region.height,
                            format, type, data);
    else
        glTextureSubImage3D(id(), region.mip, region.x, region.y, region.z, region.width,
                            region.height, region.depth, format, type, data);
}

void Texture::clear(float x, float y, float z, float w) {
    const FormatInfo& info = formatInfo(spec_.internalFormat);
    const float color[4] = {x, y, z, w};
    const bool depth = info.formatClass == FormatClass::Depth;
    CHECK(depth || info.formatClass == FormatClass::Float,
          fmt::format("clear() of {}, an integer format", info.name));
    for (int mip = 0; mip < spec_.mips; ++mip)
        glClearTexImage(id(), mip, depth ? GL_DEPTH_COMPONENT : GL_RGBA, GL_FLOAT, color);
}

void Texture::clearInteger(uint32_t x, uint32_t y, uint32_t z, uint32_t w) {
    const FormatInfo& info = formatInfo(spec_.internalFormat);
    const bool isSigned = info.formatClass == FormatClass::SignedInt;
    CHECK(isSigned || info.formatClass == FormatClass::UnsignedInt,
          fmt::format("clearInteger() of {}", info.name));
    const uint32_t value[4] = {x, y, z, w};
    for (int mip = 0; mip < spec_.mips; ++mip)
        glClearTexImage(id(), mip, GL_RGBA_INTEGER, isSigned ? GL_INT : GL_UNSIGNED_INT, value);
}

void Texture::copyFrom(const Texture& source, const TextureRegion& region, int x, int y, int z) {
    CHECK(source.spec_.target == spec_.target &&
              source.spec_.internalFormat == spec_.internalFormat,
          "texels are copied between textures of one kind and format");
    TextureRegion to = region;
    to.x = x, to.y = y, to.z = z;
    checkInside("copy", region, source.mipRegion(region.mip));
    checkInside("copy", to, mipRegion(to.mip));
    glCopyImageSubData(source.id(), spec_.target, region.mip, region.x, region.y, region.z, id(),
                       spec_.target, to.mip, x, y, z, region.width, region.height, region.depth);
}

void Texture::generateMips() {
    if (spec_.mips > 1) glGenerateTextureMipmap(id());
}

void Texture::swizzle(GLenum r, GLenum g, GLenum b, GLenum a) {
    const GLint components[4] = {GLint(r), GLint(g), GLint(b), GLint(a)};
    glTextureParameteriv(id(), GL_TEXTURE_SWIZZLE_RGBA, components);
}

} // namespace tyndall::gl
