#include "media/blackbody.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/check.h"

namespace tyndall {
namespace {

dvec2 chromaticity(double kelvin) {
    const dvec3 xyz = blackbodyXyz(kelvin);
    return dvec2(xyz) / (xyz.x + xyz.y + xyz.z);
}

double luminanceOf(const dvec3& rgb) {
    return glm::dot(rgb, dvec3(0.2126729, 0.7151522, 0.0721750));
}

TEST(Blackbody, ChromaticityOfKnownTemperatures) {
    // CIE illuminant A (2856 K), and the Planckian locus at the colour temperature of D65. The fits of the colour
    // matching functions deviate from the CIE's tables by about as much as is allowed here.
    EXPECT_NEAR(chromaticity(2856).x, 0.4476, 0.002);
    EXPECT_NEAR(chromaticity(2856).y, 0.4074, 0.002);
    EXPECT_NEAR(chromaticity(6504).x, 0.3135, 0.002);
    EXPECT_NEAR(chromaticity(6504).y, 0.3237, 0.002);
}

TEST(Blackbody, LuminanceOfFreezingPlatinumIsTheOldCandela) {
    // Until 1979: the luminance of a blackbody at the freezing point of platinum, 2041.4 K, is 60 cd/cm².
    EXPECT_NEAR(blackbodyXyz(2041.4).y / 6.0e5, 1, 0.01);
}

TEST(Blackbody, LuminanceMatchesTheTabulatedObserver) {
    // CIE 1924 V(λ), 380 to 760 nm in steps of 10.
    constexpr double kV[] = {0.000039, 0.00012,  0.000396, 0.00121, 0.0040,   0.0116,   0.023,
                             0.038,    0.060,    0.09098,  0.13902, 0.20802,  0.323,    0.503,
                             0.710,    0.862,    0.954,    0.99495, 0.995,    0.952,    0.870,
                             0.757,    0.631,    0.503,    0.381,   0.265,    0.175,    0.107,
                             0.061,    0.032,    0.017,    0.00821, 0.004102, 0.002091, 0.001047,
                             0.00052,  0.000249, 0.00012,  0.00006};
    for (const double kelvin : {1200.0, 1500.0, 2000.0, 3000.0, 5000.0, 10000.0, 30000.0}) {
        double sum = 0;
        for (size_t i = 0; i < std::size(kV); ++i) {
            const double wavelength = (380 + 10 * double(i)) * 1e-9;
            // c1L = 2hc² and c2 = hc/k, CODATA 2018.
            sum += kV[i] * 1.191042972e-16 / std::pow(wavelength, 5) /
                   (std::exp(1.438776877e-2 / (wavelength * kelvin)) - 1) * 10e-9;
        }
        EXPECT_NEAR(blackbodyXyz(kelvin).y / (683 * sum), 1, kelvin < 1500 ? 0.03 : 0.01) << kelvin;
    }
}

TEST(Blackbody, SrgbKeepsTheLuminanceAndIsNeverNegative) {
    double previous = 0;
    for (double kelvin = 400; kelvin < 1e5; kelvin *= 1.1) {
        const dvec3 rgb = blackbodyRadiance(kelvin);
        const double y = blackbodyXyz(kelvin).y;
        EXPECT_GE(std::min({rgb.x, rgb.y, rgb.z}), 0) << kelvin;
        EXPECT_NEAR(luminanceOf(rgb) / y, 1, 1e-5) << kelvin;
        EXPECT_GT(y, previous) << "hotter is brighter";
        previous = y;
    }
    const dvec3 candle = blackbodyRadiance(1850), daylight = blackbodyRadiance(6504),
                sky = blackbodyRadiance(20000);
    EXPECT_GT(candle.x, 3 * candle.y);
    EXPECT_NEAR(daylight.x / daylight.z, 1, 0.06) << "white is white";
    EXPECT_GT(sky.z, 1.5 * sky.x);
    EXPECT_EQ(blackbodyRadiance(1000).z, 0) << "outside sRGB: moved to its edge";
}

TEST(Blackbody, NothingGlowsAtAbsoluteZeroOrBelow) {
    EXPECT_EQ(blackbodyRadiance(0), dvec3(0));
    EXPECT_EQ(blackbodyRadiance(-5), dvec3(0));
    EXPECT_EQ(blackbodyRadiance(std::nan("")), dvec3(0));
    for (const double kelvin : {1e-3, 1.0, 1e6, 1e20})
        EXPECT_TRUE(std::isfinite(luminanceOf(blackbodyRadiance(kelvin)))) << kelvin;
}

TEST(BlackbodyTable, InterpolatesWithinAThousandthOfTheLuminance) {
    const BlackbodyTable table = makeBlackbodyTable();
    for (double kelvin = 500; kelvin < 40000; kelvin *= 1.013) {
        const dvec3 exact = blackbodyRadiance(kelvin), looked = table.radiance(kelvin);
        const double y = luminanceOf(exact);
        const double tolerance =
            kelvin < 20000 ? 1e-3 : 4e-3; // few entries are left for the hottest
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(looked[c] / y, exact[c] / y, tolerance) << kelvin << " channel " << c;
        EXPECT_NEAR(luminanceOf(looked) / y, 1, tolerance) << kelvin;
    }
    EXPECT_EQ(table.radiance(399), dvec3(0));
    EXPECT_EQ(table.radiance(1e9), table.radiance(BlackbodyTable::kHottest));
    EXPECT_THROW(makeBlackbodyTable(1), CheckFailure);
}

} // namespace
} // namespace tyndall
