#include "core/low_discrepancy.h"

namespace tyndall {
namespace {

inline uint32_t reverseBits(uint32_t x) {
    x = __builtin_bswap32(x);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    return ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
}

/// A permutation in which each bit depends on lower ones alone (Laine and Karras 2011, with Burley's constants): on reversed bits it is
/// an Owen scrambling.
inline uint32_t permuteUpwards(uint32_t x, uint32_t seed) {
    x += seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return x;
}

inline uint32_t scramble(uint32_t x, uint32_t seed) {
    return reverseBits(permuteUpwards(reverseBits(x), seed));
}

/// The second dimension of Sobol's sequence; the first is the radical inverse.
uint32_t sobol1(uint32_t index) {
    uint32_t result = 0;
    for (uint32_t direction = 0x80000000u; index != 0; index >>= 1, direction ^= direction >> 1)
        if (index & 1u) result ^= direction;
    return result;
}

/// SplitMix64's output function.
uint64_t mix(uint64_t x) {
    x += 0x9e3779b97f4a7c15ull;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
}

} // namespace

dvec2 lowDiscrepancyPoint(uint32_t index, uint64_t key) {
    const uint64_t a = mix(key), b = mix(a);
    const uint32_t shuffled = scramble(index, uint32_t(a));
    // Scrambling the radical inverse: its two reversals cancel one of scramble's.
    const uint32_t x = reverseBits(permuteUpwards(shuffled, uint32_t(a >> 32))),
                   y = scramble(sobol1(shuffled), uint32_t(b));
    return {x * 0x1p-32, y * 0x1p-32};
}

} // namespace tyndall
