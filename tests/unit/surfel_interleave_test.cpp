// The tables that spread rays over sub-buffers: permutations, their inverses, and blue noise by
// a discrete Fourier transform.

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>

#include <gtest/gtest.h>

#include "core/math.h"
#include "shared/surfels.h"
#include "volumetric_gi/surfels/interleave.h"

namespace tyndall::test {
namespace {

using namespace volumetric_gi;

constexpr uint32_t kSide = gpu::kSurfelTile, kArea = kSide * kSide;

const std::vector<uint32_t>& ranksOfTile() {
    static const std::vector<uint32_t> ranks = blueNoiseRanks(kSide);
    return ranks;
}

void expectPermutation(std::vector<uint32_t> values) {
    std::sort(values.begin(), values.end());
    std::vector<uint32_t> all(values.size());
    std::iota(all.begin(), all.end(), 0u);
    EXPECT_EQ(values, all);
}

/// Mean power of a 0-1 pattern over the frequencies between two radii, in periods a tile;
/// without the mean, which is at 0.
double powerWithin(const std::vector<double>& pattern, double low, double high) {
    const int side = int(kSide);
    double sum = 0;
    int count = 0;
    // The other half plane has the conjugates.
    for (int v = 0; v <= side / 2; ++v)
        for (int u = -side / 2; u < side / 2; ++u) {
            const double radius = std::hypot(u, v);
            if (radius <= low || radius > high) continue;
            std::complex<double> wave = 0;
            for (int y = 0; y < side; ++y)
                for (int x = 0; x < side; ++x)
                    if (pattern[size_t(y * side + x)] != 0)
                        wave += std::polar(1.0, -2 * kPi * (u * x + v * y) / side);
            sum += std::norm(wave);
            ++count;
        }
    return sum / count;
}

TEST(SurfelInterleave, RanksOfTheTileAreAPermutation) {
    for (const uint32_t side : {1u, 2u, 8u, 31u}) expectPermutation(blueNoiseRanks(side));
    expectPermutation(ranksOfTile());
}

TEST(SurfelInterleave, TheLowestRanksAreBlueNoise) {
    for (const uint32_t part : {16u, 8u, 4u, 2u}) {
        const uint32_t points = kArea / part;
        std::vector<double> pattern(kArea);
        for (size_t i = 0; i < kArea; ++i) pattern[i] = ranksOfTile()[i] < points ? 1 : 0;
        // Points taken at random have M(1 - M/N)N/(N - 1) at all frequencies. Blue noise
        // begins where there are as many periods as points in a row, √M.
        const double white = points * (1 - 1.0 / part) * kArea / (kArea - 1.0);
        const double begins = std::min(std::sqrt(double(points)), kSide / 2.0);
        const double low = powerWithin(pattern, 0, begins / 2) / white;
        printf("1/%u of the ranks: %.4f of white noise's power below half of the main frequency\n",
               part, low);
        // Void-and-cluster leaves some tenth of it; half a dozen frequencies of few points vary.
        EXPECT_LT(low, part == 8 ? 0.1 : 0.15) << part;
        // What is missing there is elsewhere (Parseval): the tile is not empty or even.
        EXPECT_GT(powerWithin(pattern, begins / 2, kSide) / white, 1) << part;
    }
}

TEST(SurfelInterleave, ALevelsRanksAreAPermutationInEachNeighbourhood) {
    const uint32_t levels = gpu::kSurfelMostLevels;
    const std::vector<uint32_t> tables = interleaveTables(levels);
    ASSERT_EQ(tables.size(), size_t(2) * levels * kArea);
    for (uint32_t level = 0; level < levels; ++level) {
        const uint32_t* ranks = &tables[size_t(2 * level) * kArea];
        const uint32_t across = 1u << level;
        for (uint32_t y0 = 0; y0 < kSide; y0 += across)
            for (uint32_t x0 = 0; x0 < kSide; x0 += across) {
                std::vector<uint32_t> here;
                for (uint32_t i = 0; i < across * across; ++i)
                    here.push_back(ranks[(y0 + i / across) * kSide + x0 + i % across]);
                expectPermutation(here);
            }
    }
}

TEST(SurfelInterleave, OffsetsAreTheInverseOfRanks) {
    const uint32_t levels = gpu::kSurfelMostLevels;
    const std::vector<uint32_t> tables = interleaveTables(levels);
    for (uint32_t level = 0; level < levels; ++level) {
        const uint32_t* ranks = &tables[size_t(2 * level) * kArea];
        const uint32_t* offsets = ranks + kArea;
        const uint32_t across = 1u << level, cells = kSide / across;
        size_t wrong = 0;
        for (uint32_t y = 0; y < kSide; ++y)
            for (uint32_t x = 0; x < kSide; ++x) {
                const uint32_t cell = y / across * cells + x / across;
                const uint32_t offset = offsets[cell * across * across + ranks[y * kSide + x]];
                wrong += offset != (x % across | y % across << 8);
            }
        EXPECT_EQ(wrong, 0u) << "level " << level;
    }
}

TEST(SurfelInterleave, RanksInANeighbourhoodAreInTheTilesOrder) {
    // So a level's lowest sub-buffers together are as blue as the tile.
    const std::vector<uint32_t> tables = interleaveTables(4);
    const uint32_t* ranks = &tables[size_t(2 * 3) * kArea];
    for (uint32_t y = 0; y < kSide; ++y)
        for (uint32_t x = 0; x + 1 < kSide; ++x) {
            if (x / 8 != (x + 1) / 8) continue;
            const size_t at = y * kSide + x;
            EXPECT_EQ(ranks[at] < ranks[at + 1], ranksOfTile()[at] < ranksOfTile()[at + 1]);
        }
}

} // namespace
} // namespace tyndall::test
