#include "renderer/texture_scale.h"

#include "core/check.h"

#define STB_IMAGE_RESIZE_STATIC
#define STB_IMAGE_RESIZE_IMPLEMENTATION
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wold-style-cast"
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image_resize.h>
#pragma GCC diagnostic pop

namespace tyndall {

ImageData scaledDown(const ImageData& image, int width, int height, ColorSpace space) {
    CHECK(width >= 1 && height >= 1 && width <= image.width && height <= image.height,
          "scaling down, from a picture that has pixels");
    ImageData result;
    result.name = image.name;
    result.width = width;
    result.height = height;
    result.rgba.resize(size_t(width) * size_t(height) * 4);
    // "Premultiplied": colours are not weighted by alpha, as the mip levels' are not.
    const int done = stbir_resize_uint8_generic(
        image.rgba.data(), image.width, image.height, 0, result.rgba.data(), width, height, 0, 4, 3,
        STBIR_FLAG_ALPHA_PREMULTIPLIED, STBIR_EDGE_CLAMP, STBIR_FILTER_BOX,
        space == ColorSpace::Srgb ? STBIR_COLORSPACE_SRGB : STBIR_COLORSPACE_LINEAR, nullptr);
    CHECK(done == 1, "there is memory for a few rows");
    return result;
}

} // namespace tyndall
