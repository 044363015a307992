#include "core/low_discrepancy.h"

#include <cmath>
#include <gtest/gtest.h>
#include <set>

namespace tyndall {
namespace {

TEST(LowDiscrepancy, EveryPowerOfTwoOfPointsHasOneInEachElementaryInterval) {
    for (uint64_t key : {0ull, 1ull, 77ull, 0xdeadbeefull})
        for (int m = 1; m <= 8; ++m)
            for (int xBits = 0; xBits <= m; ++xBits) {
                std::set<std::pair<int, int>> cells;
                for (uint32_t i = 0; i < (1u << m); ++i) {
                    const dvec2 p = lowDiscrepancyPoint(i, key);
                    cells.emplace(int(p.x * (1 << xBits)), int(p.y * (1 << (m - xBits))));
                }
                ASSERT_EQ(cells.size(), size_t(1) << m)
                    << "key " << key << ", 2^" << m << " points, " << xBits << " bits of x";
            }
}

TEST(LowDiscrepancy, SequencesOfDifferentKeysAreUncorrelated) {
    // Mean of (x-1/2)(x'-1/2) over n points of two independent sequences: 0 with a standard deviation of at most 1/(12·sqrt(n)).
    constexpr uint32_t kPoints = 1024;
    for (uint64_t a = 0; a < 8; ++a)
        for (uint64_t b = a + 1; b < 8; ++b) {
            dvec2 sum(0);
            for (uint32_t i = 0; i < kPoints; ++i)
                sum += (lowDiscrepancyPoint(i, a) - 0.5) * (lowDiscrepancyPoint(i, b) - 0.5) /
                       double(kPoints);
            const double bound = 4.5 / (12 * std::sqrt(double(kPoints)));
            EXPECT_LE(std::abs(sum.x), bound) << a << " and " << b;
            EXPECT_LE(std::abs(sum.y), bound) << a << " and " << b;
        }
}

TEST(LowDiscrepancy, IntegratesASmoothFunctionFasterThanRandomPoints) {
    // Integral of e^(x+y) over the square: (e-1)². Random points: error about 0.7/sqrt(n) = 0.02 for n = 1024.
    double sum = 0;
    for (uint32_t i = 0; i < 1024; ++i) {
        const dvec2 p = lowDiscrepancyPoint(i, 5);
        sum += std::exp(p.x + p.y) / 1024;
    }
    EXPECT_NEAR(sum, std::pow(std::exp(1.0) - 1, 2), 1e-3);
}

} // namespace
} // namespace tyndall
