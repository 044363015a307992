#include "core/image_metrics.h"

#include <cmath>

#include <gtest/gtest.h>

#include "support/images.h"

namespace tyndall {
namespace {

Image constant(float r, float g, float b) { return test::uniformImage(4, 2, r, g, b); }

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

/// One value everywhere but in the first pixel.
Image withOnePixel(int width, int height, float value, float first) {
    Image image(width, height, 3);
    for (float& pixel : image.pixels) pixel = value;
    for (int c = 0; c < 3; ++c) image.pixels[size_t(c)] = first;
    return image;
}

TEST(ImageMetrics, MrseAndSmapeHaveTheValuesWorkedOutByHand) {
    // r = (1,2,3): mean luminance 0.2126 + 2·0.7152 + 3·0.0722 = 1.8596, m = 2; v = (2,2,1).
    const ImageMetrics metrics = compareImages(constant(2, 2, 1), constant(1, 2, 3)).value();
    const double s = 0.5 / 1.8596;
    EXPECT_NEAR(metrics.mrse,
                (std::pow(s / (s + 0.01), 2) + 0 + std::pow(2 * s / (3 * s + 0.01), 2)) / 3, 1e-9);
    EXPECT_NEAR(metrics.smape, (2 * 1 / 3.02 + 0 + 2 * 2 / 4.02) / 3, 1e-12);
    // A third of all values have the error 1/(1+0.2), a third 0, a third 2/(3+0.2): the largest is the percentile.
    EXPECT_NEAR(metrics.p999, 1 / 1.2, 1e-12);
}

TEST(ImageMetrics, AllRelativeErrorsAreIndependentOfTheScale) {
    const float scale = 1.0f / 4096; // a power of two: exact
    const ImageMetrics one = compareImages(constant(2, 2, 1), constant(1, 2, 3)).value();
    const ImageMetrics other =
        compareImages(constant(2 * scale, 2 * scale, scale), constant(scale, 2 * scale, 3 * scale))
            .value();
    EXPECT_NEAR(other.mrse, one.mrse, 1e-12);
    EXPECT_NEAR(other.smape, one.smape, 1e-12);
    EXPECT_NEAR(other.p999, one.p999, 1e-12);
    EXPECT_NEAR(other.relmseTrimmed, one.relmseTrimmed, 1e-12);
}

TEST(ImageMetrics, ATrimmedMeanForgetsOneFireflyAndNoMore) {
    // 1000 pixels: one may be forgotten. All are off by 0.1, the first by 99.
    const Image reference = withOnePixel(50, 20, 1, 1), image = withOnePixel(50, 20, 1.1f, 100);
    const double small = std::pow(double(1.1f) - 1, 2) / 1.01, large = 99.0 * 99 / 1.01;
    const ImageMetrics metrics = compareImages(image, reference).value();
    EXPECT_NEAR(metrics.relmse, 0.999 * small + 0.001 * large, 1e-9);
    EXPECT_NEAR(metrics.relmseTrimmed, small, 1e-12);
    Image two = image;
    for (int c = 0; c < 3; ++c) two.at(49, 19)[c] = 100;
    EXPECT_NEAR(compareImages(two, reference)->relmseTrimmed, (998 * small + large) / 999, 1e-9);
    // 999 pixels: a thousandth of them is less than one, and nothing is forgotten.
    const ImageMetrics few =
        compareImages(withOnePixel(37, 27, 1.1f, 100), withOnePixel(37, 27, 1, 1)).value();
    EXPECT_NEAR(few.relmseTrimmed, few.relmse, 1e-9) << "summed in another order";
}

TEST(ImageMetrics, SmapeIsAtMostTwo) {
    // Light against black: 2v/(v+0) = 2 in every value, as m is 0. Black against light: 2r/(r+0.01·r).
    EXPECT_NEAR(compareImages(constant(5, 5, 5), constant(0, 0, 0))->smape, 2, 1e-12);
    EXPECT_NEAR(compareImages(constant(0, 0, 0), constant(5, 5, 5))->smape, 2 / 1.01, 1e-12);
}

TEST(ImageMetrics, P999IsTheNearestRankOfAllValues) {
    // 2000 values 1 … 2000 thousandths too bright; rank 1998 has the error 1.998/(1+0.1).
    Image reference(2000, 1, 1), image(2000, 1, 1);
    for (int i = 0; i < 2000; ++i) {
        *reference.at(i, 0) = 1;
        *image.at((i * 7) % 2000, 0) = 1 + float(i + 1) / 1000; // 7 and 2000 share no factor
    }
    EXPECT_NEAR(compareImages(image, reference)->p999, 1.998 / 1.1, 1e-6);
}

TEST(ImageMetrics, IdenticalImagesHaveNoErrorAtAll) {
    const Image image = withOnePixel(50, 40, 0.25f, 7);
    const ImageMetrics metrics = compareImages(image, image).value();
    for (double error : {metrics.rmse, metrics.relmse, metrics.relmseTrimmed, metrics.mrse,
                         metrics.smape, metrics.p999, metrics.largestDifference})
        EXPECT_EQ(error, 0);
    EXPECT_EQ(metrics.energy, 1);
}

TEST(ImageMetrics, BlackReferencesGiveZeroOrInfinity) {
    const ImageMetrics black = compareImages(constant(0, 0, 0), constant(0, 0, 0)).value();
    for (double error : {black.mrse, black.smape, black.p999, black.relmseTrimmed})
        EXPECT_EQ(error, 0);
    const ImageMetrics leak = compareImages(constant(0, 1, 0), constant(0, 0, 0)).value();
    EXPECT_TRUE(std::isinf(leak.mrse) && std::isinf(leak.p999) && std::isinf(leak.relmseTrimmed));
}

TEST(ImageMetrics, NonFiniteValuesMakeEveryMetricNoNumber) {
    Image image = constant(1, 1, 1);
    image.pixels[5] = INFINITY;
    const ImageMetrics metrics = compareImages(image, constant(1, 1, 1)).value();
    for (double value : {metrics.rmse, metrics.relmse, metrics.relmseTrimmed, metrics.mrse,
                         metrics.smape, metrics.p999, metrics.energy, metrics.energyPerChannel[1]})
        EXPECT_TRUE(std::isnan(value));
    EXPECT_TRUE(std::isnan(compareImages(constant(1, 1, 1), image)->smape));
}

TEST(ReferenceFloor, IsTheVarianceOverWhatRelmseDividesBy) {
    // r = (1,2,3), m = 2; variances (0.1, 0.2, 0).
    EXPECT_NEAR(referenceFloor(constant(1, 2, 3), constant(0.1f, 0.2f, 0)).value(),
                (double(0.1f) / 1.04 + double(0.2f) / 4.04) / 3, 1e-12);
    EXPECT_EQ(referenceFloor(constant(0, 0, 0), constant(0, 0, 0)).value(), 0);
}

TEST(ReferenceFloor, IsTheRelmseOfTheTruthAgainstNoiseOfThatVariance) {
    // The reference is the truth plus noise of ±0.125 in turn, whose variance is 1/64.
    Image truth = withOnePixel(64, 64, 1, 1), reference = truth, variance = truth;
    for (size_t i = 0; i < truth.pixels.size(); ++i) {
        reference.pixels[i] += i % 2 ? 0.125f : -0.125f;
        variance.pixels[i] = 1.0f / 64;
    }
    EXPECT_NEAR(referenceFloor(reference, variance).value(),
                compareImages(truth, reference)->relmse, 1e-12);
}

TEST(ReferenceFloor, RefusesWhatIsNoVariance) {
    EXPECT_FALSE(referenceFloor(constant(1, 1, 1), constant(-1, 0, 0)).ok());
    EXPECT_FALSE(referenceFloor(constant(1, 1, 1), constant(NAN, 0, 0)).ok());
    EXPECT_FALSE(referenceFloor(constant(1, 1, 1), Image(4, 2, 1)).ok());
}

} // namespace
} // namespace tyndall
