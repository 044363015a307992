#pragma once
// From textures to the CPU: at once for tests and the end of a capture, or later without a stall.

#include <vector>

#include "core/image.h"
#include "gl/buffer.h"
#include "gl/texture.h"

namespace tyndall::gl {

/// A copy of one mip on its way to the CPU. Rows run from the bottom, as GL has them; layers or slices follow one
/// another. Empty when moved from.
class ReadBack {
public:
    ReadBack() = default;
    /// Records the copy of a whole mip as 32-bit floats (normalised formats become 0..1, depth stays depth) or, for
    /// integer formats, as 32-bit integers. Commands before are taken into account, those after are not.
    static ReadBack start(const Texture& texture, int mip = 0);

    /// True when the data has come; never waits.
    [[nodiscard]] bool ready() const { return fence_.passed(); }
    /// The texels, waiting for them if need be; the read-back is empty afterwards. CHECKs: a format of that kind.
    std::vector<float> takeFloats();
    std::vector<uint32_t> takeIntegers();

    explicit operator bool() const { return bool(memory_); }
    /// Size of the mip; depth: layers or slices.
    [[nodiscard]] TextureRegion region() const { return region_; }
    /// Values per texel: 1 to 4.
    [[nodiscard]] int channels() const { return channels_; }

private:
    const void* finish();
    Object memory_;
    const void* mapped_ = nullptr;
    Fence fence_;
    TextureRegion region_;
    int channels_ = 0;
    bool integer_ = false;
};

/// One mip at once, bottom row first. Waits for the GPU.
std::vector<float> readFloats(const Texture& texture, int mip = 0);
std::vector<uint32_t> readIntegers(const Texture& texture, int mip = 0);

/// One layer, slice or face of mip 0 as an image: here the rows are turned, so that the first is the top one.
Image readImage(const Texture& texture, int layer = 0);
/// The same from a read-back that was started before.
Image takeImage(ReadBack& readBack, int layer = 0);

} // namespace tyndall::gl
