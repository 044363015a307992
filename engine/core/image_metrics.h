#pragma once
// How far an image is from a reference. Linear, unexposed; `r` the reference, `v` the image, means over pixels and channels.

#include <array>
#include <cstdint>

#include "core/image.h"

namespace tyndall {

/// Values that no picture of light may hold. They are counted before anything else, since they spoil every mean.
struct ValueCounts {
    uint64_t nonFinite = 0;
    uint64_t negative = 0;
};
ValueCounts countValues(const Image& image);

struct ImageMetrics {
    ValueCounts image, reference;
    double rmse = 0; // sqrt(mean((v-r)²))
    double relmse =
        0; // mean((v-r)² / (r² + 0.01·m²)), m the mean of r; independent of the scale of both
    double energy = 0;                        // mean(v) / mean(r)
    std::array<double, 4> energyPerChannel{}; // as many as there are channels
    double largestDifference = 0;             // max |v-r|
};

/// All metrics, in double precision. Where both are black everywhere, relmse is 0 and energy 1; where only the reference is,
/// both are infinite. With non-finite values the metrics are NaN.
/// Errors: the two differ in size or channels.
Result<ImageMetrics> compareImages(const Image& image, const Image& reference);

} // namespace tyndall
