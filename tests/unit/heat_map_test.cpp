// Maps of errors and their colours.

#include "core/heat_map.h"

#include <cmath>

#include <gtest/gtest.h>

namespace tyndall {
namespace {

/// CIE 1976 lightness of an sRGB colour, from the standards' formulas.
double lightness(const uint8_t* rgb) {
    const double weights[] = {0.2126, 0.7152, 0.0722};
    double y = 0;
    for (int c = 0; c < 3; ++c) {
        const double v = rgb[c] / 255.0;
        y += weights[c] * (v > 0.04045 ? std::pow((v + 0.055) / 1.055, 2.4) : v / 12.92);
    }
    return y > 216.0 / 24389 ? 116 * std::cbrt(y) - 16 : y * 24389 / 27;
}

TEST(ErrorMap, HoldsTheRelativeErrorAndItsSign) {
    // m = 2: |r| + 0.1·m is 1.2 and 3.2.
    Image reference(2, 1, 1), image(2, 1, 1);
    reference.pixels = {1, 3};
    image.pixels = {2, 1};
    const Image magnitude = relativeErrorMap(image, reference);
    EXPECT_NEAR(double(magnitude.pixels[0]), 1 / 1.2, 1e-6);
    EXPECT_NEAR(double(magnitude.pixels[1]), 2 / 3.2, 1e-6);
    const Image sign = signedErrorMap(image, reference);
    EXPECT_NEAR(double(sign.pixels[0]), 1 / 1.2, 1e-6);
    EXPECT_NEAR(double(sign.pixels[1]), -2 / 3.2, 1e-6);
}

TEST(ErrorMap, AveragesChannelsAndMarksWhatIsNotFinite) {
    Image reference(2, 1, 3), image(2, 1, 3);
    reference.pixels = {1, 1, 1, 1, INFINITY, 1};
    image.pixels = {1, 1, 1 + 3.3f, 1, 1, 1};
    const Image map = relativeErrorMap(image, reference);
    EXPECT_NEAR(double(map.pixels[0]), 1.0, 1e-6) << "m is that of the finite values: 3.3/1.1/3";
    EXPECT_TRUE(std::isnan(map.pixels[1]));
    const Image black(2, 1, 3);
    for (float value : relativeErrorMap(black, black).pixels) EXPECT_EQ(value, 0.0f);
}

TEST(HeatMap, LightnessRisesEvenlyWithTheError) {
    Image ramp(101, 1, 1);
    for (int i = 0; i <= 100; ++i) *ramp.at(i, 0) = float(i) / 50;
    const std::vector<uint8_t> bytes = heatMap(ramp, 2, HeatScale::Magnitude);
    ASSERT_EQ(bytes.size(), 303u);
    EXPECT_LT(lightness(bytes.data()), 1);
    EXPECT_GT(lightness(bytes.data() + 300), 95);
    double before = -1;
    for (size_t i = 0; i <= 100; ++i) {
        const double l = lightness(bytes.data() + 3 * i);
        // A hundredth of the range is 0.1 to 1.3 of L* in the published map (it is even in another lightness): neither
        // plateaus nor jumps, which would show edges that are not there.
        if (i > 0) {
            EXPECT_GT(l - before, 0.05) << i;
            EXPECT_LT(l - before, 1.6) << i;
        }
        before = l;
    }
}

TEST(HeatMap, SignedErrorsAreWhiteBlueAndRedAndEquallyDarkBothWays) {
    Image values(5, 1, 1);
    values.pixels = {-9, -0.5f, 0, 0.5f, 9};
    const std::vector<uint8_t> bytes = heatMap(values, 1, HeatScale::Signed);
    EXPECT_GT(lightness(bytes.data() + 6), 95);
    EXPECT_GT(bytes[2], bytes[0]) << "too dark is blue";
    EXPECT_GT(bytes[12], bytes[14]) << "too bright is red";
    EXPECT_NEAR(lightness(bytes.data()), lightness(bytes.data() + 12), 5);
    EXPECT_NEAR(lightness(bytes.data() + 3), lightness(bytes.data() + 9), 3);
}

TEST(HeatMap, WhatIsNoNumberIsGreenAndWhatIsBeyondTheRangeHasTheLastColour) {
    Image values(3, 1, 1);
    values.pixels = {NAN, 1, INFINITY};
    const std::vector<uint8_t> bytes = heatMap(values, 1, HeatScale::Magnitude);
    EXPECT_EQ((std::vector<uint8_t>(bytes.begin(), bytes.begin() + 3)),
              (std::vector<uint8_t>{0, 255, 0}));
    EXPECT_EQ((std::vector<uint8_t>(bytes.begin() + 3, bytes.begin() + 6)),
              (std::vector<uint8_t>(bytes.begin() + 6, bytes.end())));
}

} // namespace
} // namespace tyndall
