#pragma once
// Points that fill a square evenly however many are taken, for what varies from frame to frame when frames are averaged.

#include <cstdint>

#include "core/math.h"

namespace tyndall {

/// Point `index` of the sequence `key`, in [0,1)². Any 2^m first points of a sequence form a (0,m,2)-net: one in each
/// elementary interval. Sequences of different keys are shuffled and scrambled apart from each other, so that points with the same
/// index (a frame's sub-pixel offset, its point on each light …) are independent and averages over all of them unbiased.
/// Sobol's first two dimensions, index and digits scrambled by hashing (Burley 2020, "Practical Hash-based Owen Scrambling").
[[nodiscard]] dvec2 lowDiscrepancyPoint(uint32_t index, uint64_t key);

} // namespace tyndall
