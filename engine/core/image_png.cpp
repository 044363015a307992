// PNG through stb_image and stb_image_write. It is encoded in memory, so that the file on disk is only ever whole.

#include "core/image.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wold-style-cast"
#define STB_IMAGE_WRITE_STATIC // other libraries carry a copy of their own
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>
#define STBI_ONLY_PNG // other formats' decoders would be open to hostile files for nothing
#define STBI_NO_STDIO
#define STBI_NO_FAILURE_STRINGS
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

#include <limits>
#include <memory>

#include <fmt/format.h>

namespace tyndall {
namespace {

constexpr int64_t kMaxPixels = int64_t(1) << 28;
// A deflate stream holds at most 1032 bytes a byte, and a pixel takes an eighth of a byte at least.
constexpr int64_t kMaxPixelsPerByte = 8 * 1032;

} // namespace

Result<Image> readPng(const std::filesystem::path& path) {
    const Result<std::string> content = readFile(path, size_t(std::numeric_limits<int>::max()));
    if (!content.ok()) return content.error();
    const auto* bytes = reinterpret_cast<const stbi_uc*>(content->data());
    const int size = int(content->size());
    int width = 0, height = 0, channels = 0;
    if (!stbi_info_from_memory(bytes, size, &width, &height, &channels))
        return Error{fmt::format("'{}' is not a PNG, or is damaged", path.string())};
    const int64_t pixelCount = int64_t(width) * height;
    if (pixelCount > kMaxPixels || pixelCount > kMaxPixelsPerByte * size)
        return Error{fmt::format(
            "'{}' claims {}x{} pixels, which its {} bytes cannot hold or which are over 2^28",
            path.string(), width, height, size)};
    // Asked for 16 bits, stb_image turns a byte b into 257·b, so that both depths have the same white.
    const std::unique_ptr<stbi_us, void (*)(void*)> pixels(
        stbi_load_16_from_memory(bytes, size, &width, &height, &channels, 3), stbi_image_free);
    if (!pixels) return Error{fmt::format("'{}' is damaged or cut off", path.string())};
    Image image(width, height, 3);
    for (size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = float(pixels.get()[i]) / 65535.0f;
    return image;
}

Result<void> writePng(const std::filesystem::path& path, int width, int height, int channels,
                      std::span<const uint8_t> bytes) {
    CHECK(channels == 3 || channels == 4, "a PNG is RGB or RGBA");
    CHECK(width > 0 && height > 0, fmt::format("size {}x{}", width, height));
    CHECK(bytes.size() == size_t(width) * size_t(height) * size_t(channels),
          fmt::format("{} bytes", bytes.size()));
    std::string encoded;
    const auto append = [](void* context, void* data, int size) {
        static_cast<std::string*>(context)->append(static_cast<const char*>(data), size_t(size));
    };
    if (!stbi_write_png_to_func(append, &encoded, width, height, channels, bytes.data(),
                                width * channels))
        return Error{fmt::format("cannot write '{}': no memory to encode {}x{} pixels",
                                 path.string(), width, height)};
    return writeFileAtomically(path, encoded);
}

} // namespace tyndall
