#pragma once
// 8-bit pictures for textures: PNG, JPEG and WebP, told apart by their first bytes.

#include <cstdint>
#include <span>

#include "core/result.h"
#include "scene/scene.h"

namespace tyndall {

inline constexpr int kMaxTextureSide = 16384;
inline constexpr int64_t kMaxTexturePixels = int64_t(1) << 26; // 8192², 256 MiB decoded

/// Decodes to RGBA, top row first (16-bit PNGs lose their low bits). The size is checked before anything is
/// allocated. Errors (without the file's name): not one of the three formats, damaged, over the limits.
Result<ImageData> decodeImage(std::span<const uint8_t> bytes);

} // namespace tyndall
