// PNG through stb_image_write, whose implementation lives here alone. It is encoded in memory, so that the file on disk
// is only ever whole.

#include "core/image.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wold-style-cast"
#define STB_IMAGE_WRITE_STATIC // other libraries carry a copy of their own
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

#include <fmt/format.h>

namespace tyndall {

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
