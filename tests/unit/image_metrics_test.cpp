#include "core/image_metrics.h"

#include <cmath>

#include <gtest/gtest.h>

namespace tyndall {
namespace {

Image constant(float r, float g, float b) {
    Image image(4, 2, 3);
    for (size_t i = 0; i < image.pixels.size(); i += 3) {
        image.pixels[i] = r;
        image.pixels[i + 1] = g;
        image.pixels[i + 2] = b;
    }
    return image;
}

TEST(ImageMetrics, ConstantImagesHaveTheValuesWorkedOutByHand) {
    // r = (1,2,3), m = 2, 0.01·m² = 0.04; v = (2,2,1): squares 1, 0, 4.
    const ImageMetrics metrics = compareImages(constant(2, 2, 1), constant(1, 2, 3)).value();
    EXPECT_NEAR(metrics.rmse, std::sqrt(5.0 / 3.0), 1e-12);
    EXPECT_NEAR(metrics.relmse, (1 / 1.04 + 0 + 4 / 9.04) / 3, 1e-12);
    EXPECT_NEAR(metrics.energy, 5.0 / 6.0, 1e-12);
    EXPECT_NEAR(metrics.energyPerChannel[0], 2.0, 1e-12);
    EXPECT_NEAR(metrics.energyPerChannel[1], 1.0, 1e-12);
    EXPECT_NEAR(metrics.energyPerChannel[2], 1.0 / 3.0, 1e-12);
    EXPECT_EQ(metrics.largestDifference, 2.0);
}

TEST(ImageMetrics, RelmseAndEnergyDoNotDependOnTheSceneScale) {
    const ImageMetrics one = compareImages(constant(2, 2, 1), constant(1, 2, 3)).value();
    const float scale = 4096.0f; // a power of two: exact
    const ImageMetrics other =
        compareImages(constant(2 * scale, 2 * scale, scale), constant(scale, 2 * scale, 3 * scale))
            .value();
    EXPECT_NEAR(other.relmse, one.relmse, 1e-12);
    EXPECT_NEAR(other.energy, one.energy, 1e-12);
    EXPECT_NEAR(other.rmse, double(scale) * one.rmse, 1e-9);
}

TEST(ImageMetrics, BlackAgainstBlackIsPerfectAndLightAgainstBlackIsInfinitelyWrong) {
    const ImageMetrics black = compareImages(constant(0, 0, 0), constant(0, 0, 0)).value();
    EXPECT_EQ(black.relmse, 0);
    EXPECT_EQ(black.energy, 1);
    const ImageMetrics leak = compareImages(constant(0, 1, 0), constant(0, 0, 0)).value();
    EXPECT_TRUE(std::isinf(leak.relmse));
    EXPECT_TRUE(std::isinf(leak.energy));
}

TEST(ImageMetrics, NonFiniteAndNegativeValuesAreCountedFirst) {
    Image image = constant(1, 1, 1);
    image.pixels[0] = NAN;
    image.pixels[1] = INFINITY;
    image.pixels[2] = -INFINITY;
    image.pixels[3] = -1;
    image.pixels[4] = -0.0f; // is zero
    const ValueCounts counts = countValues(image);
    EXPECT_EQ(counts.nonFinite, 3u);
    EXPECT_EQ(counts.negative, 2u);
    const ImageMetrics metrics = compareImages(image, constant(1, 1, 1)).value();
    EXPECT_EQ(metrics.image.nonFinite, 3u);
    EXPECT_TRUE(std::isnan(metrics.relmse));
}

TEST(ImageMetrics, ShapesThatDifferAreRefused) {
    EXPECT_FALSE(compareImages(Image(2, 2, 3), Image(2, 3, 3)).ok());
}

} // namespace
} // namespace tyndall
