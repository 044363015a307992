#pragma once
// 8-bit pictures for textures: PNG, JPEG and WebP, told apart by their first bytes.

#include <cstdint>
#include <span>

#include "core/result.h"
#include "scene/scene.h"

namespace tyndall {

inline constexpr int kMaxTextureSide = 1 << 16; // what GPUs do not take is scaled down on its way there
inline constexpr int64_t kMaxTexturePixels = int64_t(1) << 28; // 16384², 1 GiB decoded

/// Decodes to RGBA, top row first (16-bit PNGs lose their low bits). The size is checked before anything is
/// allocated. Errors (without the file's name): not one of the three formats, damaged, over the limits.
Result<ImageData> decodeImage(std::span<const uint8_t> bytes);

} // namespace tyndall
