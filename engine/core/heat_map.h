#pragma once
// Where two images differ, as a picture: an error per pixel, and colours for it.

#include <cstdint>
#include <vector>

#include "core/image.h"

namespace tyndall {

/// |v-r| / (|r|+0.1·m), mean over the channels, m the mean of the finite values of r: one channel. NaN where a value of the
/// pixel is not finite. The two have one shape (a CHECK).
Image relativeErrorMap(const Image& image, const Image& reference);
/// (v-r) / (|r|+0.1·m) in the same way: negative where the image is darker than the reference.
Image signedErrorMap(const Image& image, const Image& reference);

enum class HeatScale {
    Magnitude = 0, // 0 is black, `largest` a pale yellow, lightness even in between
    Signed = 1,    // 0 is white, -`largest` blue, `largest` red, both equally dark
};
/// RGB bytes, top row first. What lies beyond `largest` has the last colour; NaN is green, which is in neither scale.
std::vector<uint8_t> heatMap(const Image& errors, double largest, HeatScale scale);

} // namespace tyndall
