// The mean of averaged frames does not depend on the bound, over four decades of it: held light, the step in media and the paths of the processor
// make up for each other. Against the path tracer, which renders here and now.

#include <array>
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "reference/render.h"
#include "support/render.h"
#include "vpl_truth.h"

namespace tyndall::test {
namespace {

constexpr int kWidth = 16, kHeight = 9, kFrames = 2, kSeeds = 24;
/// Both means are independent of each other: by chance one in 370 is farther off.
constexpr double kStandardErrors = 3;

struct Mean {
    double value = 0, error = 0;
};

Mean meanOfSeeds(const std::array<double, kSeeds>& values) {
    Mean mean;
    for (const double value : values) mean.value += value / kSeeds;
    for (const double value : values)
        mean.error += std::pow(value - mean.value, 2) / (kSeeds * (kSeeds - 1));
    mean.error = std::sqrt(mean.error);
    return mean;
}

Mean truthOf(const Scene& scene, TermSet terms) {
    std::array<double, kSeeds> means;
    for (size_t seed = 0; seed < kSeeds; ++seed) {
        reference::RenderSettings settings;
        settings.width = kWidth;
        settings.height = kHeight;
        settings.path.terms = terms;
        settings.seed = seed;
        auto render = reference::ReferenceRender::start(scene, scene.activeCamera, settings);
        if (!render.ok()) throw std::runtime_error(render.message());
        render->addSamples(1024);
        means[seed] = meanOf(render->film().beauty());
    }
    return meanOfSeeds(means);
}

Mean oursOf(const Scene& scene, TermSet terms, const std::string& bound, const std::string& paths) {
    std::array<double, kSeeds> means;
    for (size_t seed = 0; seed < kSeeds; ++seed) {
        RenderOptions options;
        options.width = kWidth;
        options.height = kHeight;
        options.frames = kFrames;
        options.seed = uint32_t(seed);
        options.gi = "vpl";
        options.terms = terms;
        options.settings = {"gi.vpl.walks=128",
                            "gi.vpl.candidates=1",
                            "gi.vpl.roughness=0",
                            "gi.vpl.march=full",
                            "gi.vpl.surfaces.resolution=full",
                            "gi.vpl.mapSide=16",
                            "gi.vpl.samples=8",
                            "gi.vpl.nearPaths=" + paths,
                            "gi.vpl.clamp=" + bound,
                            "gi.vpl.surfaceClamp=" + bound};
        means[seed] = meanOf(sharedRenderer().render(scene, options).beauty);
    }
    return meanOfSeeds(means);
}

struct Light {
    const char* name;
    std::string nodes;
    TermSet terms;
};

class VplBounds : public ::testing::TestWithParam<Light> {};

TEST_P(VplBounds, TheMeanIsTheSameOverFourDecades) {
    const Scene scene = sceneOf({GetParam().name, GetParam().nodes, 0, 0});
    const TermSet terms = GetParam().terms;
    const Mean truth = truthOf(scene, terms);
    const auto expectTruth = [&](const char* bound) {
        const Mean ours = oursOf(scene, terms, bound, "32");
        const double error = std::hypot(ours.error, truth.error);
        printf("%s, bound %s: %.4f of the truth, %+.2f standard errors of %.4f\n", GetParam().name,
               bound, ours.value / truth.value, (ours.value - truth.value) / error,
               error / truth.value);
        EXPECT_NEAR(ours.value, truth.value, kStandardErrors * error) << bound;
        EXPECT_LT(error, 0.06 * truth.value) << bound; // far less than paths bring: 0.2 and more
    };
    for (const char* bound : {"0.01", "1", "100"}) expectTruth(bound);
    const double without = oursOf(scene, terms, "10", "0").value / truth.value;
    printf("%s, bound 10, without paths: %.4f of the truth\n", GetParam().name, without);
    EXPECT_LT(without, 0.95); // else all of the above would pass without them
}

const std::string kFog = R"(
    {"name": "fog", "medium": {"type": "homogeneous", "shape": "box", "size": [3, 2, 3], "scattering": [1.2, 1, 0.8], "absorption": [0, 0.1, 0.3],
        "anisotropy": 0.3}},)";
const std::string kLamp = R"(
    {"name": "lamp", "light": {"type": "point", "intensity": 10, "radius": 0.05}, "translation": [0.4, 0.3, -0.5]},)";

INSTANTIATE_TEST_SUITE_P(Scenes, VplBounds,
                         ::testing::Values(Light{"fog in a room, media", kDarkRoom + kFog + kLamp,
                                                 kIndirectInMedia},
                                           Light{"fog in a room, surfaces",
                                                 kDarkRoom + kFog + kLamp, kIndirectOnSurfaces}));

} // namespace
} // namespace tyndall::test
