#pragma once
// A dense array of voxels with its own trilinear interpolation: the independent answer to what bricks must give.

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/math.h"

namespace tyndall::test {

/// SplitMix64, so that every platform draws the same numbers.
class Draw {
public:
    explicit Draw(uint64_t seed) : state_(seed * 0x2545f4914f6cdd1du + 1) {}
    uint64_t bits() {
        uint64_t z = state_ += 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    double uniform(double low = 0, double high = 1) {
        return low + (high - low) * double(bits() >> 11) * 0x1p-53;
    }
    int integer(int low, int high) { return low + int(bits() % uint64_t(high - low + 1)); }
    dvec3 unitVector() {
        const double z = uniform(-1, 1), angle = uniform(0, 2 * kPi), r = std::sqrt(1 - z * z);
        return {r * std::cos(angle), r * std::sin(angle), z};
    }

private:
    uint64_t state_;
};

struct DenseField {
    ivec3 first{0}, size{0};
    std::vector<float> voxels; // x fastest

    DenseField(ivec3 firstVoxel, ivec3 extent)
        : first(firstVoxel), size(extent),
          voxels(size_t(extent.x) * size_t(extent.y) * size_t(extent.z), 0.0f) {}

    float& at(ivec3 index) {
        const ivec3 p = index - first;
        return voxels[(size_t(p.z) * size_t(size.y) + size_t(p.y)) * size_t(size.x) + size_t(p.x)];
    }
    [[nodiscard]] double value(int x, int y, int z) const {
        const ivec3 p = ivec3(x, y, z) - first;
        if (p.x < 0 || p.y < 0 || p.z < 0 || p.x >= size.x || p.y >= size.y || p.z >= size.z)
            return 0;
        return double(
            voxels[(size_t(p.z) * size_t(size.y) + size_t(p.y)) * size_t(size.x) + size_t(p.x)]);
    }
    /// The sum over eight voxels of value times the product of (1 - distance) along each axis.
    [[nodiscard]] double trilinear(const dvec3& index) const {
        const ivec3 low(int(std::floor(index.x)), int(std::floor(index.y)),
                        int(std::floor(index.z)));
        double sum = 0;
        for (int corner = 0; corner < 8; ++corner) {
            const ivec3 c = low + ivec3(corner & 1, (corner >> 1) & 1, corner >> 2);
            const dvec3 weight = 1.0 - glm::abs(index - dvec3(c));
            sum += weight.x * weight.y * weight.z * value(c.x, c.y, c.z);
        }
        return sum;
    }
};

} // namespace tyndall::test
