#include "scene/image_decode.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>

#include <fmt/format.h>
#include <webp/decode.h>

// Only the two formats that glTF uses: the others' decoders would be open to hostile files for nothing.
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_NO_FAILURE_STRINGS
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wold-style-cast"
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace tyndall {
namespace {

bool startsWith(std::span<const uint8_t> bytes, std::string_view magic, size_t offset = 0) {
    return bytes.size() >= offset + magic.size() &&
           std::memcmp(bytes.data() + offset, magic.data(), magic.size()) == 0;
}

/// What deflate makes of zeros (1032 bytes of one), as eight pixels a byte; what claims more is a bomb.
constexpr int64_t kMaxPixelsPerByte = 8 * 1032, kAlwaysAllowed = int64_t(1) << 24;

Result<void> checkSize(int width, int height, size_t bytes) {
    if (width < 1 || height < 1 || width > kMaxTextureSide || height > kMaxTextureSide ||
        int64_t(width) * height > kMaxTexturePixels)
        return Error{fmt::format(
            "the picture is {}x{} pixels, but at most {} a side and {} million in all are read",
            width, height, kMaxTextureSide, kMaxTexturePixels / 1000000)};
    if (int64_t(width) * height > std::max(kAlwaysAllowed, kMaxPixelsPerByte * int64_t(bytes)))
        return Error{fmt::format("the picture claims {}x{} pixels in {} bytes, which cannot be",
                                 width, height, bytes)};
    return {};
}

ImageData makeImage(int width, int height, const uint8_t* rgba) {
    ImageData image;
    image.width = width;
    image.height = height;
    image.rgba.assign(rgba, rgba + size_t(width) * size_t(height) * 4);
    return image;
}

Result<ImageData> decodeWebp(std::span<const uint8_t> bytes) {
    int width = 0, height = 0;
    if (!WebPGetInfo(bytes.data(), bytes.size(), &width, &height))
        return Error{"the WebP picture is damaged"};
    if (auto fits = checkSize(width, height, bytes.size()); !fits) return fits.error();
    ImageData image;
    image.width = width;
    image.height = height;
    image.rgba.resize(size_t(width) * size_t(height) * 4);
    if (!WebPDecodeRGBAInto(bytes.data(), bytes.size(), image.rgba.data(), image.rgba.size(),
                            width * 4))
        return Error{"the WebP picture is damaged"};
    return image;
}

Result<ImageData> decodeStb(std::span<const uint8_t> bytes, const char* format) {
    int width = 0, height = 0, channels = 0;
    const int size = int(std::min<size_t>(bytes.size(), size_t(1) << 30));
    if (!stbi_info_from_memory(bytes.data(), size, &width, &height, &channels))
        return Error{
            fmt::format("the {} picture is damaged or of a kind that is not read", format)};
    if (auto fits = checkSize(width, height, bytes.size()); !fits) return fits.error();
    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, 4), stbi_image_free);
    if (!pixels) return Error{fmt::format("the {} picture is damaged", format)};
    return makeImage(width, height, pixels.get());
}

} // namespace

Result<ImageData> decodeImage(std::span<const uint8_t> bytes) {
    if (startsWith(bytes, "\x89PNG\r\n\x1a\n")) return decodeStb(bytes, "PNG");
    if (startsWith(bytes, "\xff\xd8\xff")) return decodeStb(bytes, "JPEG");
    if (startsWith(bytes, "RIFF") && startsWith(bytes, "WEBP", 8)) return decodeWebp(bytes);
    return Error{"the picture is neither PNG, JPEG nor WebP"};
}

} // namespace tyndall
