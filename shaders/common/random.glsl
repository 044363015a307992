// Noise for sampling: well spread over neighbouring pixels in one frame, and over the frames in one pixel.
//
// Every pixel has an offset from interleaved gradient noise (Jimenez, "Next Generation Post Processing in Call of Duty:
// Advanced Warfare", 2014: any 3×3 pixels hold well-spread values); frames step through Weyl sequences (multiples of an
// irrational number, modulo 1; in two dimensions those of the plastic number: Roberts, "The Unreasonable Effectiveness of
// Quasirandom Sequences", 2018). `dimension` tells apart the uses within one shader: each has its own offset and step.
// Steps are 32-bit fractions, so that the thousandth frame is as exact as the first.
#ifndef TYNDALL_COMMON_RANDOM_GLSL
#define TYNDALL_COMMON_RANDOM_GLSL
#include "common/view.glsl"

/// A bijection on 32-bit integers that mixes all bits (the finaliser of MurmurHash3).
uint hashUint(uint x) {
    x ^= x >> 16;
    x *= 0x85ebca6bu;
    x ^= x >> 13;
    x *= 0xc2b2ae35u;
    x ^= x >> 16;
    return x;
}

/// The upper 24 bits as a number in [0,1): every value is a float exactly.
float unitFloat(uint x) { return float(x >> 8) * (1.0 / 16777216.0); }

uint pixelOffset(uvec2 pixel, uint dimension) {
    // Far-apart windows of one pattern are unrelated.
    uint shift = hashUint(dimension * 0x9e3779b9u + view.seed * 0x7feb352du + 1u);
    vec2 p = vec2(pixel & 4095u) + vec2(float(shift & 1023u), float((shift >> 10) & 1023u));
    float noise = fract(52.9829189 * fract(dot(p, vec2(0.06711056, 0.00583715))));
    return uint(noise * 16777216.0) << 8;
}

/// 0..1, never 1. Successive frames of one pixel form a Weyl sequence.
float pixelNoise(uvec2 pixel, uint dimension) {
    // The golden ratio, then square roots of primes: steps that are irrational to each other, so that pairs fill the square.
    const uint kSteps[8] = uint[8](0x9e3779b9u, 0x6a09e667u, 0xbb67ae85u, 0xa54ff53bu, 0x510e527fu, 0x9b05688du, 0x1f83d9abu, 0x5be0cd19u);
    return unitFloat(pixelOffset(pixel, dimension) + view.frameIndex * kSteps[dimension & 7u]);
}

/// A point of the unit square, never 1. Successive frames of one pixel fill the square evenly.
vec2 pixelNoise2(uvec2 pixel, uint dimension) {
    const uvec2 kSteps[4] = uvec2[4](uvec2(0xc13fa9a9u, 0x91e10da5u), uvec2(0x6a09e667u, 0xbb67ae85u),
                                     uvec2(0xa54ff53bu, 0x510e527fu), uvec2(0x9b05688du, 0x1f83d9abu));
    uvec2 steps = kSteps[dimension & 3u] * view.frameIndex;
    return vec2(unitFloat(pixelOffset(pixel, 2u * dimension + 64u) + steps.x),
                unitFloat(pixelOffset(pixel, 2u * dimension + 65u) + steps.y));
}

/// Four numbers in [0,1) that depend on each other no more than chance has it: for what is drawn in so many dimensions at once that sequences of one
/// step each would go round together.
vec4 pixelRandom(uvec2 pixel, uint dimension) {
    uint key = hashUint(pixel.x + hashUint(pixel.y + hashUint(view.frameIndex + hashUint(dimension * 0x9e3779b9u + view.seed))));
    return vec4(unitFloat(key), unitFloat(hashUint(key + 0x632be5abu)), unitFloat(hashUint(key + 0x1b56c4e9u)), unitFloat(hashUint(key + 0x7f4a7c15u)));
}

#endif
