#pragma once
// Keys of cached results: one number for everything that a result depends on, for Builder::cacheBy() and other caches.

#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>

#include "core/math.h"
#include "framegraph/hash.h"
#include "shared/light.h"
#include "shared/view.h"

namespace tyndall {

// One value more; numbers count by their bits, so that -0 is not 0.
template <typename T>
requires std::integral<T> || std::is_enum_v<T> uint64_t mixKey(uint64_t key, T value) {
    return fg::mixHash(key, uint64_t(value));
}
inline uint64_t mixKey(uint64_t key, float value) {
    return fg::mixHash(key, std::bit_cast<uint32_t>(value));
}
inline uint64_t mixKey(uint64_t key, double value) {
    return fg::mixHash(key, std::bit_cast<uint64_t>(value));
}
template <glm::length_t N, typename T, glm::qualifier Q>
uint64_t mixKey(uint64_t key, const glm::vec<N, T, Q>& values) {
    for (glm::length_t i = 0; i < N; ++i) key = mixKey(key, values[i]);
    return key;
}
template <glm::length_t C, glm::length_t R, typename T, glm::qualifier Q>
uint64_t mixKey(uint64_t key, const glm::mat<C, R, T, Q>& columns) {
    for (glm::length_t i = 0; i < C; ++i) key = mixKey(key, columns[i]);
    return key;
}
inline uint64_t mixKey(uint64_t key, const Bounds& bounds) {
    return mixKey(mixKey(key, bounds.minimum), bounds.maximum);
}
inline uint64_t mixKey(uint64_t key, std::span<const std::byte> bytes) {
    return fg::hashName({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, key);
}

/// Of all values, in this order: versions, settings, numbers, vectors, matrices, boxes, bytes, other keys. Two different lists have the same key with a
/// probability of 2^-64. Not for random numbers, nor for files (framegraph/hash.h).
template <typename... Values> uint64_t cacheKey(const Values&... values) {
    uint64_t key = fg::kHashStart;
    ((key = mixKey(key, values)), ...);
    return key;
}

/// Of a view, but for its jitter, its frame and its random numbers.
inline uint64_t viewKey(const gpu::ViewData& view) {
    // The lens, without what rounding leaves of the jitter.
    const dmat4 clipFromView = dmat4(view.clipFromRender) * glm::inverse(dmat4(view.viewFromRender));
    const auto rounded = [](double x) { return float(std::round(x * 4096) / 4096); };
    return cacheKey(view.viewFromRender, rounded(clipFromView[0][0]), rounded(clipFromView[1][1]),
                    view.size.x, view.size.y, view.flags);
}

/// Of the lights, without the parts that only direct passes use and that change from frame to frame: a frame's own point on the light, and where its
/// shadows and optical depths lie.
inline uint64_t lightsKey(std::span<const gpu::LightData> lights) {
    uint64_t key = cacheKey(lights.size());
    for (gpu::LightData light : lights) {
        light.samplePoint = vec4(0);
        light.shadowIndex = 0;
        key = mixKey(key, std::as_bytes(std::span(&light, 1)));
    }
    return key;
}

} // namespace tyndall
