#include "core/phase_function.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/check.h"
#include "core/math.h"
#include "media_dense_field.h"
#include "support/content.h"

namespace tyndall {
namespace {

using Function = std::function<double(double)>;

/// ∫ f over [low,high], five-point Gauss–Legendre on `pieces` pieces.
double gauss(const Function& f, double low, double high, int pieces) {
    constexpr double kNodes[] = {0, 0.5384693101056831, -0.5384693101056831, 0.9061798459386640,
                                 -0.9061798459386640};
    constexpr double kWeights[] = {0.5688888888888889, 0.4786286704993665, 0.4786286704993665,
                                   0.2369268850561891, 0.2369268850561891};
    double sum = 0;
    const double half = (high - low) / pieces / 2;
    for (int i = 0; i < pieces; ++i)
        for (int k = 0; k < 5; ++k)
            sum += kWeights[k] * half * f(low + (2 * i + 1 + kNodes[k]) * half);
    return sum;
}

/// ∫ f(cos) over [-1,cosine] with pieces that shrink towards both ends, where phase functions peak.
double overCosine(const Function& f, double cosine = 1) {
    double sum = 0, low = -1;
    for (int i = 1; i <= 120 && low < cosine; ++i) {
        const double exponent = double(i - 60) / 5; // ends of the pieces: -1 + 2·logistic
        const double high = i == 120 ? 1 : std::tanh(exponent / 2 * 2.3);
        sum += gauss(f, low, std::min(high, cosine), 8);
        low = high;
    }
    return sum;
}

double legendre(int l, double x) {
    double previous = 1, current = x;
    if (l == 0) return 1;
    for (int k = 2; k <= l; ++k) {
        const double next = ((2 * k - 1) * x * current - (k - 1) * previous) / k;
        previous = current;
        current = next;
    }
    return current;
}

const double kAnisotropies[] = {-0.99, -0.9,   -0.5,   -0.1, -1e-7, 0,    1e-7, 1e-3,
                                0.05,  0.0999, 0.1001, 0.3,  0.5,   0.75, 0.9,  0.99};

TEST(HenyeyGreenstein, IsNormalisedAndHasMomentsOfPowersOfG) {
    for (const double g : kAnisotropies)
        for (int l = 0; l <= 5; ++l) {
            const double moment = 2 * kPi * overCosine([&](double c) {
                                      return henyeyGreenstein(c, g) * legendre(l, c);
                                  });
            EXPECT_NEAR(moment, std::pow(g, l), 2e-9) << "g " << g << " l " << l;
        }
}

TEST(HenyeyGreenstein, PeakIsExactForStrongAnisotropy) {
    for (const double g : {0.5, 0.99, 0.999, 0.9999, 0.999999}) {
        const double peak = (1 + g) / (4 * kPi * (1 - g) * (1 - g));
        EXPECT_NEAR(henyeyGreenstein(1, g) / peak, 1, 1e-9);
        EXPECT_NEAR(henyeyGreensteinFromVersine(0, g) / peak, 1, 1e-12);
        EXPECT_NEAR(henyeyGreenstein(-1, -g) / peak, 1, 1e-9);
    }
    EXPECT_DOUBLE_EQ(henyeyGreenstein(0.3, 0), 1 / (4 * kPi));
    EXPECT_DOUBLE_EQ(henyeyGreensteinFromVersine(0.7, 0.4), henyeyGreenstein(0.3, 0.4));
}

TEST(HenyeyGreenstein, BackFractionAsPublished) {
    EXPECT_NEAR(henyeyGreensteinBackFraction(0.5), 0.1708204, 5e-8);
    EXPECT_NEAR(henyeyGreensteinBackFraction(0.75), 0.0666667, 5e-8);
    EXPECT_NEAR(henyeyGreensteinBackFraction(0.9), 0.0229033, 5e-8);
    for (const double g : {-0.7, -1e-3, -1e-5, 0.0, 1e-8, 1e-4, 0.2})
        EXPECT_NEAR(henyeyGreensteinBackFraction(g),
                    2 * kPi * overCosine([&](double c) { return henyeyGreenstein(c, g); }, 0), 1e-9)
            << g;
}

TEST(HenyeyGreenstein, SinglePrecisionSamplesKeepTheirDigits) {
    for (const float g :
         {1e-7f, 1e-5f, 1e-3f, 0.1f, 0.5f, 0.9f, 0.99f, 0.999f, 0.9999f, -1e-7f, -0.5f, -0.999f})
        for (int i = 0; i < 1000; ++i) {
            const float u = (float(i) + 0.5f) / 1000;
            // The textbook inversion, in a precision where its cancellation does not matter.
            const long double gl = static_cast<long double>(g),
                              s = (1 - gl * gl) / (1 - gl + 2 * gl * static_cast<long double>(u));
            const long double expected = (1 + gl * gl - s * s) / (2 * gl);
            EXPECT_NEAR(double(sampleHenyeyGreenstein(u, g)), double(expected), 1.0e-6)
                << "g " << g << " u " << u;
        }
}

TEST(HenyeyGreenstein, RefusesAnisotropyOfOne) {
    EXPECT_THROW((void)henyeyGreenstein(0, 1), CheckFailure);
    EXPECT_THROW((void)sampleHenyeyGreenstein(0.5, -1.0), CheckFailure);
    EXPECT_THROW((void)henyeyGreenstein(0, std::nan("")), CheckFailure);
}

TEST(Rayleigh, IsNormalisedSymmetricAndHasSecondMomentOneTenth) {
    for (int l = 0; l <= 4; ++l) {
        const double moment =
            2 * kPi * overCosine([&](double c) { return rayleigh(c) * legendre(l, c); });
        EXPECT_NEAR(moment, l == 0 ? 1 : l == 2 ? 0.1 : 0, 1e-12) << l;
    }
}

TEST(CornetteShanks, IsNormalisedAndHasThePublishedMeanCosine) {
    for (const double g : kAnisotropies) {
        EXPECT_NEAR(2 * kPi * overCosine([&](double c) { return cornetteShanks(c, g); }), 1, 2e-9)
            << g;
        EXPECT_NEAR(2 * kPi * overCosine([&](double c) { return cornetteShanks(c, g) * c; }),
                    cornetteShanksMeanCosine(g), 2e-9)
            << g;
    }
    EXPECT_NEAR(cornetteShanksMeanCosine(0.5), 0.5667, 5e-5);
    for (const double c : {-1.0, -0.3, 0.0, 0.8})
        EXPECT_NEAR(cornetteShanks(c, 0), rayleigh(c), 1e-15);
}

/// Evenly spread u must come back as the share of the function below the sample; ends included.
void expectInversion(const Function& sample, const Function& evaluate, const std::string& what) {
    for (int i = 0; i <= 200; ++i) {
        const double u = i / 200.0;
        const double cosine = sample(u);
        ASSERT_GE(cosine, -1) << what;
        ASSERT_LE(cosine, 1) << what;
        ASSERT_NEAR(2 * kPi * overCosine(evaluate, cosine), u, 1e-8) << what << " u " << u;
    }
}

TEST(PhaseSampling, InvertsTheCumulativeDistribution) {
    expectInversion(sampleRayleigh, rayleigh, "Rayleigh");
    for (const double g : kAnisotropies) {
        expectInversion([&](double u) { return sampleHenyeyGreenstein(u, g); },
                        [&](double c) { return henyeyGreenstein(c, g); },
                        "HG " + std::to_string(g));
        expectInversion([&](double u) { return sampleCornetteShanks(u, g); },
                        [&](double c) { return cornetteShanks(c, g); }, "CS " + std::to_string(g));
    }
}

/// Pearson's statistic over 50 bins of equal width in cos; bins under 20 expected are merged.
double chiSquareExcess(const Function& sample, const Function& evaluate, uint64_t seed) {
    constexpr int kBins = 50, kSamples = 200000;
    test::Draw draw(seed);
    std::vector<double> seen(kBins, 0);
    for (int i = 0; i < kSamples; ++i)
        seen[size_t(std::min(int((sample(draw.uniform()) + 1) / 2 * kBins), kBins - 1))] += 1;
    double statistic = 0, expectedSum = 0, seenSum = 0;
    int cells = 0;
    for (int b = 0; b < kBins; ++b) {
        expectedSum += kSamples * 2 * kPi *
                       (overCosine(evaluate, -1 + 2.0 * (b + 1) / kBins) -
                        overCosine(evaluate, -1 + 2.0 * b / kBins));
        seenSum += seen[size_t(b)];
        if (expectedSum < 20 && b + 1 < kBins) continue;
        statistic += (seenSum - expectedSum) * (seenSum - expectedSum) / expectedSum;
        expectedSum = seenSum = 0;
        ++cells;
    }
    return (statistic - (cells - 1)) / std::sqrt(2.0 * (cells - 1)); // in standard deviations
}

TEST(PhaseSampling, HistogramsMatchTheFunctions) {
    const uint64_t seed = test::seed();
    EXPECT_LT(chiSquareExcess(sampleRayleigh, rayleigh, seed), 6) << "seed " << seed;
    for (const double g : {-0.5, 0.0, 0.05, 0.5, 0.9}) {
        EXPECT_LT(chiSquareExcess([&](double u) { return sampleHenyeyGreenstein(u, g); },
                                  [&](double c) { return henyeyGreenstein(c, g); }, seed + 1),
                  6)
            << "g " << g << " seed " << seed;
        EXPECT_LT(chiSquareExcess([&](double u) { return sampleCornetteShanks(u, g); },
                                  [&](double c) { return cornetteShanks(c, g); }, seed + 2),
                  6)
            << "g " << g << " seed " << seed;
    }
}

} // namespace
} // namespace tyndall
