#pragma once
// Textures of immutable storage, and views of them.

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "gl/format.h"
#include "gl/object.h"

namespace tyndall::gl {

/// Shape and format of a texture's storage.
struct TextureSpec {
    GLenum target =
        GL_TEXTURE_2D; // GL_TEXTURE_2D, GL_TEXTURE_2D_ARRAY, GL_TEXTURE_3D, GL_TEXTURE_CUBE_MAP
    GLenum internalFormat = GL_RGBA32F; // a format of format.cpp
    int width = 1, height = 1;
    int depth = 1; // slices of a 3D texture, layers of an array; 1 for 2D, 6 for cube maps
    int mips = 1;
    bool operator==(const TextureSpec&) const = default;
};

/// Mips of a full chain down to 1×1(×1).
int fullMipCount(int width, int height, int depth = 1);
/// Bytes of all mips, without the driver's padding.
int64_t textureBytes(const TextureSpec& spec);

/// Part of a texture: one mip, and a box of texels in it (z: slice or layer).
struct TextureRegion {
    int mip = 0;
    int x = 0, y = 0, z = 0;
    int width = 0, height = 0, depth = 1;
};

/// A texture with storage of its own, or a view of another's. Empty when moved from.
class Texture {
public:
    Texture() = default;
    /// Undefined content, sampled with GL_NEAREST until a sampler is bound. CHECKs what create() reports.
    Texture(std::string_view name, const TextureSpec& spec);
    /// Errors: larger than the driver's limits, or no room for it. CHECKs: positive sizes, known format.
    static Result<Texture> create(std::string_view name, const TextureSpec& spec);

    /// The same texels seen as `spec.target` with `spec.internalFormat` (of the same size of texel) and `spec.mips`
    /// from `firstMip`, `spec.depth` layers from `firstLayer`. The storage lives until texture and views are gone. Its
    /// width and height are those of `firstMip`.
    [[nodiscard]] Texture view(std::string_view name, GLenum target, GLenum internalFormat,
                               int firstMip, int mips, int firstLayer, int layers) const;

    [[nodiscard]] GLuint id() const { return object_.id(); }
    [[nodiscard]] const TextureSpec& spec() const { return spec_; }
    /// Bytes of its own storage; 0 for a view.
    [[nodiscard]] int64_t bytes() const { return object_.bytes(); }
    /// Unlike the GL name, never used twice in a process.
    [[nodiscard]] uint64_t serial() const { return serial_; }
    explicit operator bool() const { return bool(object_); }
    /// Size of a mip; arrays keep their layers.
    [[nodiscard]] TextureRegion mipRegion(int mip) const;

    /// Copies tightly packed texels into `region`, in `format` and `type` of glTexSubImage (0: the format's own, see
    /// format.h). `bytes` is the size of the data; CHECKs that the region lies inside and the size is right for the
    /// format's own types.
    void write(const TextureRegion& region, const void* data, size_t bytes, GLenum format = 0,
               GLenum type = 0);
    /// All texels of mip 0, tightly packed in the format's own type.
    void write(const void* data, size_t bytes) { write(mipRegion(0), data, bytes); }
    /// Every texel of every mip becomes this colour (or depth: x). For float, normalised and depth formats.
    void clear(float x, float y = 0, float z = 0, float w = 0);
    /// Every texel of every mip, for integer formats.
    void clearInteger(uint32_t x, uint32_t y = 0, uint32_t z = 0, uint32_t w = 0);
    /// Copies texels of `source`, GPU to GPU, to (x, y, z) of the same mip here. CHECKs: the same target and format, and both boxes inside.
    void copyFrom(const Texture& source, const TextureRegion& region, int x, int y, int z);
    void generateMips();
    /// Which component each of R, G, B, A reads (GL_RED … GL_ZERO, GL_ONE).
    void swizzle(GLenum r, GLenum g, GLenum b, GLenum a);

private:
    Object object_;
    TextureSpec spec_;
    uint64_t serial_ = 0;
};

} // namespace tyndall::gl
