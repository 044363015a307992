// What is prepared on the CPU for surfaces: vertices, alpha cutoffs, culling, the order of blended primitives, environment levels.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "renderer/blend_list.h"
#include "renderer/environment_map.h"
#include "renderer/gpu_scene.h"
#include "renderer/texture_scale.h"
#include "support/content.h"

namespace tyndall {
namespace {

TEST(PackVertices, HoldsWhatTheMeshHasAndNothingElse) {
    Mesh mesh;
    mesh.positions = {{1, 2, 3}, {4, 5, 6}};
    mesh.uvs[2] = {{0.25f, 0.5f}, {0.75f, 1.0f}};
    const PackedVertices packed = packVertices(mesh);
    ASSERT_EQ(packed.layout.strideFloats, 5u);
    ASSERT_EQ(packed.attributes.size(), 2u);
    EXPECT_EQ(packed.attributes[0].location, 0u);
    EXPECT_EQ(packed.attributes[1].location, 5u); // UV set 2
    EXPECT_EQ(packed.attributes[1].offset, 12u);
    EXPECT_EQ(packed.values, (std::vector<float>{1, 2, 3, 0.25f, 0.5f, 4, 5, 6, 0.75f, 1.0f}));
}

TEST(PackVertices, RefusesAttributesOfAnotherLength) {
    Mesh mesh;
    mesh.positions = {{1, 2, 3}, {4, 5, 6}};
    mesh.normals = {{0, 1, 0}};
    EXPECT_THROW(packVertices(mesh), CheckFailure);
}

/// Half black, half white is 0.5 of the light: 188 as sRGB (IEC 61966-2-1: 1.055·0.5^(1/2.4) − 0.055 = 0.7354). Alpha is linear.
TEST(ScaledDown, AveragesLightAndNotItsCode) {
    ImageData image;
    image.width = 6;
    image.height = 4;
    for (int i = 0; i < 24; ++i) {
        const uint8_t light = i % 2 ? 255 : 0;
        image.rgba.insert(image.rgba.end(), {light, light, light, uint8_t(255 - light)});
    }
    for (const auto& [space, mean] :
         {std::pair(ColorSpace::Srgb, 188), std::pair(ColorSpace::Linear, 128)}) {
        const ImageData smaller = scaledDown(image, 3, 2, space);
        ASSERT_EQ(smaller.width, 3);
        ASSERT_EQ(smaller.height, 2);
        ASSERT_EQ(smaller.rgba.size(), 24u);
        for (size_t i = 0; i < smaller.rgba.size(); ++i) // one code: 127.5 is rounded either way
            EXPECT_NEAR(smaller.rgba[i], i % 4 == 3 ? 128 : mean, 1) << "byte " << i;
    }
}

TEST(AlphaCutoffs, KeepTheAreaOfThinLeavesInEveryLevel) {
    // Vertical stripes, a quarter of the area: filtered away by a fixed cutoff after a few levels.
    ImageData image;
    image.width = image.height = 64;
    image.rgba.assign(64 * 64 * 4, 255);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            image.rgba[size_t(4 * (y * 64 + x) + 3)] = uint8_t(x % 8 < 2 ? 255 : 0);
    const std::array<float, 16> cutoffs = alphaCutoffs(image, 0.5f);
    EXPECT_FLOAT_EQ(cutoffs[0], 0.5f);
    // Level 1 has one full column in four, level 2 one half-covered column in two, and the levels after it are even.
    EXPECT_GT(cutoffs[1], 0.0f);
    EXPECT_LT(cutoffs[1], 1.0f);
    EXPECT_LE(cutoffs[2], 0.5f);
    EXPECT_LE(cutoffs[3], 0.25f);
    for (int mip = 0; mip < 16; ++mip)
        EXPECT_TRUE(cutoffs[size_t(mip)] > 0 && cutoffs[size_t(mip)] <= 1) << "level " << mip;
}

TEST(AlphaCutoffs, CoverageOfNoiseStaysWithinAPixelInTwoHundred) {
    std::mt19937 random{uint32_t(test::seed())};
    ImageData image;
    image.width = image.height = 128;
    image.rgba.assign(128 * 128 * 4, 255);
    size_t above = 0;
    std::vector<double> level(128 * 128);
    for (size_t i = 0; i < level.size(); ++i) {
        const uint32_t alpha = random() % 256 * (random() % 256) / 255; // mostly low
        image.rgba[4 * i + 3] = uint8_t(alpha);
        level[i] = alpha / 255.0;
        above += level[i] >= 0.6;
    }
    const double coverage = double(above) / double(level.size());
    const std::array<float, 16> cutoffs = alphaCutoffs(image, 0.6f);
    for (int mip = 1, size = 64; size >= 16; ++mip, size /= 2) {
        std::vector<double> next(size_t(size) * size_t(size));
        size_t covered = 0;
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                const auto at = [&](int i, int j) {
                    return level[size_t(2 * y + j) * size_t(2 * size) + size_t(2 * x + i)];
                };
                const double mean = (at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1)) / 4;
                next[size_t(y * size + x)] = mean;
                covered += mean >= double(cutoffs[size_t(mip)]);
            }
        EXPECT_NEAR(double(covered) / double(next.size()), coverage, 0.005)
            << "level " << mip << ", seed " << test::seed();
        level = next;
    }
}

TEST(AlphaCutoffs, OpaqueImagesKeepTheirCutoff) {
    ImageData image;
    image.width = image.height = 8;
    image.rgba.assign(8 * 8 * 4, 255);
    for (const float cutoff : alphaCutoffs(image, 0.25f)) EXPECT_EQ(cutoff, 0.25f);
}

TEST(Culling, NeverDropsABoxThatTouchesTheFrustum) {
    const std::array<vec4, 2> planes = {vec4(1, 0, 0, 0), vec4(0, -1, 0, 2)}; // x ≥ 0, y ≤ 2
    const auto box = [](const dvec3& low, const dvec3& high) {
        Bounds bounds;
        bounds.include(low);
        bounds.include(high);
        return bounds;
    };
    EXPECT_TRUE(mayBeInside(box({1, 0, 0}, {2, 1, 1}), planes));
    EXPECT_TRUE(mayBeInside(box({-5, -5, 0}, {0.001, 1, 1}), planes));
    EXPECT_TRUE(mayBeInside(box({-1, 0, 0}, {0, 1, 1}), planes)); // touches
    EXPECT_FALSE(mayBeInside(box({-3, 0, 0}, {-1, 1, 1}), planes));
    EXPECT_FALSE(mayBeInside(box({1, 3, 0}, {2, 4, 1}), planes));
    EXPECT_FALSE(mayBeInside(Bounds{}, planes));
}

TEST(Culling, RunsJoinInstancesAndStopAtWhatIsCulled) {
    std::vector<DrawItem> items(5);
    for (uint32_t i = 0; i < 5; ++i) {
        items[i].object = i;
        items[i].mesh = i < 4 ? 3 : 4;
        items[i].bounds.include(dvec3(i == 1 ? -10.0 : 1.0));
    }
    const std::array<vec4, 1> planes = {vec4(1, 0, 0, 0)};
    std::vector<std::pair<uint32_t, uint32_t>> runs;
    forEachVisibleRun(std::span<const DrawItem>(items), planes,
                      [&](const DrawRun& run) { runs.emplace_back(run.first->object, run.count); });
    EXPECT_EQ(runs, (std::vector<std::pair<uint32_t, uint32_t>>{{0, 1}, {2, 2}, {4, 1}}));
}

TEST(BlendOrder, IsFarToNearAndStable) {
    std::vector<BlendPrimitive> primitives = {
        {1, 0, 0}, {5, 1, 3}, {5, 1, 0}, {5, 0, 9}, {2, 0, 0}};
    sortBackToFront(primitives);
    std::vector<std::pair<float, uint32_t>> order;
    for (const BlendPrimitive& p : primitives) order.emplace_back(p.depth, p.item * 100 + p.first);
    EXPECT_EQ(order, (std::vector<std::pair<float, uint32_t>>{
                         {5, 9}, {5, 100}, {5, 103}, {2, 0}, {1, 0}}));
}

Environment environmentFrom(int width, int height, uint32_t seed) {
    auto image = std::make_shared<Image>(width, height, 3);
    std::mt19937 random(seed);
    for (float& value : image->pixels) value = float(random() % 1000) / 100.0f;
    Environment environment;
    environment.image = image;
    environment.intensity = 2;
    return environment;
}

/// ∫ L dω of a latitude-longitude image whose pixels are constant.
double fluence(const Image& level) {
    double sum = 0;
    for (int y = 0; y < level.height; ++y)
        for (int x = 0; x < level.width; ++x)
            sum += double(level.at(x, y)[0]) * 2 * kPi / level.width *
                   (std::cos(kPi * y / level.height) - std::cos(kPi * (y + 1) / level.height));
    return sum;
}

TEST(EnvironmentLevels, AllHoldTheSameLight) {
    const EnvironmentLevels made = makeEnvironmentLevels(environmentFrom(64, 32, 5));
    ASSERT_EQ(made.levels.size(), 7u); // 64×32 … 1×1
    EXPECT_FALSE(made.black);
    const double expected = fluence(made.levels.front());
    for (const Image& level : made.levels)
        EXPECT_NEAR(fluence(level), expected, 1e-5 * expected)
            << level.width << "x" << level.height;
}

TEST(EnvironmentLevels, AConstantEnvironmentIsOneTexel) {
    Environment environment;
    environment.radiance = vec3(1, 2, 3);
    const EnvironmentLevels made = makeEnvironmentLevels(environment);
    ASSERT_EQ(made.levels.size(), 1u);
    EXPECT_EQ(made.levels[0].pixels, (std::vector<float>{1, 2, 3}));
    environment.radiance = vec3(0);
    EXPECT_TRUE(makeEnvironmentLevels(environment).black);
}

TEST(EnvironmentLevels, BrokenPixelsAreBlack) {
    auto image = std::make_shared<Image>(2, 1, 3);
    image->pixels = {1, std::nanf(""), 1, 1, -1, 1};
    Environment environment;
    environment.image = image;
    const EnvironmentLevels made = makeEnvironmentLevels(environment);
    EXPECT_TRUE(made.black);
    for (const Image& level : made.levels)
        for (const float value : level.pixels) EXPECT_EQ(value, 0.0f);
}

} // namespace
} // namespace tyndall
