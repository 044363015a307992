#include "core/sampling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/math.h"

namespace tyndall {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(OneMinusExpOverX, KeepsItsDigitsEverywhere) {
    EXPECT_EQ(oneMinusExpOverX(0.0), 1.0);
    EXPECT_EQ(oneMinusExpOverX(0.0f), 1.0f);
    for (double x = 1e-12; x < 2; x *= 1.37) {
        // Taylor: Σ (-x)^k/(k+1)!, all that is needed below 2.
        double term = 1, sum = 0;
        for (int k = 0; k < 40; ++k) {
            sum += term;
            term *= -x / (k + 2);
        }
        EXPECT_NEAR(oneMinusExpOverX(x) / sum, 1, 1e-14) << x;
        EXPECT_NEAR(double(oneMinusExpOverX(float(x))) / sum, 1, 3e-7) << x;
    }
    EXPECT_DOUBLE_EQ(oneMinusExpOverX(1e4), 1e-4);
    EXPECT_EQ(oneMinusExpOverX(kInfinity), 0.0);
}

TEST(ExponentialSampling, InvertsTheDistributionAndIsFinite) {
    for (const double sigma : {1e-6, 1.0, 50.0})
        for (const double u : {0.0, 1e-12, 0.25, 0.5, 0.999999, 1 - 0x1p-53}) {
            const DistanceSample<double> sample = sampleExponential(u, sigma);
            ASSERT_TRUE(std::isfinite(sample.distance));
            EXPECT_NEAR(-std::expm1(-sigma * sample.distance), u, 1e-14);
            EXPECT_NEAR(sample.density, sigma * (1 - u), sigma * 1e-14);
        }
}

TEST(TruncatedExponentialSampling, InvertsTheDistribution) {
    for (const double sigma : {0.0, 1e-300, 1e-9, 1e-4, 0.1, 1.0, 30.0})
        for (const double length : {1e-3, 1.0, 40.0})
            for (int i = 0; i < 50; ++i) {
                const double u = (i + 0.5) / 50;
                const DistanceSample<double> sample = sampleTruncatedExponential(u, sigma, length);
                const double depth = sigma * length;
                const double share =
                    depth < 1e-12 ? sample.distance / length
                                  : std::expm1(-sigma * sample.distance) / std::expm1(-depth);
                EXPECT_NEAR(share, u, 1e-11) << sigma << " " << length;
                const double density = depth < 1e-12 ? 1 / length
                                                     : -sigma * std::exp(-sigma * sample.distance) /
                                                           std::expm1(-depth);
                EXPECT_NEAR(sample.density / density, 1, 1e-11);
            }
}

TEST(TruncatedExponentialSampling, StaysInsideAndFiniteAtTheExtremes) {
    for (const float sigma : {0.0f, 1e-20f, 1e-7f, 1e-3f, 1.0f, 1e4f, 1e10f})
        for (const float length : {0.0f, 1e-10f, 1.0f, 1e6f})
            for (const float u : {0.0f, 1e-7f, 0.5f, 1 - 0x1p-24f}) {
                const DistanceSample<float> sample = sampleTruncatedExponential(u, sigma, length);
                EXPECT_TRUE(sample.distance >= 0 && sample.distance <= length)
                    << sigma << " " << length << " " << u;
                EXPECT_TRUE(std::isfinite(sample.density) && sample.density >= 0)
                    << sigma << " " << length << " " << u;
            }
}

TEST(EquiangularSampling, SpreadsTheAngleEvenly) {
    for (const double nearest : {-3.0, 0.0, 2.0, 9.0})
        for (const double height : {0.05, 1.0, 20.0})
            for (int i = 0; i < 50; ++i) {
                const double u = (i + 0.5) / 50, length = 5;
                const DistanceSample<double> sample = sampleEquiangular(u, nearest, height, length);
                const double begin = std::atan(-nearest / height),
                             end = std::atan((length - nearest) / height);
                const double angle = std::atan((sample.distance - nearest) / height);
                EXPECT_NEAR((angle - begin) / (end - begin), u, 1e-10);
                const double along = sample.distance - nearest;
                EXPECT_NEAR(sample.density * (end - begin) * (height * height + along * along) /
                                height,
                            1, 1e-10);
            }
}

TEST(EquiangularSampling, DensityIntegratesToOne) {
    for (const double nearest : {-1e7, -2.0, 0.5, 1.0, 1e7})
        for (const double height : {0.0, 0.01, 1.0, 1e8}) {
            const double length = 1;
            double sum = 0;
            constexpr int kSteps = 200000;
            for (int i = 0; i < kSteps; ++i)
                sum += equiangularDensity((i + 0.5) / kSteps, nearest, height, length) / kSteps;
            EXPECT_NEAR(sum, 1, 1e-5) << nearest << " " << height;
        }
}

TEST(EquiangularSampling, StaysInsideAndFiniteAtTheExtremes) {
    for (const float nearest : {-1e9f, -1.0f, 0.0f, 0.5f, 1e9f})
        for (const float height : {0.0f, 1e-12f, 1.0f, 1e12f})
            for (const float length : {0.0f, 1e-6f, 1.0f, 1e6f})
                for (const float u : {0.0f, 0.5f, 1 - 0x1p-24f}) {
                    const DistanceSample<float> sample =
                        sampleEquiangular(u, nearest, height, length);
                    EXPECT_TRUE(sample.distance >= 0 && sample.distance <= length)
                        << nearest << " " << height << " " << length << " " << u;
                    EXPECT_TRUE(std::isfinite(sample.density) && sample.density >= 0)
                        << nearest << " " << height << " " << length << " " << u;
                }
}

} // namespace
} // namespace tyndall
