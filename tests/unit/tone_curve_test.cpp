// The tone curves in C++. Their equality with the shaders is a test of tests/shaders; here is what they promise.

#include "core/tone_curve.h"

#include <cmath>

#include <gtest/gtest.h>

namespace tyndall {
namespace {

constexpr ToneCurve kCurves[] = {ToneCurve::Linear, ToneCurve::Aces, ToneCurve::Agx,
                                 ToneCurve::Neutral};

TEST(ToneCurve, NamesReadBackAndOthersAreRefused) {
    for (ToneCurve curve : kCurves)
        EXPECT_EQ(parseToneCurve(kToneCurveNames[size_t(curve)]).value(), curve);
    EXPECT_NE(parseToneCurve("filmic").message().find("agx"), std::string::npos);
}

TEST(ToneCurve, RisesFromBlackAndStaysOnTheDisplay) {
    for (ToneCurve curve : kCurves) {
        double before = -1;
        for (double ev = -20; ev <= 20; ev += 0.25) {
            const dvec3 c = applyToneCurve(curve, dvec3(std::exp2(ev)));
            for (int i = 0; i < 3; ++i) {
                EXPECT_GE(c[i], 0) << kToneCurveNames[size_t(curve)] << " at " << ev;
                EXPECT_LE(c[i], 1) << kToneCurveNames[size_t(curve)] << " at " << ev;
            }
            // AgX's polynomial is not monotonic in its last tenths of a per cent: 1e-3 is less than a quarter of an 8-bit step.
            EXPECT_GE(c.y, before - 1e-3) << kToneCurveNames[size_t(curve)] << " at " << ev;
            before = c.y;
        }
        EXPECT_GT(before, 0.9) << kToneCurveNames[size_t(curve)] << ": bright light is white";
    }
}

TEST(ToneCurve, SrgbHasTheValuesOfItsStandard) {
    // IEC 61966-2-1: the linear part below 0.0031308; middle grey 0.2140 is 0.5 (0.21404114 in full).
    EXPECT_NEAR(srgbFromLinear(0.001), 0.01292, 1e-12);
    EXPECT_NEAR(srgbFromLinear(0.21404114), 0.5, 1e-7);
    EXPECT_NEAR(linearFromSrgb(0.5), 0.21404114, 1e-7);
    EXPECT_NEAR(srgbFromLinear(1), 1, 1e-12);
    for (double x = 0; x <= 1; x += 1 / 64.0) // the standard's two parts meet within 3e-8
        EXPECT_NEAR(linearFromSrgb(srgbFromLinear(x)), x, 1e-7);
}

TEST(ToneCurve, DisplayWhiteIsTheExposuresSaturation) {
    // ISO 2720: 1.2·2^EV100 nits are white, so half of it is 0.5 with the linear curve.
    Image nits(3, 1, 3);
    for (int c = 0; c < 3; ++c) {
        nits.at(0, 0)[c] = 0.6f * 32;
        nits.at(1, 0)[c] = 1.2f * 32;
        nits.at(2, 0)[c] = -1; // no light is black
    }
    const Image shown = displayImage(nits, 5, ToneCurve::Linear);
    EXPECT_NEAR(double(shown.at(0, 0)[1]), srgbFromLinear(0.5), 1e-6);
    EXPECT_NEAR(double(shown.at(1, 0)[1]), 1.0, 1e-6);
    EXPECT_EQ(shown.at(2, 0)[1], 0.0f);
}

TEST(ToneCurve, InvalidLightIsBlackAndOneChannelIsGrey) {
    Image grey(2, 1, 1);
    grey.pixels = {0.5f, NAN};
    const Image shown = displayImage(grey, 0, ToneCurve::Linear);
    EXPECT_EQ(shown.at(0, 0)[0], shown.at(0, 0)[2]);
    EXPECT_GT(shown.at(0, 0)[0], 0.0f);
    EXPECT_EQ(shown.at(1, 0)[0], 0.0f);
}

} // namespace
} // namespace tyndall
