// However light is looked for, it is the same light; and it goes both ways alike.

#include <cmath>

#include "laws_fixture.h"

namespace tyndall::validation {
namespace {

enum class Lamp { Ball = 0, Rect = 1, Sun = 2, Sky = 3, Triangles = 4, Spot = 5, Flame = 6 };

void addLamp(SceneMaker& maker, Lamp lamp) {
    Light light;
    switch (lamp) {
    case Lamp::Ball: maker.addPointLight({0.8, 1.2, 0.3}, 12, 0.4); return;
    case Lamp::Rect:
        light.type = LightType::Rect;
        light.size = {1.2f, 0.8f};
        light.radiance = {9, 7, 5};
        maker.addLight(light, lookAlong({-0.4, -1, 0.1}, {0.6, 1.6, 0}));
        return;
    case Lamp::Sun:
        light.type = LightType::Directional;
        light.intensity = 4;
        light.radius = 0.25f;
        maker.addLight(light, lookAlong({-0.5, -1, -0.3}));
        return;
    case Lamp::Spot:
        light.type = LightType::Spot;
        light.intensity = 60;
        light.radius = 0.3f;
        light.range = 6;
        light.innerConeAngle = 0.3f;
        light.outerConeAngle = 0.8f;
        maker.addLight(light, lookAlong({-0.4, -1, 0}, {0.6, 1.8, 0}));
        return;
    case Lamp::Sky: {
        auto image = std::make_shared<Image>(8, 4, 3);
        for (size_t i = 0; i < image->pixels.size(); ++i)
            image->pixels[i] = i / 3 == 10 ? 6.0f : 0.2f + 0.05f * float(i % 7);
        maker.scene().environment.image = image;
        maker.scene().environment.rotation = 0.7f;
        return;
    }
    case Lamp::Flame: { // hot lumps, and a ball of gas over part of them
        Medium flame = matter(MediumKind::Grid, 0.3, 0);
        flame.density = lumpyGrid(1.5, 3, 77);
        std::vector<float> heat;
        for (int i = 0; i < 9 * 9 * 9; ++i) heat.push_back(float(1100 + 90 * (i / 9 % 9)));
        flame.temperature = std::make_shared<BrickGrid>(
            makeBrickGrid(heat, ivec3(-4), ivec3(9), glm::scale(dmat4(1.0), dvec3(0.25))));
        flame.temperatureScale = 0.01f;
        maker.addMedium(flame, {0.7, 0.5, 0.2});
        Medium gas;
        gas.kind = MediumKind::Sphere;
        gas.size = dvec3(0.6);
        gas.emission = {1, 2, 3};
        maker.addMedium(gas, {0.2, 0.6, 0.1});
        return;
    }
    case Lamp::Triangles: {
        Material glow = matt(vec3(0.2f));
        glow.emissive = {8, 6, 4};
        maker.addPrimitive(PrimitiveShape::Box, dvec3(0.7), glow,
                           lookAlong({0.3, 0.4, 1}, {0.6, 1.2, 0.2}));
        return;
    }
    }
}

std::shared_ptr<const Stage> room(Lamp lamp) {
    SceneMaker maker;
    Medium smoke = matter(MediumKind::Grid, 0.9, 0.3);
    smoke.density = lumpyGrid(2.6, 4, 31);
    maker.addMedium(smoke);
    Material shiny = matt({0.8f, 0.5f, 0.3f});
    shiny.specular = 1;
    shiny.roughness = 0.5f;
    maker.addPrimitive(PrimitiveShape::Plane, {5, 1, 5}, shiny,
                       lookAlong({0, 0, -1}, {0, -1.1, 0}));
    addLamp(maker, lamp);
    return Stage::make(maker.take());
}

class ReferenceAiming : public ::testing::TestWithParam<std::pair<Lamp, const char*>> {};

// T12.
TEST_P(ReferenceAiming, NotAtAllFromCollisionsAndFromSegmentsTooFindsTheSameLight) {
    const auto [lamp, name] = GetParam();
    const auto stage = room(lamp);
    reference::PathSettings none, collisions, ratio;
    none.nextEventEstimation = false;
    collisions.nextEventFromSegments = false;
    ratio.transmittance = tracing::TransmittanceMode::Ratio;
    const dvec3 eye(0.2, 0.5, 4), to(0, -0.4, 0);
    const Probe full = gaze(stage, eye, to, 0.8);
    const uint64_t seed = 700 + 10 * uint64_t(lamp);
    expectSameLight(full, gaze(stage, eye, to, 0.8, 1, none), seed,
                    std::string(name) + ": all and none", lamp == Lamp::Spot ? 1.5e6 : 5e5);
    expectSameLight(full, gaze(stage, eye, to, 0.8, 1, collisions), seed + 1,
                    std::string(name) + ": all and collisions");
    expectSameLight(full, gaze(stage, eye, to, 0.8, 1, ratio), seed + 2,
                    std::string(name) + ": exact and ratio tracking");
}

INSTANTIATE_TEST_SUITE_P(Lamps, ReferenceAiming,
                         ::testing::Values(std::pair(Lamp::Ball, "ball"),
                                           std::pair(Lamp::Rect, "rect"),
                                           std::pair(Lamp::Sun, "sun"), std::pair(Lamp::Sky, "sky"),
                                           std::pair(Lamp::Triangles, "triangles"),
                                           std::pair(Lamp::Spot, "spot"),
                                           std::pair(Lamp::Flame, "flame")),
                         [](const auto& about) { return std::string(about.param.second); });

/// What a clear ball of even glow sends past a point outside follows Newton's shell theorem: as if all of it came from the middle.
TEST(ReferenceLaws, AGlowingBallOfGasLightsAFloorAsFromItsMiddle) {
    SceneMaker maker;
    Medium gas;
    gas.kind = MediumKind::Sphere;
    gas.size = dvec3(1.6);
    gas.emission = vec3(5);
    maker.addMedium(gas, {0.3, 0.2, -0.4});
    maker.addPrimitive(PrimitiveShape::Plane, {5, 1, 5}, matt(vec3(0.5f)),
                       lookAlong({0, 0, -1}, {0, -1, 0}));
    const auto stage = Stage::make(maker.take());
    reference::PathSettings lit;
    lit.terms = bit(Term::LSE);
    for (const double x : {0.3, 1.1, -1.9}) {
        const dvec3 to(x, -1, 0.5), d = dvec3(0.3, 0.2, -0.4) - to;
        const double intensity = 5 * 4.0 / 3 * kPi * std::pow(0.8, 3);
        const double expected = 0.5 / kPi * intensity * d.y / std::pow(glm::dot(d, d), 1.5);
        Effort effort;
        effort.segments = 2e5;
        const Estimate light = measure(gaze(stage, {0.2, 2.5, 4}, to, 0, 1, lit), effort,
                                       tracing::mixBits(900 + uint64_t(10 * (x + 2))));
        const double t = (light.value - expected) / light.error;
        std::printf("at %g m: %.6g ± %.1g where %.6g is right, t %+.2f\n", x, light.value,
                    light.error, expected, t);
        EXPECT_LE(std::abs(t), kLargestT);
        EXPECT_LT(light.error, 0.005 * expected) << "too coarse to tell anything";
    }
}

// The shadow ray starts off the floor by a margin that grows with the floor: it must not end behind the box's face.
TEST(ReferenceLaws, AGlowingBoxLightsAWideFloorByAimingAsMuchAsByChance) {
    for (const double width : {5.0, 300.0}) {
        SceneMaker maker;
        maker.addPrimitive(PrimitiveShape::Plane, {width, 1, width}, matt(vec3(0.5f)),
                           lookAlong({0, 0, -1}, {0, -1.1, 0}));
        addLamp(maker, Lamp::Triangles);
        const auto stage = Stage::make(maker.take());
        reference::PathSettings none;
        none.nextEventEstimation = false;
        expectSameLight(gaze(stage, {0.2, 0.5, 4}, {0, -1.6, 0}, 0.3),
                        gaze(stage, {0.2, 0.5, 4}, {0, -1.6, 0}, 0.3, 1, none),
                        uint64_t(850 + width), "a floor of " + std::to_string(width) + " m");
    }
}

// T12 again, where channels differ in what they are scattered by and so in where to: red forwards, blue backwards, in one place.
TEST(ReferenceLaws, AConstantSkyThroughOverlappingColoursIsTheSameAimedAtOrNot) {
    SceneMaker maker;
    Medium red = matter(MediumKind::Sphere, 1, 0.9), blue = matter(MediumKind::Sphere, 1, -0.9);
    red.size = blue.size = dvec3(3);
    red.scattering = {2.0f, 0.7f, 0.05f};
    red.absorption = {0.05f, 0.3f, 0.8f};
    blue.scattering = {0.05f, 0.7f, 2.0f};
    blue.absorption = {0.8f, 0.3f, 0.05f};
    maker.addMedium(red);
    maker.addMedium(blue);
    maker.scene().environment.radiance = {1, 1, 1};
    const auto stage = Stage::make(maker.take());
    reference::PathSettings none;
    none.nextEventEstimation = false;
    for (const int channel : {0, 1, 2})
        expectSameLight(gaze(stage, {0, 0, 4}, dvec3(0), 1, channel),
                        gaze(stage, {0, 0, 4}, dvec3(0), 1, channel, none), uint64_t(870 + channel),
                        "channel " + std::to_string(channel), 3e6);
}

/// Fluence at `at` of a lamp of 1 W/sr at `lamp`, but for what comes straight from it.
Probe fluence(const Medium& smoke, const dvec3& lamp, const dvec3& at, bool surfaces) {
    SceneMaker maker;
    maker.addMedium(smoke);
    if (surfaces) {
        Material shiny = matt({0.7f, 0.7f, 0.7f});
        shiny.specular = 1;
        shiny.roughness = 0.6f;
        maker.addPrimitive(PrimitiveShape::Plane, {7, 1, 7}, shiny,
                           lookAlong({0, 0.2, -1}, {0, -0.8, 0}));
        maker.addPrimitive(PrimitiveShape::Box, {0.2, 0.5, 0.6}, matt(vec3(0.5f)),
                           lookAlong({0.3, 0, -1}, {0, -0.3, 0.1}));
    }
    maker.addPointLight(lamp, 1);
    Probe probe;
    probe.stage = Stage::make(maker.take());
    // Among surfaces two scatterings at most: of longer paths one in a hundred thousand passes the lamp so closely that it outweighs
    // all others.
    if (surfaces) probe.settings[0].maxScatterings = 2;
    // The radiance grows as 1/sin towards the lamp: angles are drawn evenly.
    const dvec3 towards = glm::normalize(lamp - at);
    probe.sample = [at, towards](Tracers& tracers, Sampler& sampler) {
        const dvec2 u = sampler.next2();
        const dvec3 direction =
            tracing::Frame(towards).toWorld(tracing::directionAround(std::cos(kPi * u.x), u.y));
        TermLight light;
        tracers[0].trace({{at, glm::normalize(direction)}, 0}, sampler, light);
        return light.sum().y * 0.5 * kPi * std::sin(kPi * u.x);
    };
    return probe;
}

// T14.
TEST(ReferenceLaws, ALampAndASensorCanChangePlaces) {
    const dvec3 a(-0.7, 0.3, 0.4), b(0.7, -0.3, -0.2);
    Medium smoke = matter(MediumKind::Grid, 0.95, 0.7);
    smoke.density = lumpyGrid(2.4, 1.5, 41);
    expectSameLight(fluence(smoke, a, b, false), fluence(smoke, b, a, false), 800, "smoke", 1.5e6);
    expectSameLight(fluence(smoke, a, b, true), fluence(smoke, b, a, true), 801,
                    "smoke and surfaces", 1.5e6);
}

// In a white world under a white sky nothing can be seen (T5).
TEST(ReferenceLaws, AWhiteWorldUnderAWhiteSkyIsWhite) {
    SceneMaker maker;
    Medium smoke = matter(MediumKind::Grid, 1, 0.9), haze = matter(MediumKind::Sphere, 1, -0.7);
    smoke.density = lumpyGrid(2, 20, 3);
    smoke.scattering = {0.4f, 1, 2.5f}; // albedo 1 in every colour
    haze.phase = PhaseFunction::CornetteShanks;
    haze.size = {3, 2, 1};
    maker.addMedium(smoke);
    maker.addMedium(haze, dvec3(0.4, 0, 0));
    maker.addPrimitive(PrimitiveShape::Box, dvec3(0.6), matt(vec3(1)),
                       lookAlong({0.3, 0.5, 0.8}, {0.2, -0.1, 0.3}));
    maker.addWhiteEnvironment();
    const auto stage = Stage::make(maker.take());
    for (int c = 0; c < 3; ++c) {
        Effort effort;
        effort.segments = 3e5;
        const Estimate seen =
            measure(gaze(stage, {0.3, 0.2, 4}, dvec3(0), 0.8, c), effort, 900 + uint64_t(c));
        std::printf("channel %d: %.6f ± %.6f\n", c, seen.value, seen.error);
        EXPECT_LE(std::abs(seen.value - 1), kLargestT * seen.error);
        EXPECT_LT(seen.error, 0.02);
    }
}

} // namespace
} // namespace tyndall::validation
