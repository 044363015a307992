// The atlas of grids after any sequence of changes: what shaders find there, what it cost to bring it there, what it takes.
#include "renderer/media_atlas.h"

#include <algorithm>
#include <cstring>
#include <random>

#include "gl/buffer.h"
#include "gl/gl_fixture.h"
#include "gl/read_back.h"
#include "gl/shader_library.h"
#include "support/content.h"

namespace tyndall {
namespace {

using Grid = std::shared_ptr<const BrickGrid>;

class MediaAtlasTest : public test::GlTest {
protected:
    void SetUp() override {
        GlTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        library = std::make_unique<gl::ShaderLibrary>();
        executor = std::make_unique<fg::Executor>(*library);
        atlas = std::make_unique<MediaAtlas>(*executor);
        random.seed(uint32_t(test::seed()));
    }
    void TearDown() override {
        atlas.reset();
        executor.reset();
        library.reset();
        GlTest::TearDown();
    }

    int integer(int low, int high) { return low + int(random() % uint32_t(high - low + 1)); }

    /// Random voxels; every other 8³ block along x is 0, so that some bricks are constant and have no samples.
    Grid makeGrid(const ivec3& size) {
        std::vector<float> voxels(size_t(size.x) * size_t(size.y) * size_t(size.z));
        for (size_t i = 0; i < voxels.size(); ++i)
            voxels[i] = int(i) % size.x % 32 < 16 ? float(1 + random() % 1000) : 0.0f;
        return std::make_shared<BrickGrid>(makeBrickGrid(voxels, ivec3(0), size, dmat4(1)));
    }
    Grid makeGrid() { return makeGrid({integer(1, 60), integer(1, 20), integer(1, 20)}); }

    /// As a shader finds it: the grid's table from its first brick on, and the 9³ texels that each brick points to.
    void expectHolds(MediaAtlas& held, const BrickGrid& grid) {
        const gl::Texture& texture = executor->texture(held.texture());
        const std::vector<float> texels = gl::readFloats(texture);
        const auto table = executor->buffer(held.bricks()).readAll<gpu::BrickData>();
        const uint32_t first = held.firstBrick(grid);
        ASSERT_LE(first + grid.bricks.size(), table.size());
        const size_t row = size_t(texture.spec().width),
                     slice = row * size_t(texture.spec().height);
        for (size_t i = 0; i < grid.bricks.size(); ++i) {
            const Brick& brick = grid.bricks[i];
            const gpu::BrickData& data = table[first + i];
            ASSERT_EQ(data.minimum, brick.minimum);
            ASSERT_EQ(data.maximum, brick.maximum);
            ASSERT_EQ(data.slot == gpu::kNoSlot, brick.slot == Brick::kNoSlot);
            if (data.slot == gpu::kNoSlot) continue;
            const size_t x = data.slot & 1023u, y = data.slot >> 10 & 1023u, z = data.slot >> 20;
            const float* samples = grid.samples.data() + size_t(brick.slot) * kBrickSampleCount;
            for (size_t k = 0; k < kBrickSamples; ++k)
                for (size_t j = 0; j < kBrickSamples; ++j)
                    ASSERT_EQ(
                        std::memcmp(&texels[(kBrickSamples * z + k) * slice +
                                            (kBrickSamples * y + j) * row + kBrickSamples * x],
                                    samples + (k * kBrickSamples + j) * kBrickSamples,
                                    kBrickSamples * sizeof(float)),
                        0);
        }
    }

    /// Of the samples and of the table.
    static uint64_t sampleBytes(const Grid& grid) { return grid->samples.size() * sizeof(float); }
    static uint64_t tableBytes(const Grid& grid) {
        return grid->bricks.size() * sizeof(gpu::BrickData);
    }
    static uint64_t slots(const std::vector<Grid>& grids) {
        uint64_t sum = 0;
        for (const Grid& grid : grids) sum += grid->slotCount();
        return sum;
    }

    std::unique_ptr<gl::ShaderLibrary> library;
    std::unique_ptr<fg::Executor> executor;
    std::unique_ptr<MediaAtlas> atlas;
    std::mt19937 random;
};
TYNDALL_GL_TESTS(MediaAtlasTest);

TEST_P(MediaAtlasTest, AGridThatIsSwappedForOneOfItsSizeIsAllThatIsUploaded) {
    const ivec3 size(40, 12, 20);
    std::vector<Grid> grids;
    for (int i = 0; i < 10; ++i) grids.push_back(makeGrid(size));
    ASSERT_TRUE(atlas->update(grids).ok());
    const uint64_t capacity = atlas->slotCapacity(), tables = atlas->brickBytes();
    const uint32_t texture = atlas->texture().id, bricks = atlas->bricks().id;
    for (int swap = 0; swap < 100; ++swap) {
        const auto before = atlas->uploaded();
        const Version version = atlas->version();
        std::vector<uint32_t> places;
        for (const Grid& grid : grids) places.push_back(atlas->firstBrick(*grid));
        const size_t changed = size_t(integer(0, 9));
        grids[changed] = makeGrid(size);
        ASSERT_TRUE(atlas->update(grids).ok());
        EXPECT_EQ(atlas->uploaded().samples - before.samples, sampleBytes(grids[changed]));
        EXPECT_EQ(atlas->uploaded().tables - before.tables, tableBytes(grids[changed]));
        EXPECT_NE(atlas->version(), version);
        for (size_t i = 0; i < grids.size(); ++i)
            EXPECT_EQ(atlas->firstBrick(*grids[i]), places[i]) << "also where the old one was";
    }
    EXPECT_EQ(atlas->slotCapacity(), capacity);
    EXPECT_EQ(atlas->brickBytes(), tables);
    EXPECT_EQ(atlas->texture().id, texture);
    EXPECT_EQ(atlas->bricks().id, bricks);
    for (const Grid& grid : grids) expectHolds(*atlas, *grid);
}

TEST_P(MediaAtlasTest, SwapsOfAnySizesUploadTheSamplesOfTheNewGridAndTakeNoMoreThanFits) {
    std::vector<Grid> grids;
    for (int i = 0; i < 10; ++i) grids.push_back(makeGrid());
    ASSERT_TRUE(atlas->update(grids).ok());
    uint64_t most = slots(grids), mostTables = atlas->brickBytes();
    for (int swap = 0; swap < 100; ++swap) {
        const auto before = atlas->uploaded();
        const size_t changed = size_t(integer(0, 9));
        grids[changed] = makeGrid();
        ASSERT_TRUE(atlas->update(grids).ok());
        EXPECT_EQ(atlas->uploaded().samples - before.samples, sampleBytes(grids[changed]));
        most = std::max(most, slots(grids));
        uint64_t tables = 0;
        for (const Grid& grid : grids) tables += tableBytes(grid);
        mostTables = std::max(mostTables, tables);
        // Where the free pieces are too small, all tables once more.
        EXPECT_LE(atlas->uploaded().tables - before.tables,
                  std::max(tableBytes(grids[changed]), atlas->brickBytes()));
        if (swap % 10 == 9)
            for (const Grid& grid : grids) expectHolds(*atlas, *grid);
    }
    // A quarter of headroom. A texture of n slots has layers of less than (∛n + 1)² slots, the last of them perhaps all but empty.
    const double wanted = 1.25 * double(most), layer = std::cbrt(wanted) + 1;
    EXPECT_LE(double(atlas->slotCapacity()), wanted + layer * layer);
    EXPECT_LE(double(atlas->brickBytes()), 1.25 * double(mostTables));
}

TEST_P(MediaAtlasTest, ChangesLeadToWhatAFreshUploadHas) {
    std::vector<Grid> grids;
    for (int step = 0; step < 40; ++step) {
        const int what = integer(0, 2);
        if (what == 0 || grids.empty())
            grids.push_back(makeGrid());
        else if (what == 1)
            grids.erase(grids.begin() + integer(0, int(grids.size()) - 1));
        else
            grids[size_t(integer(0, int(grids.size()) - 1))] = makeGrid();
        ASSERT_TRUE(atlas->update(grids).ok());
    }
    MediaAtlas fresh(*executor);
    ASSERT_TRUE(fresh.update(grids).ok());
    for (const Grid& grid : grids) {
        expectHolds(*atlas, *grid);
        expectHolds(fresh, *grid);
    }
}

TEST_P(MediaAtlasTest, TheSameGridsInAnotherOrderOrTwiceAreNotUploaded) {
    std::vector<Grid> grids{makeGrid(), makeGrid(), makeGrid()};
    ASSERT_TRUE(atlas->update(grids).ok());
    const auto before = atlas->uploaded();
    EXPECT_EQ(before.samples,
              sampleBytes(grids[0]) + sampleBytes(grids[1]) + sampleBytes(grids[2]));
    const Version version = atlas->version();
    std::swap(grids[0], grids[2]);
    grids.push_back(grids[1]);
    ASSERT_TRUE(atlas->update(grids).ok());
    EXPECT_EQ(atlas->uploaded().samples, before.samples);
    EXPECT_EQ(atlas->uploaded().tables, before.tables);
    EXPECT_EQ(atlas->version(), version);
}

TEST_P(MediaAtlasTest, WhatALargeGridTookIsGivenBackWhenOnlySmallOnesStay) {
    const Grid small = makeGrid({8, 8, 8}), large = makeGrid({90, 60, 60});
    ASSERT_TRUE(atlas->update(std::vector<Grid>{small, large}).ok());
    const auto before = atlas->uploaded();
    ASSERT_TRUE(atlas->update(std::vector<Grid>{small}).ok());
    EXPECT_EQ(atlas->uploaded().samples, before.samples) << "what stays is copied on the GPU";
    MediaAtlas fresh(*executor);
    ASSERT_TRUE(fresh.update(std::vector<Grid>{small}).ok());
    EXPECT_EQ(atlas->slotCapacity(), fresh.slotCapacity());
    EXPECT_LE(atlas->brickBytes(), fresh.brickBytes() + fresh.brickBytes() / 4);
    expectHolds(*atlas, *small);
    ASSERT_TRUE(atlas->update(std::vector<Grid>{}).ok());
    EXPECT_THROW((void)atlas->firstBrick(*small), CheckFailure);
    ASSERT_TRUE(atlas->update(std::vector<Grid>{large, small}).ok());
    expectHolds(*atlas, *large);
    expectHolds(*atlas, *small);
}

} // namespace
} // namespace tyndall
