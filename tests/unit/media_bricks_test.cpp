#include "media/brick_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "media/sparse_voxels.h"
#include "media_dense_field.h"
#include "support/content.h"

namespace tyndall {
namespace {

using test::DenseField;
using test::Draw;

BrickGrid bricksOf(const DenseField& field) {
    return makeBrickGrid(field.voxels, field.first, field.size, dmat4(1));
}

DenseField randomField(Draw& draw, ivec3 first, ivec3 size, double emptyShare) {
    DenseField field(first, size);
    for (float& voxel : field.voxels)
        voxel = draw.uniform() < emptyShare ? 0.0f : float(draw.uniform(0, 10));
    return field;
}

/// Minimum and maximum of the field's voxels in the closed box.
std::pair<double, double> voxelRange(const DenseField& field, ivec3 low, ivec3 high) {
    double minimum = std::numeric_limits<double>::infinity(), maximum = -minimum;
    for (int z = low.z; z <= high.z; ++z)
        for (int y = low.y; y <= high.y; ++y)
            for (int x = low.x; x <= high.x; ++x) {
                minimum = std::min(minimum, field.value(x, y, z));
                maximum = std::max(maximum, field.value(x, y, z));
            }
    return {minimum, maximum};
}

TEST(BrickGrid, SampleEqualsTrilinearOfTheDenseArray) {
    Draw draw(test::seed());
    for (const ivec3 size : {ivec3(1, 1, 1), ivec3(13, 9, 17), ivec3(8, 8, 8), ivec3(3, 40, 2)}) {
        const DenseField field = randomField(draw, {-5, 3, 100}, size, 0.3);
        const BrickGrid grid = bricksOf(field);
        for (int i = 0; i < 4000; ++i) {
            dvec3 p = dvec3(field.first) +
                      dvec3(size) * dvec3(draw.uniform(-0.3, 1.3), draw.uniform(-0.3, 1.3),
                                          draw.uniform(-0.3, 1.3)) -
                      1.0;
            if (i % 4 == 0) p = glm::floor(p); // voxels themselves
            ASSERT_NEAR(grid.sample(p), field.trilinear(p), 1e-11)
                << p.x << " " << p.y << " " << p.z;
        }
    }
}

TEST(BrickGrid, SampleIsZeroOutsideAndForNaN) {
    DenseField field({0, 0, 0}, {4, 4, 4});
    std::fill(field.voxels.begin(), field.voxels.end(), 1.0f);
    const BrickGrid grid = bricksOf(field);
    EXPECT_EQ(grid.sample({-1, 1, 1}), 0);
    EXPECT_DOUBLE_EQ(grid.sample({-0.5, 1, 1}), 0.5) << "the field falls to 0 within one cell";
    EXPECT_EQ(grid.sample({1e300, 1, 1}), 0);
    EXPECT_EQ(grid.sample({std::numeric_limits<double>::quiet_NaN(), 1, 1}), 0);
    EXPECT_EQ(grid.sample({-std::numeric_limits<double>::infinity(), 1, 1}), 0);
}

TEST(BrickGrid, BoundsOfEveryBrickAreThoseOfItsVoxels) {
    Draw draw(test::seed() + 1);
    const DenseField field = randomField(draw, {7, -20, 0}, {30, 25, 19}, 0.5);
    const BrickGrid grid = bricksOf(field);
    double overall = 0;
    for (int z = 0; z < grid.brickCount.z; ++z)
        for (int y = 0; y < grid.brickCount.y; ++y)
            for (int x = 0; x < grid.brickCount.x; ++x) {
                const ivec3 low = grid.origin + kBrickCells * ivec3(x, y, z);
                const auto [minimum, maximum] = voxelRange(field, low, low + kBrickCells);
                EXPECT_EQ(double(grid.brick({x, y, z}).minimum), minimum);
                EXPECT_EQ(double(grid.brick({x, y, z}).maximum), maximum);
                overall = std::max(overall, maximum);
            }
    EXPECT_EQ(double(grid.maximum), overall);
}

TEST(BrickGrid, ConstantBricksStoreNothing) {
    DenseField field({0, 0, 0}, {40, 40, 40});
    std::fill(field.voxels.begin(), field.voxels.end(), 2.5f);
    const BrickGrid grid = bricksOf(field);
    // Samples of brick b are -1+8b … 7+8b: inside 0…39 for b = 1…4 of 0…5.
    EXPECT_EQ(grid.brickCount, ivec3(6));
    EXPECT_EQ(grid.slotCount(), 6u * 6 * 6 - 4 * 4 * 4);
    EXPECT_EQ(grid.brick({2, 2, 2}).slot, Brick::kNoSlot);
    EXPECT_EQ(grid.brick({2, 2, 2}).minimum, 2.5f);
    EXPECT_DOUBLE_EQ(grid.sample({20.3, 20.4, 20.5}), 2.5);
}

TEST(BrickGrid, EmptyBricksStoreNothingAndEmptyGridsAreEmpty) {
    DenseField field({0, 0, 0}, {100, 10, 10});
    const BrickGrid nothing = bricksOf(field);
    EXPECT_TRUE(nothing.bricks.empty());
    EXPECT_TRUE(nothing.indexBounds().empty());
    EXPECT_EQ(nothing.sample({1, 1, 1}), 0);

    field.at({0, 0, 0}) = 1;
    field.at({99, 0, 0}) = 1;
    const BrickGrid two = bricksOf(field);
    EXPECT_EQ(two.slotCount(), 2u) << "one brick at each end, nothing between";
}

TEST(BrickGrid, BoundsHoldTheVoxelsAndOneCellAround) {
    DenseField field({-50, 0, 3}, {60, 20, 20});
    field.at({-17, 4, 9}) = 3;
    field.at({-12, 6, 9}) = 3;
    const BrickGrid grid = bricksOf(field);
    EXPECT_EQ(grid.origin, ivec3(-18, 3, 8)) << "leading zeros are trimmed";
    EXPECT_EQ(grid.brickCount, ivec3(1));
    const Bounds bounds = grid.indexBounds();
    EXPECT_LE(bounds.minimum.x, -18.0);
    EXPECT_GE(bounds.maximum.x, -11.0);
}

TEST(BrickGrid, RefusesWhatIsNoDensity) {
    EXPECT_THROW(makeBrickGrid({1.0f, 2.0f}, {0, 0, 0}, {1, 1, 1}, dmat4(1)), CheckFailure);
    EXPECT_THROW(makeBrickGrid({-1.0f}, {0, 0, 0}, {1, 1, 1}, dmat4(1)), CheckFailure);
    EXPECT_THROW(
        makeBrickGrid({std::numeric_limits<float>::quiet_NaN()}, {0, 0, 0}, {1, 1, 1}, dmat4(1)),
        CheckFailure);
}

TEST(SparseVoxels, BlocksAndTilesEqualTheDenseArray) {
    Draw draw(test::seed() + 2);
    DenseField field({-160, -32, -40}, {320, 200, 200});
    SparseVoxels sparse;
    const auto fill = [&](ivec3 origin, int size, auto valueAt) {
        for (int z = 0; z < size; ++z)
            for (int y = 0; y < size; ++y)
                for (int x = 0; x < size; ++x) field.at(origin + ivec3(x, y, z)) = valueAt(x, y, z);
    };
    for (const ivec3 origin : {ivec3(-8, 8, 16), ivec3(0, 8, 16), ivec3(-8, 0, 24),
                               ivec3(128, 0, 0), ivec3(-160, -32, -40)}) {
        float values[kBlockVoxels];
        for (float& value : values) value = float(draw.uniform(0, 3));
        ASSERT_TRUE(sparse.addBlock(origin, values).ok());
        fill(origin, kBlockSize, [&](int x, int y, int z) { return values[z * 64 + y * 8 + x]; });
    }
    ASSERT_TRUE(sparse.addTile({0, 0, 24}, 8, 1.5f).ok());
    fill({0, 0, 24}, 8, [](int, int, int) { return 1.5f; });
    ASSERT_TRUE(sparse.addTile({0, 32, 32}, 32, 0.25f).ok());
    fill({0, 32, 32}, 32, [](int, int, int) { return 0.25f; });

    const Result<BrickGrid> grid = sparse.build(dmat4(1));
    ASSERT_TRUE(grid.ok());
    for (int i = 0; i < 50000; ++i) {
        const dvec3 p(draw.uniform(-165, 165), draw.uniform(-40, 170), draw.uniform(-45, 165));
        ASSERT_NEAR(grid->sample(p), field.trilinear(p), 1e-12);
    }
    for (int i = 0; i < 20000; ++i) { // about the small things
        const dvec3 p(draw.uniform(-12, 40), draw.uniform(-2, 70), draw.uniform(12, 70));
        ASSERT_NEAR(grid->sample(p), field.trilinear(p), 1e-12);
    }
    EXPECT_EQ(grid->minimum, 0.0f);
}

TEST(SparseVoxels, AHugeTileCostsNoSamplesInside) {
    SparseVoxels sparse;
    ASSERT_TRUE(sparse.addTile({0, 0, 0}, 512, 1.0f).ok());
    const Result<BrickGrid> grid = sparse.build(dmat4(1));
    ASSERT_TRUE(grid.ok());
    EXPECT_EQ(grid->brickCount, ivec3(65)); // cells -1 … 511
    EXPECT_EQ(grid->slotCount(), 65u * 65 * 65 - 63 * 63 * 63) << "only the rim varies";
    EXPECT_DOUBLE_EQ(grid->sample({255.5, 100.25, 511}), 1.0);
    EXPECT_DOUBLE_EQ(grid->sample({255.5, 100.25, 511.75}), 0.25);
}

TEST(SparseVoxels, FarApartVoxelsAreRefusedInsteadOfFillingMemory) {
    float values[kBlockVoxels] = {1.0f};
    SparseVoxels sparse;
    ASSERT_TRUE(sparse.addBlock({-100000000, 0, 0}, values).ok());
    ASSERT_TRUE(sparse.addBlock({100000000, 100000000, 100000000}, values).ok());
    const Result<BrickGrid> grid = sparse.build(dmat4(1));
    ASSERT_FALSE(grid.ok());
    EXPECT_NE(grid.message().find("200000001×100000001×100000001"), std::string::npos)
        << grid.message();

    GridLimits tight;
    tight.sampleBytes = 3 * kBrickSampleCount * sizeof(float);
    SparseVoxels many(tight);
    for (int i = 0; i < 4; ++i) ASSERT_TRUE(many.addBlock({32 * i, 0, 0}, values).ok());
    EXPECT_FALSE(many.build(dmat4(1)).ok());
}

TEST(SparseVoxels, RefusesBlocksThatMakeNoSense) {
    float values[kBlockVoxels] = {1.0f};
    SparseVoxels sparse;
    EXPECT_FALSE(sparse.addBlock({1, 0, 0}, values).ok()) << "no multiple of 8";
    EXPECT_FALSE(sparse.addBlock({std::numeric_limits<int>::min(), 0, 0}, values).ok())
        << "too far out";
    ASSERT_TRUE(sparse.addBlock({0, 0, 0}, values).ok());
    EXPECT_FALSE(sparse.addBlock({0, 0, 0}, values).ok()) << "given twice";
    EXPECT_FALSE(sparse.addTile({0, 0, 0}, 12, 1).ok()) << "no power of two";
    EXPECT_FALSE(sparse.addTile({8, 0, 0}, 16, 1).ok()) << "not aligned";
    EXPECT_FALSE(sparse.addTile({0, 0, 0}, -8, 1).ok());
}

TEST(SparseVoxels, RepairsAndCountsWhatIsNoDensity) {
    using Limits = std::numeric_limits<float>;
    float values[kBlockVoxels] = {1.0f,
                                  Limits::quiet_NaN(),
                                  Limits::infinity(),
                                  -Limits::infinity(),
                                  -1.0f,
                                  1e38f,
                                  Limits::denorm_min(),
                                  -0.0f};
    SparseVoxels sparse;
    ASSERT_TRUE(sparse.addBlock({0, 0, 0}, values).ok());
    ASSERT_TRUE(sparse.addTile({8, 0, 0}, 8, -3.0f).ok());
    EXPECT_EQ(sparse.repairs().nonFinite, 3u);
    EXPECT_EQ(sparse.repairs().negative, 1u + 512u);
    EXPECT_EQ(sparse.repairs().huge, 1u);
    const Result<BrickGrid> grid = sparse.build(dmat4(1));
    ASSERT_TRUE(grid.ok());
    const double expected[] = {1, 0, 0, 0, 0, double(kMaximumVoxel), 0, 0};
    for (int x = 0; x < 8; ++x) EXPECT_EQ(grid->sample({x, 0, 0}), expected[x]) << x;
    EXPECT_EQ(grid->minimum, 0.0f);
}

} // namespace
} // namespace tyndall
