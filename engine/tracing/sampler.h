#pragma once
// The random numbers of one path. The first ones come from low-discrepancy sequences over the samples of a pixel, the
// others from a generator; both depend on nothing but seed, pixel and sample number, so that a picture does not depend on
// which thread made which part of it.

#include <cstdint>

#include "core/math.h"

namespace tyndall::tracing {

/// The samples of a pixel belong in turn to this many streams, each scrambled apart from the others: the spread of
/// the streams' means measures the error of their mean, also for low-discrepancy points.
inline constexpr int kStreams = 8;

class Sampler {
public:
    /// Sample number `sample` of pixel number `pixel`.
    Sampler(uint64_t seed, uint64_t pixel, uint32_t sample);

    /// The next two dimensions, in [0,1)².
    dvec2 next2();
    /// The next dimension, in [0,1). Two calls use one pair.
    double next1();
    /// An independent number in [0,1), for uses without a fixed number of dimensions.
    double random();
    /// An independent 64-bit number.
    uint64_t bits();

private:
    uint64_t key_;   // of the pixel's stream
    uint64_t state_; // of the generator
    uint32_t index_; // within the stream
    uint32_t pair_ = 0;
    double spare_ = -1;
};

/// SplitMix64's output function: a bijection that spreads every bit.
uint64_t mixBits(uint64_t x);

} // namespace tyndall::tracing
