// Two path tracers, one with next-event estimation and MIS, one that only follows paths: their pictures differ by their noise alone.

#include <cmath>
#include <gtest/gtest.h>

#include "agreement_scenes.h"
#include "reference/render.h"

namespace tyndall::validation {
namespace {

constexpr int kWidth = 12, kHeight = 8;

struct Picture {
    Image mean, variance;
};

Picture render(const AgreementScene& about, reference::Integrator integrator, uint32_t samples,
               uint64_t seed) {
    reference::RenderSettings settings;
    settings.width = kWidth;
    settings.height = kHeight;
    settings.integrator = integrator;
    settings.clampDistance = 0.5; // of bodies some 2 m across
    settings.seed = seed;
    auto render = reference::ReferenceRender::start(about.scene, about.camera, settings);
    if (!render.ok()) throw std::runtime_error(render.message());
    render->addSamples(samples);
    EXPECT_EQ(render->counts().nonFinite, 0u);
    EXPECT_EQ(render->counts().negative, 0u);
    EXPECT_EQ(render->counts().cutOff, 0u);
    return {render->film().beauty(), render->film().variance()};
}

struct Differences {
    std::vector<double> z;
    double first = 0, second = 0, variance = 0; // of the pictures' means
};

Differences differencesOf(const Picture& a, const Picture& b) {
    Differences result;
    const double n = double(a.mean.pixels.size());
    for (size_t i = 0; i < a.mean.pixels.size(); ++i) {
        const double x = double(a.mean.pixels[i]), y = double(b.mean.pixels[i]);
        const double variance = double(a.variance.pixels[i]) + double(b.variance.pixels[i]);
        result.first += x / n;
        result.second += y / n;
        // Channels of one path go up and down together: at worst their variances add up as if they were one.
        result.variance += 3 * variance / (n * n);
        if (variance > 0)
            result.z.push_back((x - y) / std::sqrt(variance));
        else
            EXPECT_NEAR(x, y, 1e-5 * std::abs(x)) << "without noise, at " << i;
    }
    return result;
}

class ReferenceAgreement : public ::testing::TestWithParam<int> {};

void expectTheSame(const char* name, const Picture& a, const Picture& b) {
    const Differences d = differencesOf(a, b);
    ASSERT_GT(d.z.size(), 0.5 * 3 * kWidth * kHeight);
    double mean = 0, variance = 0, largest = 0;
    for (const double z : d.z) {
        mean += z / double(d.z.size());
        variance += z * z / double(d.z.size());
        largest = std::max(largest, std::abs(z));
    }
    const double apart = (d.first - d.second) / std::sqrt(d.variance);
    std::printf("%s: %.5g and %.5g, apart by %+.2f standard errors; z: mean %+.3f, square %.2f, "
                "largest %.1f of %zu\n",
                name, d.first, d.second, apart, mean, variance, largest, d.z.size());
    EXPECT_GT(d.first, 0.01);
    EXPECT_LT(std::sqrt(d.variance), 0.03 * d.first) << "too coarse to tell anything";
    EXPECT_LE(std::abs(apart), 4);
    // With eight streams z has between 7 (t: variance 1.4) and 14 degrees of freedom (1.17), in some 96 independent pixels,
    // whose sum of squares is then known to within 25 %.
    EXPECT_LT(std::abs(mean), 4 * std::sqrt(1.4 / double(kWidth * kHeight)));
    EXPECT_GT(variance, 0.6);
    EXPECT_LT(variance, 2.2);
    // Of 2880 values with 7 degrees of freedom one in 400 runs is larger.
    EXPECT_LT(largest, 14);
}

TEST_P(ReferenceAgreement, BothIntegratorsSeeTheSamePixelByPixel) {
    const AgreementScene about = agreementScene(GetParam());
    const uint64_t seed = 1000 + 2 * uint64_t(GetParam());
    expectTheSame(about.name,
                  render(about, reference::Integrator::Simple, about.simpleSamples, seed),
                  render(about, reference::Integrator::Volume, about.volumeSamples, seed + 1));
}

INSTANTIATE_TEST_SUITE_P(Scenes, ReferenceAgreement, ::testing::Range(0, kAgreementScenes));

/// Where no phase function has a peak (a virtual light with g = 0.95 is seen by chance alone: the spread of some thousand samples does not
/// tell how far off their mean is), and no fog without an end (of which walks leave out what is outside of the scene's ball).
class InstantRadiosityAgreement : public ::testing::TestWithParam<int> {};

TEST_P(InstantRadiosityAgreement, VirtualLightsAndWhatTheirBoundTakesAwayMakeTheSamePicture) {
    const AgreementScene about = agreementScene(GetParam());
    const uint64_t seed = 2000 + 2 * uint64_t(GetParam());
    expectTheSame(
        about.name,
        render(about, reference::Integrator::InstantRadiosity, 32 * about.volumeSamples, seed),
        render(about, reference::Integrator::Volume, 8 * about.volumeSamples, seed + 1));
}

INSTANTIATE_TEST_SUITE_P(Scenes, InstantRadiosityAgreement, ::testing::Values(2, 3, 5, 6, 8, 9));

} // namespace
} // namespace tyndall::validation
