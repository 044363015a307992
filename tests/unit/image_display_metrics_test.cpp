// PSNR, SSIM and FLIP against numbers that other people's programs give. Where each is from stands beside it. The pictures are
// made by whole-number rules, so that another program can make them to the last bit.

#include "core/display_metrics.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "core/tone_curve.h"
#include "support/images.h"

namespace tyndall {
namespace {

using Rgb = std::array<int, 3>;
using Rule = Rgb (*)(int x, int y);

Image fromBytes(int width, int height, Rule rule) {
    Image image(width, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Rgb rgb = rule(x, y);
            for (int c = 0; c < 3; ++c) image.at(x, y)[c] = float(rgb[size_t(c)]) / 255.0f;
        }
    return image;
}

/// A ramp that wraps around, a disk, a plain field.
Rgb referenceRule(int x, int y) {
    if ((x - 20) * (x - 20) + (y - 24) * (y - 24) < 100) return {30, 180, 90};
    return {x < 40 ? (5 * x + 40) % 256 : 200, 2 * y + 60, (3 * x + 4 * y) % 256};
}

/// The same under grey noise, with a red square and a black line.
Rgb testRule(int x, int y) {
    if (y == 40) return {0, 0, 0};
    if (x >= 44 && x < 56 && y >= 10 && y < 20) return {255, 40, 20};
    const int noise = (x * 1103 + y * 7919) % 41 - 20;
    Rgb rgb = referenceRule(x, y);
    for (int& value : rgb) value = std::clamp(value + noise, 0, 255);
    return rgb;
}

/// Squares in two greys.
template <int side> Rgb checkered(int x, int y) {
    const int v = (x / side + y / side) % 2 ? 148 : 108;
    return {v, v, v};
}

Image referencePicture() { return fromBytes(64, 48, referenceRule); }
Image testPicture() { return fromBytes(64, 48, testRule); }

Image uniform(float r, float g, float b) { return test::uniformImage(24, 24, r, g, b); }

// scikit-image 0.19.3 (Debian 0.19.3-8): peak_signal_noise_ratio(reference, test) of the 8-bit pictures.
TEST(Psnr, EqualsScikitImage) {
    EXPECT_NEAR(psnr(testPicture(), referencePicture()), 17.505679869697328, 1e-5);
}

TEST(Psnr, OfAConstantOffsetIsItsSizeInDecibels) {
    // 0.75 against 0.5 (exact in floats): the mean square is 1/16.
    EXPECT_NEAR(psnr(uniform(0.75f, 0.75f, 0.75f), uniform(0.5f, 0.5f, 0.5f)),
                10 * std::log10(16.0), 1e-12);
    EXPECT_TRUE(std::isinf(psnr(testPicture(), testPicture())));
}

// scikit-image 0.19.3 (Debian 0.19.3-8), luma = (picture / 255.0) @ [0.2126, 0.7152, 0.0722] in double:
// structural_similarity(lumaReference, lumaTest, gaussian_weights=True, sigma=1.5, use_sample_covariance=False, data_range=1.0)
TEST(Ssim, EqualsScikitImage) {
    EXPECT_NEAR(ssim(testPicture(), referencePicture()), 0.3438682060624056, 1e-6)
        << "pixels are floats here: 6e-8 each";
}

TEST(Ssim, OfConstantPicturesIsTheLuminanceTermAlone) {
    // Equation 13 without variances: (2ab + C1)/(a² + b² + C1), C1 = 1e-4.
    const double a = 0.25, b = 0.5;
    EXPECT_NEAR(ssim(uniform(0.25f, 0.25f, 0.25f), uniform(0.5f, 0.5f, 0.5f)),
                (2 * a * b + 1e-4) / (a * a + b * b + 1e-4), 1e-9);
    EXPECT_NEAR(ssim(testPicture(), testPicture()), 1.0, 1e-12);
}

TEST(Ssim, IsSymmetricAndFallsBelowZeroForANegative) {
    EXPECT_NEAR(ssim(testPicture(), referencePicture()), ssim(referencePicture(), testPicture()),
                1e-12);
    // Deviations from the mean with their signs turned: the covariance is the variance, negated.
    const Image picture = fromBytes(32, 32, checkered<1>),
                negative = fromBytes(32, 32, [](int x, int y) { return checkered<1>(x + 1, y); });
    EXPECT_LT(ssim(negative, picture), -0.5);
}

// The authors' own Python implementation of LDR-FLIP (NVlabs/flip at 313517b4, python/flip_api.py, compute_ldrflip with 67 pixels
// per degree; numpy 1.24.2, OpenCV 4.6.0) on these pictures. It works in single precision, which costs it up to 1e-5.
TEST(Flip, EqualsTheAuthorsImplementationOnAPicture) {
    const Image map = flipMap(testPicture(), referencePicture());
    double sum = 0;
    for (float value : map.pixels) sum += double(value);
    EXPECT_NEAR(sum / double(map.pixels.size()), 0.18232236063886376, 2e-5);
    EXPECT_NEAR(flip(testPicture(), referencePicture()), 0.18232236063886376, 2e-5);
    const struct {
        int x, y;
        double expected;
    } pixels[] = {{20, 24, 0.09371724}, {50, 15, 0.8235523}, {10, 40, 0.42733583},
                  {44, 10, 0.3487027},  {0, 0, 0.21650423},  {63, 47, 0.22675623}};
    for (const auto& p : pixels)
        EXPECT_NEAR(double(*map.at(p.x, p.y)), p.expected, 1e-4) << p.x << ", " << p.y;
}

TEST(Flip, EqualsTheAuthorsImplementationOnUniformColours) {
    const struct {
        Image test, reference;
        double expected;
    } cases[] = {{uniform(0, 0, 0), uniform(1, 1, 1), 0.96738404},
                 {uniform(0.6f, 0.5f, 0.5f), uniform(0.5f, 0.5f, 0.5f), 0.24961114},
                 {uniform(0, 1, 0), uniform(1, 0, 0), 0.9866635},
                 {uniform(0.2f, 0.41f, 0.6f), uniform(0.2f, 0.4f, 0.6f), 0.07649112}};
    for (const auto& c : cases) EXPECT_NEAR(flip(c.test, c.reference), c.expected, 1e-5);
}

TEST(Flip, EqualsTheAuthorsImplementationOnALineAndAShiftedEdge) {
    const Image black(40, 40, 3);
    const Image line = fromBytes(40, 40, [](int x, int) {
        return x == 20 ? Rgb{255, 255, 255} : Rgb{};
    });
    const Image map = flipMap(line, black);
    EXPECT_NEAR(flip(line, black), 0.13202186380221975, 1e-5);
    EXPECT_NEAR(double(*map.at(20, 20)), 0.97574306, 1e-4);
    EXPECT_NEAR(double(*map.at(21, 20)), 0.9707451, 1e-4);
    EXPECT_NEAR(double(*map.at(24, 20)), 0.078326166, 1e-4);
    EXPECT_EQ(*map.at(0, 20), 0.0f);
    // Half grey right of the middle, and one column earlier. (128/255 would not be the 0.5 of the authors' run.)
    Image edge(40, 40, 3), shifted(40, 40, 3);
    for (int y = 0; y < 40; ++y)
        for (int x = 19; x < 40; ++x)
            for (int c = 0; c < 3; ++c) {
                shifted.at(x, y)[c] = 0.5f;
                if (x >= 20) edge.at(x, y)[c] = 0.5f;
            }
    EXPECT_NEAR(flip(shifted, edge), 0.04576111928981845, 1e-5);
    EXPECT_NEAR(double(*flipMap(shifted, edge).at(19, 20)), 0.37568727, 1e-4);
}

// From the paper's constants alone: uniform pictures have no features and pass the filters unchanged, so that the error is that
// of section 4.1.3 for L* = 100 apart, where green and blue are the farthest that there is (error 1).
TEST(Flip, OfBlackAndWhiteFollowsFromThePapersConstants) {
    // Green (L 87.73, a -86.18, b 83.18) and blue (L 32.30, a 79.19, b -107.86) in CIELAB as tables of sRGB's primaries under D65
    // give them, their a and b times L/100.
    const double distance = (87.73 - 32.30) + std::hypot(0.8773 * -86.18 - 0.3230 * 79.19,
                                                         0.8773 * 83.18 + 0.3230 * 107.86);
    const double largest = std::pow(distance, 0.7), knee = 0.4 * largest;
    const double expected = 0.95 + 0.05 * (std::pow(100.0, 0.7) - knee) / (largest - knee);
    EXPECT_NEAR(flip(uniform(1, 1, 1), uniform(0, 0, 0)), expected, 1e-4)
        << "the tables have two digits behind the point";
    EXPECT_NEAR(flip(uniform(0, 0, 1), uniform(0, 1, 0)), 1.0, 1e-6);
}

TEST(Flip, IsZeroForEqualPicturesAndSymmetric) {
    EXPECT_EQ(flip(testPicture(), testPicture()), 0.0);
    EXPECT_NEAR(flip(testPicture(), referencePicture()), flip(referencePicture(), testPicture()),
                1e-9);
}

// As above by the authors' implementation, on squares of four pixels, at three distances.
TEST(Flip, SeesLessOfFineDetailFromFartherAwayAsTheAuthorsImplementationDoes) {
    const Image grey = fromBytes(64, 64, [](int, int) { return Rgb{128, 128, 128}; });
    const Image squares = fromBytes(64, 64, checkered<4>);
    EXPECT_NEAR(flip(squares, grey, 33.5), 0.30619898, 2e-5);
    EXPECT_NEAR(flip(squares, grey, 67), 0.15235439, 2e-5);
    EXPECT_NEAR(flip(squares, grey, 134), 0.054663517, 2e-5);
}

} // namespace
} // namespace tyndall
