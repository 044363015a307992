#include "renderer/medium_lights.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace tyndall {
namespace {

constexpr int kFrames = 4096;

/// One node with a medium that emits 2, 3 and 4 nits per metre, at (1, 2, 3).
Scene glowing(MediumKind kind, const dvec3& size, const dvec3& scale = dvec3(1)) {
    Scene scene;
    Medium medium;
    medium.kind = kind;
    medium.size = size;
    medium.emission = {2, 3, 4};
    scene.media.push_back(medium);
    Node node;
    node.name = "glow";
    node.medium = 0;
    node.translation = {1, 2, 3};
    node.scale = scale;
    scene.nodes.push_back(node);
    return scene;
}

MediumEmitters find(const Scene& scene, int parts) {
    return findMediumEmitters(scene, scene.worldTransforms(), scene.worldVisibility(), parts);
}

dvec3 sumOf(const std::vector<MediumLight>& lights) {
    dvec3 sum(0);
    for (const MediumLight& light : lights) sum += light.intensity;
    return sum;
}

/// Mean over frames of Σ I·f(position).
template <typename F> double average(const MediumEmitter& emitter, F f) {
    double sum = 0;
    for (int i = 0; i < kFrames; ++i)
        for (const MediumLight& light : emitter.sample(uint32_t(i), 5))
            sum += light.intensity.y * f(light.position);
    return sum / kFrames;
}

TEST(MediumLights, ABoxGivesItsVolumeTimesItsEmissionAndItsMoments) {
    const Scene scene = glowing(MediumKind::Box, {2, 1, 0.5}, {1, 3, 1}); // 2 × 3 × 0.5 m
    const MediumEmitters found = find(scene, 4);
    ASSERT_EQ(found.emitters.size(), 1u);
    EXPECT_TRUE(found.notes.empty());
    const MediumEmitter& box = found.emitters[0];
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(box.intensity()[c], 3.0 * (2 + c), 1e-9);
        EXPECT_NEAR(sumOf(box.lights())[c], 3.0 * (2 + c), 1e-9);
    }
    // As one ball: its mean square distance from the middle, 3/5 R², is the box'.
    const double spread = (4 + 9 + 0.25) / 12;
    EXPECT_NEAR(find(scene, 1).emitters[0].lights()[0].radius, std::sqrt(spread * 5 / 3), 1e-9);
    EXPECT_EQ(box.lights().size(), 4u);
    EXPECT_EQ(box.sample(0, 5).size(), 4u);
    // ∫ x dV / V is the middle, ∫ (x-middle)² dV / V a twelfth of the side squared. A thousandth is the sequence's own error.
    EXPECT_NEAR(average(box, [](dvec3 p) { return p.y; }) / 9, 2, 2e-3);
    EXPECT_NEAR(average(box, [](dvec3 p) { return (p.y - 2) * (p.y - 2); }) / 9, 9.0 / 12, 1e-3);
    EXPECT_NEAR(average(box, [](dvec3 p) { return (p.x - 1) * (p.z - 3); }) / 9, 0, 1e-3);
    for (const MediumLight& light : box.lights()) {
        EXPECT_LT(std::abs(light.position.x - 1), 1);
        EXPECT_LT(std::abs(light.position.y - 2), 1.5);
        EXPECT_LT(std::abs(light.position.z - 3), 0.25);
    }
}

TEST(MediumLights, ABallAsOneLightIsThatBall) {
    const Scene scene = glowing(MediumKind::Sphere, dvec3(1), dvec3(4)); // radius 2
    const MediumEmitter ball = find(scene, 1).emitters.at(0);
    const double volume = 4.0 / 3 * kPi * 8;
    // 32³ points stand for the ball's volume, of which the surface passes every tenth cell.
    EXPECT_NEAR(ball.intensity().x, 2 * volume, 0.01 * 2 * volume);
    ASSERT_EQ(ball.lights().size(), 1u);
    EXPECT_NEAR(glm::length(ball.lights()[0].position - dvec3(1, 2, 3)), 0, 1e-9);
    EXPECT_NEAR(ball.lights()[0].radius, 2, 0.02);
    // Points of the sequence know the ball itself: a third of the cells are cut by its surface, where they are in or out by chance,
    // which leaves 0.3/√4096 = 0.5 % of noise.
    EXPECT_NEAR(average(ball, [](dvec3) { return 1.0; }), 3 * volume, 0.01 * 3 * volume);
    const double outside =
        average(ball, [](dvec3 p) { return glm::length(p - dvec3(1, 2, 3)) > 2 ? 1.0 : 0.0; });
    EXPECT_EQ(outside, 0);
}

TEST(MediumLights, AFlameIsTheSumOverItsVoxelsOfDensityTimesPlancksLaw) {
    // Density falls and heat rises along x; the temperature grid is coarser and moved. Both are trilinear.
    std::vector<float> density, heat;
    for (int i = 0; i < 20 * 20 * 20; ++i) density.push_back(float(20 - i % 20) / 20);
    for (int i = 0; i < 13 * 13 * 13; ++i) heat.push_back(float(1000 + 60 * (i % 13)));
    Scene scene = glowing(MediumKind::Grid, dvec3(1), dvec3(0.5));
    Medium& flame = scene.media[0];
    flame.emission = vec3(0);
    flame.temperatureScale = 0.01f;
    flame.density = std::make_shared<BrickGrid>(
        makeBrickGrid(density, {0, 0, 0}, ivec3(20), glm::scale(dmat4(1), dvec3(0.1))));
    flame.temperature = std::make_shared<BrickGrid>(
        makeBrickGrid(heat, {0, 0, 0}, ivec3(13),
                      glm::translate(glm::scale(dmat4(1), dvec3(0.17)), dvec3(-0.4, 0.1, 0))));
    const dmat4 world = scene.worldTransforms()[0];
    // The slow, obvious sum: points half a voxel apart over all that is not empty.
    dvec3 expected(0);
    const int n = 40;
    const double step = 2.2 / n;
    for (int i = 0; i < n * n * n; ++i) {
        const dvec3 p = (dvec3(i % n, i / n % n, i / (n * n)) + 0.5) * step - 0.15;
        const dvec3 inHeat = dvec3(glm::inverse(flame.temperature->worldFromIndex) * dvec4(p, 1));
        expected += flame.density->sample(p / 0.1) * 0.01 *
                    blackbodyRadiance(flame.temperature->sample(inHeat));
    }
    expected *= std::pow(step, 3) * std::abs(glm::determinant(dmat3(world)));
    for (const int parts : {1, 3, 8}) {
        const MediumEmitter emitter = find(scene, parts).emitters.at(0);
        EXPECT_EQ(int(emitter.lights().size()), parts);
        for (int c = 0; c < 2; ++c) { // blue is a thousandth of the light
            EXPECT_NEAR(sumOf(emitter.lights())[c] / expected[c], 1, 0.01) << c;
            EXPECT_NEAR(emitter.intensity()[c] / expected[c], 1, 0.01) << c;
        }
        EXPECT_NEAR(average(emitter, [](dvec3) { return 1.0; }) / expected.y, 1, 0.01);
    }
}

/// At a flame's foot heat is gone from one voxel to the next: a cell's light comes from one face of it, and even inner points of the
/// cell may be too cool to glow, as at 900 K. No point may stand for much more than its part's light, and none for nonsense.
TEST(MediumLights, NoPointStandsForManyTimesItsPart) {
    for (const float kelvin : {900.0f, 1500.0f}) {
        std::vector<float> density(size_t(16 * 16 * 16), 1), heat;
        for (int i = 0; i < 16 * 16 * 16; ++i)
            heat.push_back(i / 256 == 7 || i / 256 == 8 ? kelvin : 0.0f);
        Scene scene = glowing(MediumKind::Grid, dvec3(1));
        Medium& flame = scene.media[0];
        flame.emission = vec3(0);
        flame.temperatureScale = 0.01f;
        const dmat4 tenth = glm::scale(dmat4(1), dvec3(0.1));
        flame.density =
            std::make_shared<BrickGrid>(makeBrickGrid(density, {0, 0, 0}, ivec3(16), tenth));
        flame.temperature =
            std::make_shared<BrickGrid>(makeBrickGrid(heat, {0, 0, 0}, ivec3(16), tenth));
        const MediumEmitter emitter = find(scene, 1).emitters.at(0);
        double strongest = 0;
        for (int i = 0; i < kFrames; ++i) {
            const double intensity = emitter.sample(uint32_t(i), 5).at(0).intensity.x;
            ASSERT_TRUE(std::isfinite(intensity)) << kelvin << " K, frame " << i;
            strongest = std::max(strongest, intensity);
        }
        // Simpson's rule gives a glowing face of a cell a sixth of what it would be if the cell glowed throughout.
        EXPECT_LT(strongest, 6.5 * emitter.intensity().x) << kelvin << " K";
    }
}

TEST(MediumLights, PointsStandForTheirPartFromAShortDistanceOn) {
    // However small the glow, here a single voxel, that distance is not 0; of several media the least holds for all.
    Scene scene = glowing(MediumKind::Grid, dvec3(1));
    scene.media[0].density = std::make_shared<BrickGrid>(makeBrickGrid(
        std::vector<float>{1}, {0, 0, 0}, ivec3(1), glm::scale(dmat4(1), dvec3(0.1))));
    const double spark = find(scene, 4).nearDistance;
    EXPECT_GT(spark, 0.001);
    EXPECT_LT(spark, 0.1);
    const double box = find(glowing(MediumKind::Box, {20, 20, 20}), 4).nearDistance;
    EXPECT_GT(box, 0.1);
    scene.media.push_back(glowing(MediumKind::Box, {20, 20, 20}).media[0]);
    scene.nodes.push_back(scene.nodes[0]);
    scene.nodes[1].medium = 1;
    EXPECT_EQ(find(scene, 4).nearDistance, spark);
    EXPECT_TRUE(std::isinf(find(Scene{}, 4).nearDistance));
}

TEST(MediumLights, WhatHasNoEndLightsNothingAndSaysSo) {
    for (const MediumKind kind : {MediumKind::Everywhere, MediumKind::Height}) {
        const MediumEmitters found = find(glowing(kind, dvec3(1)), 4);
        EXPECT_TRUE(found.emitters.empty());
        ASSERT_EQ(found.notes.size(), 1u);
        EXPECT_NE(found.notes[0].find("'glow'"), std::string::npos);
    }
    Scene dark = glowing(MediumKind::Box, dvec3(1));
    dark.media[0].emission = vec3(0);
    EXPECT_TRUE(find(dark, 4).emitters.empty());
    // Without extent, or with no lights asked for: no light, and nothing breaks.
    const Scene flat = glowing(MediumKind::Box, dvec3(1), dvec3(1, 0, 1));
    const Scene box = glowing(MediumKind::Box, dvec3(1));
    EXPECT_TRUE(find(flat, 4).emitters.at(0).lights().empty());
    EXPECT_TRUE(find(box, 0).emitters.at(0).sample(3, 5).empty());
}

} // namespace
} // namespace tyndall
