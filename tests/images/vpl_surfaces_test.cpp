// Light between surfaces by virtual point lights against the path tracer: whatever the bound, and behind what has holes.

#include <gtest/gtest.h>

#include "vpl_truth.h"

namespace tyndall::test {
namespace {

const std::string kLamp = R"(
    {"name": "lamp", "light": {"type": "point", "intensity": 10, "radius": 0.05}, "translation": [-1, 0.5, 0.2]},)";
/// Beside a wall and beneath a shelf: light from near by matters.
const std::string kShelf = R"(
    {"name": "shelf", "primitive": {"shape": "box", "size": [1, 0.05, 0.6]}, "material": {"baseColor": [0.7, 0.7, 0.7], "roughness": 0.4}, "translation": [0.8, -0.6, -0.8]},
    {"name": "block", "primitive": {"shape": "box", "size": [0.5, 0.5, 0.5]}, "material": {"baseColor": [0.6, 0.4, 0.2], "roughness": 0.5}, "translation": [-0.4, -0.75, -1.1]},)";

Case shelf(const char* name, std::vector<std::string> settings) {
    settings.emplace_back("gi.vpl.walks=128");
    // Twice the noise that 24 frames have; the roughness of the shelf's highlights, held, costs a percent.
    return {name, kDarkRoom + kShelf + kLamp, 0.01, 0.02, kIndirectOnSurfaces, settings};
}

TEST(VplBetweenSurfaces, TheMeanIsTheSameOverADecadeOfBounds) {
    // Below half the mean distance single lights beside a pixel outshine its average: their mean is right, but 24 frames do not show it.
    expectTheTruth(shelf("bound at 0.5", {"gi.vpl.surfaceClamp=0.5"}));
    expectTheTruth(shelf("bound at 2", {"gi.vpl.surfaceClamp=2", "gi.vpl.nearPaths=4"}));
    expectTheTruth(shelf("bound at 5, 8 paths", {"gi.vpl.surfaceClamp=5", "gi.vpl.nearPaths=8"}));
    // That the paths bring it: without them the bound costs light.
    const Case without = shelf("bound at 5, none", {"gi.vpl.surfaceClamp=5", "gi.vpl.nearPaths=0"});
    EXPECT_LT(againstTruth(sceneOf(without), without).energy, 0.95);
}

TEST(VplBetweenSurfaces, AlsoInColouredFog) {
    Case about = shelf("in coloured fog", {"gi.vpl.surfaceClamp=2", "gi.vpl.nearPaths=4"});
    about.nodes +=
        R"({"name": "fog", "medium": {"type": "homogeneous", "shape": "box", "size": [3, 2, 3], "scattering": [0.3, 0.2, 0.1],
        "absorption": [0, 0.1, 0.2], "anisotropy": 0.3}},)";
    about.relmse = 0.015; // three channels of one walk
    about.energy = 0.03;
    expectTheTruth(about);
}

TEST(VplBetweenSurfaces, AScreenWithHolesLetsHalfOfTheLightThrough) {
    // Holes as large as pieces of triangles, whose edges are in eight parts: nothing is left to chance.
    Case about{"behind a screen",
               kDarkRoom + kLamp + R"(
        {"name": "screen", "primitive": {"shape": "plane", "size": [2, 3]}, "material": {"baseColor": [0.8, 0.8, 0.8], "specular": 0, "doubleSided": true},
            "translation": [0.3, 0, 0], "rotation": [0, 0, 0.7071067811865476, 0.7071067811865476]},)",
               0.01,
               0.02,
               kIndirectOnSurfaces,
               {"gi.vpl.walks=128"}};
    Scene scene = sceneOf(about);
    constexpr int kSide = 4;
    ImageData image;
    image.width = image.height = kSide;
    for (int i = 0; i < kSide * kSide; ++i)
        image.rgba.insert(image.rgba.end(),
                          {255, 255, 255, uint8_t((i % kSide + i / kSide) % 2 == 0 ? 255 : 0)});
    Texture texture;
    texture.image = int(scene.images.size());
    texture.sampler = {Filter::Nearest, Filter::Nearest, MipFilter::None, Wrap::Repeat,
                       Wrap::Repeat};
    scene.images.push_back(std::move(image));
    scene.textures.push_back(texture);
    bool found = false;
    for (Material& material : scene.materials)
        if (material.doubleSided) {
            material.baseColorTexture.texture = int(scene.textures.size()) - 1;
            material.alphaMode = AlphaMode::Mask;
            found = true;
        }
    ASSERT_TRUE(found);
    expectTheTruth(scene, about);
}

} // namespace
} // namespace tyndall::test
