// Soft shadows and occluded skies, against closed forms.

#include "passes/shadows_scene.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

namespace tyndall::test {
namespace {

using SoftShadows = LightsTest;
TYNDALL_GL_TESTS(SoftShadows);

/// Part of a disc's area on one side of a chord at signed distance x (in radii) from its centre.
double discPart(double x) {
    x = std::clamp(x, -1.0, 1.0);
    return 0.5 + (x * std::sqrt(1 - x * x) + std::asin(x)) / kPi;
}

TEST_P(SoftShadows, SphereLightHasThePenumbraOfItsDiscOnAverage) {
    // Ball of radius R at height 8; a wall's edge at height 4 along x = 0; receivers at height 0. At x the edge cuts the
    // ball's disc at distance -x from its centre (similar triangles: the edge is half-way), so x/R of it is seen.
    const double radius = 0.3;
    SceneMaker maker;
    maker.primitive(PrimitiveShape::Plane, {8, 1, 8}, {-4, 4, 0});
    maker.primitive(PrimitiveShape::Plane, {20, 1, 20}, {0, -0.001, 0});
    maker.pointLight(100, {0, 8, 0}, float(radius));
    lights().shadowSettings().localResolution = 256;
    std::vector<Probe> probes;
    for (double x = -0.5; x <= 0.5; x += 0.05) probes.push_back({{x, 0, 0}, kUp});
    ProbeOptions options;
    options.converge = true;
    options.frames = 1024;
    const std::vector<Seen> seen = look(maker, probes, options);
    double worst = 0;
    for (size_t i = 0; i < probes.size(); ++i) {
        const double expected = discPart(probes[i].position.x / radius),
                     measured = double(seen[i].lit / seen[i].open);
        worst = std::max(worst, std::abs(measured - expected));
    }
    std::printf("worst error of the visible part %.4f\n", worst);
    EXPECT_LT(worst, 0.02); // falls with the number of frames: 0.0035 at 4096
}

TEST_P(SoftShadows, SunAndRectHaveTheirPenumbrasOnAverage) {
    const double halfAngle = 0.05, halfSize = 0.3;
    for (const bool sun : {true, false}) {
        SceneMaker maker;
        maker.primitive(PrimitiveShape::Plane, {8, 1, 8}, {-4, 4, 0});
        maker.primitive(PrimitiveShape::Plane, {20, 1, 20}, {0, -0.001, 0});
        lights().shadowSettings().resolution = lights().shadowSettings().localResolution = 256;
        if (sun) maker.directionalLight(10, {0, -1, 0}, float(halfAngle));
        Light panel;
        panel.type = LightType::Rect;
        panel.radiance = vec3(1);
        panel.size = vec2(float(2 * halfSize));
        if (!sun)
            maker.light(panel, glm::translate(dmat4(1), dvec3(0, 8, 0)) *
                                   glm::rotate(dmat4(1), -kPi / 2, dvec3(1, 0, 0)));
        std::vector<Probe> probes;
        for (double x = -0.4; x <= 0.4; x += 0.05) probes.push_back({{x, 0, 0}, kUp});
        ProbeOptions options;
        options.converge = true;
        options.frames = 1024;
        const std::vector<Seen> seen = look(maker, probes, options);
        for (size_t i = 0; i < probes.size(); ++i) {
            // The sun's disc is cut at tan(angle) = x/4; the rect, whose every part weighs almost the same here, at x.
            const double x = probes[i].position.x;
            const double expected = sun ? discPart(std::atan(x / 4) / halfAngle)
                                        : std::clamp(0.5 + 0.5 * x / halfSize, 0.0, 1.0);
            EXPECT_NEAR(double(seen[i].lit / seen[i].open), expected, 0.02)
                << (sun ? "sun" : "rect") << " at " << x;
        }
    }
}

TEST_P(SoftShadows, SingleFramesHaveSoftShadowsOfTheRightWidth) {
    const double radius = 0.3;
    SceneMaker maker;
    maker.primitive(PrimitiveShape::Plane, {8, 1, 8}, {-4, 4, 0});
    maker.primitive(PrimitiveShape::Plane, {20, 1, 20}, {0, -0.001, 0});
    maker.pointLight(100, {0, 8, 0}, float(radius));
    lights().shadowSettings().taps = 32;
    lights().shadowSettings().searchTaps = 32;
    std::vector<Probe> probes;
    std::vector<double> places = {-0.6, -0.2, -0.1, 0.0, 0.1, 0.2, 0.6};
    for (const double x : places)
        for (int z = 0; z < 64; ++z) probes.push_back({{x, 0, 0.02 * z}, kUp});
    const std::vector<Seen> seen = look(maker, probes);
    for (size_t p = 0; p < places.size(); ++p) {
        double mean = 0;
        for (size_t z = 0; z < 64; ++z) mean += double(seen[64 * p + z].visibility) / 64;
        EXPECT_NEAR(mean, discPart(places[p] / radius), std::abs(places[p]) > 0.5 ? 1e-6 : 0.08)
            << "at " << places[p];
    }
}

TEST_P(SoftShadows, EnvironmentLightIsOccluded) {
    // Under a wide ceiling close above, only the horizon is seen: between 0 and a tenth of the open sky's light.
    SceneMaker maker;
    maker.scene.environment.radiance = vec3(1);
    maker.primitive(PrimitiveShape::Plane, {40, 1, 40}, {0, 1, 0});
    maker.primitive(PrimitiveShape::Plane, {40, 1, 40}, {0, 0, 0});
    ProbeOptions options;
    options.converge = true;
    options.frames = 128;
    const std::vector<Seen> seen = look(maker, {{{0, 0, 0}, kUp}, {{0, 1, 0}, kUp}}, options);
    EXPECT_LT(seen[0].lit, 0.1f * float(kPi));
    EXPECT_NEAR(double(seen[1].lit), kPi, 0.02 * kPi);
}

TEST_P(SoftShadows, HalfTheSkyIsHalfTheLight) {
    // A huge wall hides the directions with x < 0 from a point before it: half of πL on the ground, and a little more,
    // as the wall ends 50 m up: atan(1/50) of the angle.
    SceneMaker maker;
    maker.scene.environment.radiance = vec3(1);
    maker.primitive(PrimitiveShape::Box, {0.02, 100, 100}, {-1, 0, 0});
    ProbeOptions options;
    options.converge = true;
    options.frames = 512;
    const std::vector<Seen> seen = look(maker, {{{0, 0, 0}, kUp}}, options);
    EXPECT_NEAR(double(seen[0].lit), kPi / 2, 0.03 * kPi);
}

} // namespace
} // namespace tyndall::test
