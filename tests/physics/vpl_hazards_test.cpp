// Where virtual point lights could blow up (validation.md, S10 to S14). The tests' renderer fails on values that are not finite, or negative.

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "gi_scenes.h"
#include "support/render.h"

namespace tyndall::test {
namespace {

Image pictureOf(const std::string& json, std::vector<std::string> settings, int frames = 1,
                int scale = 1, const ivec2& size = {33, 17}) {
    RenderOptions options;
    options.width = size.x * scale; // odd: the middle pixel's ray is the camera's axis
    options.height = size.y * scale;
    options.gi = "vpl";
    options.terms = kIndirect;
    options.frames = frames;
    options.settings = std::move(settings);
    options.settings.emplace_back("gi.vpl.march=full");
    return sharedRenderer().render(sceneFromJson(json), options).beauty;
}

double largestOverMean(const Image& image) {
    return double(*std::max_element(image.pixels.begin(), image.pixels.end())) / meanOf(image);
}

/// A box of fog around an eye that looks along a narrow beam from right before it.
std::string alongABeam(double anisotropy) {
    return fmt::format(
        R"({{"tyndall": 1, "nodes": [
        {{"name": "fog", "medium": {{"type": "homogeneous", "shape": "box", "size": [4, 4, 4], "scattering": [0.8, 0.8, 0.8],
            "absorption": [0.1, 0.1, 0.1], "anisotropy": {}}}}},
        {{"name": "beam", "light": {{"type": "spot", "intensity": 1e6, "outerConeAngle": 1e-3}}, "translation": [0, 0, 1]}},
        {{"name": "eye", "camera": {{"type": "perspective", "yfov": 0.8}}, "translation": [0, 0, 1.5]}}], "camera": "eye"}})",
        anisotropy);
}

TEST(VplHazards, ARayThroughAllLights) {
    // The first light of each walk lies on the ray of the middle pixel. None counts as nearer than the bound lets it, so that pixels beside it are as bright.
    for (const char* compensation : {"clamped", "traced"})
        for (const char* clamp : {"0", "1", "100"}) {
            const Image picture =
                pictureOf(alongABeam(0), {"gi.vpl.walks=64", fmt::format("gi.vpl.clamp={}", clamp),
                                          fmt::format("gi.vpl.compensation={}", compensation)});
            EXPECT_GT(meanOf(picture), 0) << compensation << ' ' << clamp;
            if (std::string(clamp) != "0") {
                EXPECT_LT(largestOverMean(picture), 5) << compensation << ' ' << clamp;
            }
        }
}

TEST(VplHazards, LightsInOnePlaceAreOneLight) {
    // A beam meets a white spot of the floor: each walk leaves its light there. What a dark screen gets of them is the closed form of one light.
    constexpr double kOuter = 1e-3, kWalks = 8192;
    const Scene scene = sceneFromJson(
        R"({"tyndall": 1, "nodes": [
        {"name": "floor", "primitive": {"shape": "plane", "size": [0.2, 0.2]}, "material": {"baseColor": [0.5, 0.5, 0.5], "specular": 0}},
        {"name": "screen", "primitive": {"shape": "plane", "size": [0.4, 0.4]}, "material": {"baseColor": [0.01, 0.01, 0.01], "specular": 0},
            "translation": [0.8, 0.6, 0], "rotation": [0, 0, 0.894427191, 0.447213595]},
        {"name": "lamp", "light": {"type": "spot", "intensity": 1e9, "outerConeAngle": 1e-3}, "translation": [0, 0.9, 0],
            "rotation": [-0.7071067811865476, 0, 0, 0.7071067811865476]},
        {"name": "eye", "camera": {"type": "orthographic", "ymag": 0.01, "znear": 0.01}, "translation": [0.4, 0.3, 0],
            "rotation": [0.22360680, -0.67082039, 0.22360680, 0.67082039]}], "camera": "eye"})");
    RenderOptions options;
    options.width = options.height = 5;
    options.gi = "vpl";
    options.terms = kIndirectOnSurfaces;
    options.settings = {fmt::format("gi.vpl.walks={}", kWalks), "gi.vpl.mapSide=4"};
    // KHR_lights_punctual: the square of the cosine's way to the cone's edge, over 0.001 at least.
    const double w = 1 - std::cos(kOuter), power = 1e9 * 2 * kPi * w * w * w / 3e-6;
    const double expected = power * 0.5 / kPi * 0.6 * 0.01 / kPi; // 1 m away, at a cosine of 0.6
    const double found = meanOf(sharedRenderer().render(scene, options).beauty);
    printf("lights in one place: %.4f of the closed form\n", found / expected);
    // Powers of walks are squares of even numbers: a relative variance of 0.8. And 1 % of light comes back from the screen.
    EXPECT_NEAR(found / expected, 1, 4 * std::sqrt(0.8 / kWalks) + 0.01);
}

TEST(VplHazards, SharpPhaseFunctions) {
    // Of lights that face the eye no pixel gets more than a thousand times the mean up to |g| = 0.9; beyond, spots are brighter (docs/techniques/vpl.md), but finite.
    for (const double g : {-0.999, -0.99, -0.9, 0.9, 0.99, 0.999}) {
        const std::string fog = fmt::format(
            R"({{"name": "fog", "medium": {{"type": "homogeneous", "shape": "box", "size": [4, 3, 4], "scattering": [0.3, 0.3, 0.3],
                "absorption": [0, 0.1, 0.2], "anisotropy": {}}}, "translation": [0, 1.5, 0]}},)",
            g);
        const Image picture = pictureOf(corner(50, fog), {"gi.vpl.walks=128"}, 1, 3);
        printf("g %g: brightest pixel %.0f times the mean\n", g, largestOverMean(picture));
        EXPECT_GT(meanOf(picture), 0) << g;
        EXPECT_GT(meanOf(pictureOf(alongABeam(g), {"gi.vpl.walks=64"})), 0) << g;
        if (std::abs(g) <= 0.9) {
            EXPECT_LT(largestOverMean(picture), 1e3) << g;
        }
    }
}

/// Slabs of fog with gaps between them, and many lamps.
std::string slabsAndLamps() {
    std::string nodes;
    for (int i = 0; i < 8; ++i)
        nodes += fmt::format(
            R"({{"name": "fog {0}", "medium": {{"type": "homogeneous", "shape": "box", "size": [4, 4, 0.25], "scattering": [1, 1, 1],
                "absorption": [0.002, 0.002, 0.002]}}, "translation": [0, 0, {1}]}},)",
            i, 0.5 * i - 1.75);
    for (int i = 0; i < 24; ++i)
        nodes += fmt::format(
            R"({{"name": "lamp {0}", "light": {{"type": "point", "intensity": 1}}, "translation": [{1}, {2}, {3}]}},)",
            i, 0.8 * (i % 6) - 2, 0.9 * (i / 6) - 1.35, 0.37 * (i % 7) - 1.1);
    return R"({"tyndall": 1, "nodes": [)" + nodes +
           R"({"name": "eye", "camera": {"type": "perspective", "yfov": 0.8}, "translation": [0, 0, 6]}], "camera": "eye"})";
}

TEST(VplHazards, NoPointOfARayIsLostHoweverManyTheyAre) {
    // A driver that ends a shader's loops after 65,535 rounds would leave out the last points of a ray, and divide by what it has not come to.
    const auto light = [](int points) {
        return meanOf(pictureOf(slabsAndLamps(),
                                {"gi.vpl.walks=32", "gi.vpl.candidates=1",
                                 fmt::format("gi.vpl.samples={}", points)},
                                1, 1, {11, 5}));
    };
    const double few = light(64), many = light(256);
    printf("256 points bring %.4f of the light of 64\n", many / few);
    // Of the same virtual lights. Their noise along a ray, with one walk in two to eight at each of 64 points in 55 pixels, is below 1 %.
    EXPECT_NEAR(many / few, 1, 0.03);
}

} // namespace
} // namespace tyndall::test
