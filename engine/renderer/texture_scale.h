#pragma once
// Pictures that are larger than a driver takes.

#include "renderer/texture_upload.h"

namespace tyndall {

/// `image` at a smaller size: each texel is the mean of the area that it covers, sRGB averaged in linear light.
ImageData scaledDown(const ImageData& image, int width, int height, ColorSpace space);

} // namespace tyndall
