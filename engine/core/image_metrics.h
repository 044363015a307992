#pragma once
// How far an image is from a reference. Linear, unexposed; `r` the reference, `v` the image, means over pixels and channels.
// The names are those of `tyndall compare`; docs/compare.md says which of them to use for what.

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
    /// mean((v-r)² / (r² + 0.01·m²)), m the mean of r; independent of the scale of both.
    double relmse = 0;
    /// relmse without the floor(N/1000) pixels of N that are worst (a pixel's error is the mean over its channels); m stays
    /// the mean of the whole reference. Far below relmse: the error is in a few fireflies.
    double relmseTrimmed = 0;
    /// mean((s·v-s·r)² / (s·r+0.01)²) with s = 0.5 / mean luminance of r (Rec. 709 weights; with fewer than three channels
    /// the mean of r). The relative error of pbrt-v4's imgtool, made independent of the exposure by s.
    double mrse = 0;
    /// mean(2|v-r| / (|v|+|r|+0.01·m)), from 0 to 2: the symmetric mean absolute percentage error with the factor two.
    double smape = 0;
    /// The smallest x such that |v-r| / (|r|+0.1·m) is at most x for 99.9 % of all values (nearest rank).
    double p999 = 0;
    double energy = 0;                        // mean(v) / mean(r)
    std::array<double, 4> energyPerChannel{}; // as many as there are channels
    double largestDifference = 0;             // max |v-r|
};

/// All metrics, in double precision. Where both are black everywhere, errors are 0 and energy 1; where only the reference is,
/// relative errors (but smape) and energy are infinite. With non-finite values the metrics are NaN.
/// Errors: the two differ in size or channels.
Result<ImageMetrics> compareImages(const Image& image, const Image& reference);

/// The relmse that a perfect image would show against a noisy reference: mean(var / (r² + 0.01·m²)), where `variance` is the
/// variance of the mean that each value of `reference` is. A relmse near it says nothing about the image.
/// Errors: the two differ in size or channels; a variance is negative or not finite.
Result<double> referenceFloor(const Image& reference, const Image& variance);

} // namespace tyndall
