#pragma once
// What a resource is: plain data that the graph pools and the executor creates.

#include <cstdint>

namespace tyndall::fg {

enum class Format : uint32_t {
    R8 = 0,
    RGBA8 = 1,
    SRGBA8 = 2,
    RG16Snorm = 3,
    RGBA16 = 4,
    R16F = 5,
    RG16F = 6,
    RGBA16F = 7,
    R32F = 8,
    RG32F = 9,
    RGBA32F = 10,
    R16UI = 11,
    R32UI = 12,
    RG32UI = 13,
    RGBA32UI = 14,
    R32I = 15,
    R11G11B10F = 16,
    Depth32F = 17,
};

enum class TextureKind : uint32_t { Tex2D = 0, Tex2DArray = 1, Tex3D = 2 };

struct TextureDesc {
    TextureKind kind = TextureKind::Tex2D;
    Format format = Format::RGBA32F;
    int32_t width = 1, height = 1;
    int32_t depth = 1; // slices of a 3D texture, layers of an array, else 1
    int32_t mips = 1;
    bool operator==(const TextureDesc&) const = default;
};

struct BufferDesc {
    uint64_t bytes = 0;
    bool operator==(const BufferDesc&) const = default;
};

inline TextureDesc texture2D(Format format, int width, int height) {
    return {TextureKind::Tex2D, format, width, height, 1, 1};
}
inline TextureDesc texture2DArray(Format format, int width, int height, int layers) {
    return {TextureKind::Tex2DArray, format, width, height, layers, 1};
}
inline TextureDesc texture3D(Format format, int width, int height, int depth) {
    return {TextureKind::Tex3D, format, width, height, depth, 1};
}

/// Bytes of all mips, without driver padding.
uint64_t byteSize(const TextureDesc& desc);
uint32_t bytesPerTexel(Format format);
const char* formatName(Format format);
bool isIntegerFormat(Format format);

} // namespace tyndall::fg
