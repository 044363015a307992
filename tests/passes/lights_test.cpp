// What lights send to points, against closed forms.

#include "passes/lights_fixture.h"

#include <glm/gtc/matrix_transform.hpp>

#include <chrono>
#include <cmath>
#include <random>

#include "shared/cluster.h"
#include "support/content.h"

namespace tyndall::test {
namespace {

using LightsOnPoints = LightsTest;
TYNDALL_GL_TESTS(LightsOnPoints);

constexpr dvec3 kUp{0, 1, 0};

TEST_P(LightsOnPoints, PointLightIsTheInverseSquareOverSixDecades) {
    SceneMaker maker;
    maker.pointLight(100, {0, 0, 0});
    maker.pointLight(0, {1000, 0, 0}); // makes the scene large, sends nothing
    std::vector<Probe> probes;
    for (double d = 0.05; d < 1e3; d *= 1.7)
        probes.push_back({glm::normalize(dvec3(1, -2, 0.5)) * d, {0, 0, 0}});
    const std::vector<Seen> seen = look(maker, probes);
    for (size_t i = 0; i < probes.size(); ++i) {
        const double d = glm::length(probes[i].position);
        EXPECT_NEAR(double(seen[i].lit) / (100 / (d * d)), 1.0, 2e-6) << "at " << d << " m";
    }
}

TEST_P(LightsOnPoints, RangeIsTheExtensionsWindow) {
    SceneMaker maker;
    maker.pointLight(50, {0, 0, 0}, 0, 4);
    std::vector<Probe> probes;
    for (double d = 0.5; d < 6; d += 0.25) probes.push_back({{d, 0, 0}, {0, 0, 0}});
    const std::vector<Seen> seen = look(maker, probes);
    for (size_t i = 0; i < probes.size(); ++i) {
        const double d = probes[i].position.x;
        const double expected = std::max(std::min(1 - std::pow(d / 4, 4), 1.0), 0.0) / (d * d) * 50;
        EXPECT_NEAR(double(seen[i].lit), expected, 1e-5 * 50 / (d * d));
    }
}

TEST_P(LightsOnPoints, SpotConeIsTheExtensionsFormula) {
    for (const auto& [inner, outer] :
         {std::pair(0.2, 0.5), std::pair(0.0, kPi / 4), std::pair(0.3, 1.5), std::pair(0.4, 0.4)}) {
        SceneMaker maker;
        Light torch;
        torch.type = LightType::Spot;
        torch.intensity = 100;
        torch.innerConeAngle = float(inner);
        torch.outerConeAngle = float(outer);
        maker.light(torch, lookingAlong({1, 2, 3}, {1, -1, 0.5}));
        const dmat4 frame = lookingAlong({1, 2, 3}, {1, -1, 0.5});
        std::vector<Probe> probes;
        std::vector<double> angles;
        for (double angle = 0.01; angle < 1.56; angle += 0.05) {
            angles.push_back(angle);
            probes.push_back(
                {dvec3(frame * dvec4(2 * std::sin(angle), 0, -2 * std::cos(angle), 1)), {0, 0, 0}});
        }
        const std::vector<Seen> seen = look(maker, probes);
        for (size_t i = 0; i < probes.size(); ++i) {
            const double scale = 1 / std::max(0.001, std::cos(inner) - std::cos(outer)),
                         offset = -std::cos(outer) * scale;
            const double attenuation = std::clamp(std::cos(angles[i]) * scale + offset, 0.0, 1.0);
            EXPECT_NEAR(double(seen[i].lit), 25 * attenuation * attenuation, 25 * 2e-3)
                << "cone " << inner << " to " << outer << ", angle " << angles[i];
        }
    }
}

TEST_P(LightsOnPoints, DirectionalLightIsLuxTimesCosine) {
    SceneMaker maker;
    maker.directionalLight(20, {1, -1, 0});
    const std::vector<Seen> seen = look(maker, {{{5, 5, 5}, kUp},
                                                {{-900, 3, 0}, {-1, 0, 0}},
                                                {{0, 0, 0}, {1, 0, 0}},
                                                {{0, 0, 0}, {0, 0, 0}}});
    EXPECT_NEAR(double(seen[0].lit), 20 / std::sqrt(2), 1e-4);
    EXPECT_NEAR(double(seen[1].lit), 20 / std::sqrt(2), 1e-4);
    EXPECT_EQ(seen[2].lit, 0.0f);
    EXPECT_NEAR(double(seen[3].lit), 20, 1e-4);
}

/// Irradiance from a Lambertian polygon of radiance 1 wholly above the horizon (Lambert's formula).
double polygonIrradiance(const std::vector<dvec3>& corners, const dvec3& point,
                         const dvec3& normal) {
    dvec3 sum(0);
    for (size_t i = 0; i < corners.size(); ++i) {
        const dvec3 a = glm::normalize(corners[i] - point),
                    b = glm::normalize(corners[(i + 1) % corners.size()] - point);
        sum += std::acos(glm::dot(a, b)) * glm::normalize(glm::cross(a, b));
    }
    return 0.5 * std::abs(glm::dot(sum, normal));
}

/// A rect light of 2 × 1 m, three metres up, tilted, its node scaled by (1.5, 0.8, 3).
struct Panel {
    dmat4 node =
        lookingAlong({0.5, 3, 0}, {0.2, -1, 0.1}) * glm::scale(dmat4(1), dvec3(1.5, 0.8, 3));
    std::vector<dvec3> corners;
    std::vector<Probe> probes;
    SceneMaker maker;
    Panel() {
        Light panel;
        panel.type = LightType::Rect;
        panel.size = {2, 1};
        panel.radiance = vec3(10);
        maker.light(panel, node);
        for (const dvec2& c : {dvec2(-1, -0.5), dvec2(1, -0.5), dvec2(1, 0.5), dvec2(-1, 0.5)})
            corners.emplace_back(node * dvec4(c, 0, 1));
        for (double x = -4; x <= 4; x += 0.5) probes.push_back({{x, 0, 0.3 * x}, kUp});
    }
};

TEST_P(LightsOnPoints, RectLightOnAPlaneIsLambertsFormula) {
    Panel panel;
    ProbeOptions options;
    options.rectSamples = 32;
    std::vector<Probe> probes = panel.probes;
    probes.push_back({{0.5, 6, 0}, {0, -1, 0}}); // behind: one-sided
    const std::vector<Seen> seen = look(panel.maker, probes, options);
    for (size_t i = 0; i < panel.probes.size(); ++i)
        EXPECT_NEAR(double(seen[i].lit) /
                        (10 * polygonIrradiance(panel.corners, probes[i].position, kUp)),
                    1.0, 2e-3);
    EXPECT_EQ(seen.back().lit, 0.0f);
}

TEST_P(LightsOnPoints, RectLightAveragedOverFramesIsLambertsFormula) {
    Panel panel;
    ProbeOptions options;
    options.converge = true;
    options.frames = 512;
    const std::vector<Seen> seen = look(panel.maker, panel.probes, options);
    for (size_t i = 0; i < panel.probes.size(); ++i)
        EXPECT_NEAR(double(seen[i].lit) /
                        (10 * polygonIrradiance(panel.corners, panel.probes[i].position, kUp)),
                    1.0, 5e-3);
}

TEST_P(LightsOnPoints, BallAndSunAveragedOverFramesAreTheirClosedForms) {
    // A Lambertian ball wholly above the horizon gives I·cosθ/d², d and θ to its centre, however close it is (its form factor).
    SceneMaker maker;
    maker.pointLight(100, {0, 2, 0}, 0.7f);
    ProbeOptions options;
    options.converge = true;
    options.frames = 8192;
    const std::vector<Probe> probes = {
        {{0, 0, 0}, kUp}, {{1, 0, 2}, kUp}, {{3, 1, 0}, glm::normalize(dvec3(-1, 0.3, 0))}};
    const std::vector<Seen> ball = look(maker, probes, options);
    for (size_t i = 0; i < probes.size(); ++i) {
        const dvec3 d = dvec3(0, 2, 0) - probes[i].position;
        const double expected = 100 * glm::dot(d, probes[i].normal) / std::pow(glm::length(d), 3);
        EXPECT_NEAR(double(ball[i].lit) / expected, 1.0, 5e-3) << "probe " << i;
    }
    // A sun with a disc: E lux on a surface that faces its centre, E·cosθ on one that sees the whole disc.
    SceneMaker sunny;
    sunny.directionalLight(20, {1, -1, 0}, 0.3f);
    const std::vector<Seen> sun =
        look(sunny, {{{0, 0, 0}, glm::normalize(dvec3(-1, 1, 0))}, {{0, 0, 0}, kUp}}, options);
    EXPECT_NEAR(double(sun[0].lit), 20, 20 * 2e-3);
    EXPECT_NEAR(double(sun[1].lit), 20 / std::sqrt(2), 20 * 2e-3);
}

TEST_P(LightsOnPoints, EverythingIsFiniteAtTheLightItself) {
    for (const bool converge : {false, true}) {
        SceneMaker maker;
        maker.pointLight(100, {0, 0, 0});
        maker.pointLight(100, {0, 0, 0}, 0.5f);
        Light torch;
        torch.type = LightType::Spot;
        maker.light(torch, dmat4(1));
        Light panel;
        panel.type = LightType::Rect;
        panel.radiance = vec3(1);
        maker.light(panel, dmat4(1));
        maker.primitive(PrimitiveShape::Box, dvec3(1), {0, 0, 0}); // the lights are inside
        ProbeOptions options;
        options.converge = converge;
        options.eye = {0, 0, 0};
        // look() asserts that all values are finite and none is negative.
        const std::vector<Seen> seen = look(maker,
                                            {{{0, 0, 0}, {0, 0, 0}},
                                             {{0, 0, 0}, kUp},
                                             {{1e-20, 0, 0}, {0, 0, 0}},
                                             {{1e-4, 0, 0}, {0, 0, 0}}},
                                            options);
        EXPECT_GT(seen[3].open, 0.0f);
    }
}

TEST_P(LightsOnPoints, DegenerateLightsAreLeftOutWithANote) {
    SceneMaker maker;
    Light light;
    light.name = "dark";
    light.intensity = 0;
    maker.light(light, dmat4(1));
    light = {};
    light.name = "flat";
    light.type = LightType::Rect;
    light.radiance = vec3(1);
    light.size = {1, 0};
    maker.light(light, dmat4(1));
    light.name = "squashed";
    light.size = {1, 1};
    maker.light(light, glm::scale(dmat4(1), dvec3(0, 1, 1)));
    light = {};
    light.name = "infinite";
    light.intensity = std::numeric_limits<float>::infinity();
    maker.light(light, dmat4(1));
    light = {};
    light.name = "hidden";
    maker.scene.nodes[size_t(maker.light(light, dmat4(1)))].visible = false;
    const std::vector<Seen> seen = look(maker, {{{1, 0, 0}, {0, 0, 0}}});
    EXPECT_EQ(seen[0].lit, 0.0f);
    EXPECT_TRUE(lights().lights().empty());
    ASSERT_EQ(lights().notes().size(), 4u);
    EXPECT_EQ(lights().notes()[0], "light 'dark' is left out: its power is zero");
    EXPECT_EQ(lights().notes()[1], "light 'flat' is left out: its area is zero");
    EXPECT_EQ(lights().notes()[2], "light 'squashed' is left out: its area is zero");
    EXPECT_EQ(lights().notes()[3], "light 'infinite' is left out: its numbers are not finite");
}

TEST_P(LightsOnPoints, EnvironmentIsItsLights) {
    SceneMaker maker;
    maker.scene.environment.radiance = vec3(2);
    const std::vector<Seen> medium = look(maker, {{{0, 0, 0}, {0, 0, 0}}});
    EXPECT_NEAR(double(medium[0].lit), 8 * kPi, 1e-3) << "4πL";
    EXPECT_EQ(lights().lights().size(), 32u) << "at high quality";
    ProbeOptions options;
    options.converge = true;
    options.frames = 256;
    const std::vector<Seen> surface =
        look(maker, {{{0, 0, 0}, glm::normalize(dvec3(1, 2, 3))}}, options);
    EXPECT_NEAR(double(surface[0].lit), 2 * kPi, 2 * kPi * 3e-3) << "πL";
}

/// A thousand small lights in a box before the camera, and probes among them.
struct ManyLights {
    SceneMaker maker;
    std::vector<Probe> probes;
    ProbeOptions options;
    /// `decades`: the candelas spread over so many powers of ten below 1.5.
    explicit ManyLights(float range, float scale = 1, double decades = 0.5) {
        std::mt19937 random{uint32_t(seed())};
        std::uniform_real_distribution<double> unit(-1, 1);
        const auto point = [&] {
            return dvec3(unit(random) * 20, unit(random) * 10, unit(random) * 20) * double(scale);
        };
        for (int i = 0; i < 1000; ++i)
            maker.pointLight(scale * scale * 1.5f *
                                 float(std::pow(10.0, 0.5 * decades * (unit(random) - 1))),
                             point(), 0, range * scale);
        for (int i = 0; i < 1024; ++i) probes.push_back({point(), i % 2 ? kUp : dvec3(0)});
        options.eye = dvec3(0, 0, 25) * double(scale);
        options.sceneRadius = 30 * double(scale);
    }
};

TEST_P(LightsOnPoints, ThousandLightsThroughListsAreThousandLights) {
    for (const float scale : {1e-3f, 1.0f, 1e3f}) {
        ManyLights many(2, scale);
        const std::vector<Seen> seen = look(many.maker, many.probes, many.options);
        EXPECT_EQ(lights().globalCount(), 0u);
        EXPECT_EQ(statusOf("lights.clusters"), "ran");
        EXPECT_EQ(clusterWords()[6], 0u) << "no list overflowed";
        EXPECT_GT(clusterWords()[7], 4u);
        EXPECT_LT(clusterWords()[7], 128u);
        size_t reached = 0;
        for (const Seen& s : seen) {
            EXPECT_NEAR(s.clustered, s.lit, 1e-6f * std::max(s.lit, 1.0f));
            reached += s.lit > 0;
        }
        EXPECT_GT(reached, seen.size() / 4);
    }
}

TEST_P(LightsOnPoints, ListsThatOverflowLoseNoLight) {
    ManyLights many(5);
    lights().lightSettings().clusterCapacity = 8;
    const std::vector<Seen> seen = look(many.maker, many.probes, many.options);
    EXPECT_GT(clusterWords()[6], 10u) << "some lists overflowed";
    for (const Seen& s : seen) EXPECT_NEAR(s.clustered, s.lit, 1e-6f * std::max(s.lit, 1.0f));
}

TEST_P(LightsOnPoints, ParallelViewsAndFewLightsNeedNoLists) {
    ManyLights many(2);
    many.options.orthographic = true;
    std::vector<Seen> seen = look(many.maker, many.probes, many.options);
    EXPECT_EQ(statusOf("lights.clusters").substr(0, 7), "skipped");
    for (const Seen& s : seen) EXPECT_EQ(s.clustered, s.lit);
    SceneMaker few;
    for (int i = 0; i < 16; ++i) few.pointLight(1, {double(i), 0, 0}, 0, 3);
    seen = look(few, many.probes);
    EXPECT_EQ(statusOf("lights.clusters").substr(0, 7), "skipped");
    for (const Seen& s : seen) EXPECT_EQ(s.clustered, s.lit);
}

TEST_P(LightsOnPoints, CutoffDropsNoMoreThanItSays) {
    ManyLights many(0, 1, 5); // no range: inverse squares without end
    lights().lightSettings().cutoff = 0.01f;
    lights().lightSettings().clusterCapacity = 1024;
    const std::vector<Seen> seen = look(many.maker, many.probes, many.options);
    // All lights together, from as far away as the scene's radius: the sum of candelas over its square.
    double candela = 0;
    for (const Light& light : many.maker.scene.lights) candela += double(light.intensity);
    const double radius = 0.5 * glm::length(dvec3(40, 20, 40));
    double mostDropped = 0;
    for (const Seen& s : seen) {
        EXPECT_GE(s.lit, s.clustered - 1e-5f * s.lit);
        mostDropped = std::max(mostDropped, double(s.lit - s.clustered));
    }
    EXPECT_GT(mostDropped, 0.0) << "far lights are dropped";
    EXPECT_LE(mostDropped, 0.0105 * candela / (radius * radius));
    // Averaged frames are exact.
    many.options.converge = true;
    for (const Seen& s : look(many.maker, many.probes, many.options)) EXPECT_EQ(s.clustered, s.lit);
}

TEST_P(LightsOnPoints, ListsSaveTimeWithManyLights) {
    ManyLights many(2);
    many.options.everyLight = false;
    // In view, as pixels are: elsewhere every light is looked at.
    many.probes.clear();
    std::mt19937 random{uint32_t(seed())};
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int i = 0; i < 4096; ++i) {
        const double distance =
            6 +
            38 * std::abs(unit(random)); // metres before the camera, whose half angle is 0.4 high
        many.probes.push_back(
            {many.options.eye + dvec3(0.5 * unit(random), 0.4 * unit(random), -1) * distance, kUp});
    }
    const auto timeOf = [&](int minimum) {
        lights().lightSettings().clusterMinimum = minimum;
        double least = 1e30;
        for (int run = 0; run < 4; ++run) {
            many.options.eye.x += 1e-3; // lists are made anew
            const auto start = std::chrono::steady_clock::now();
            look(many.maker, many.probes, many.options);
            least = std::min(least, std::chrono::duration<double, std::milli>(
                                        std::chrono::steady_clock::now() - start)
                                        .count());
        }
        return least;
    };
    const double withLists = timeOf(16), withoutLists = timeOf(100000);
    std::printf(
        "4096 probes and 1000 lights, a frame: %.1f ms with lists, making them included, %.1f ms without\n",
        withLists, withoutLists);
    EXPECT_LT(withLists, withoutLists);
}

} // namespace
} // namespace tyndall::test
