#include "tracing/sampler.h"

#include "core/low_discrepancy.h"

namespace tyndall::tracing {
namespace {

/// Pairs of dimensions taken from sequences: a camera ray and some five vertices. Later vertices depend
/// on so many numbers that evenness in any two of them does not help.
constexpr uint32_t kSequencePairs = 24;

} // namespace

uint64_t mixBits(uint64_t x) {
    x += 0x9e3779b97f4a7c15ull;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
}

Sampler::Sampler(uint64_t seed, uint64_t pixel, uint32_t sample) {
    const uint64_t ofPixel = mixBits(mixBits(seed) ^ mixBits(pixel + 0x632be59bd9b4e019ull));
    key_ = mixBits(ofPixel + sample % kStreams);
    index_ = sample / kStreams;
    state_ = mixBits(mixBits(ofPixel ^ 0xd1b54a32d192ed03ull) + sample);
}

uint64_t Sampler::bits() {
    const uint64_t result = mixBits(state_);
    state_ += 0x9e3779b97f4a7c15ull;
    return result;
}

double Sampler::random() { return double(bits() >> 11) * 0x1p-53; }

dvec2 Sampler::next2() {
    spare_ = -1;
    if (pair_ >= kSequencePairs) return {random(), random()};
    return lowDiscrepancyPoint(index_, key_ + 0x9e3779b97f4a7c15ull * ++pair_);
}

double Sampler::next1() {
    if (spare_ >= 0) {
        const double result = spare_;
        spare_ = -1;
        return result;
    }
    const dvec2 point = next2();
    spare_ = point.y;
    return point.x;
}

} // namespace tyndall::tracing
