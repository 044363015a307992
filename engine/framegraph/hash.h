#pragma once
// 64-bit hashes of names and of contents. Not for files: the values may differ between versions.

#include <cstdint>
#include <string_view>

namespace tyndall::fg {

inline constexpr uint64_t kHashStart = 0xcbf29ce484222325ull;

/// Spreads every bit of `value` and `seed` over the result (the finaliser of SplitMix64 on their combination).
constexpr uint64_t mixHash(uint64_t seed, uint64_t value) {
    uint64_t h = seed * 0x9e3779b97f4a7c15ull + value + 0x632be59bd9b4e019ull;
    h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9ull;
    h = (h ^ (h >> 27)) * 0x94d049bb133111ebull;
    return h ^ (h >> 31);
}

/// FNV-1a.
constexpr uint64_t hashName(std::string_view name, uint64_t seed = kHashStart) {
    for (const char c : name) seed = (seed ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
    return seed;
}

} // namespace tyndall::fg
