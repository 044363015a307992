// Virtual point lights in pictures: what is theirs alone. technique_laws_test.cpp has what holds for all techniques.

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/image_metrics.h"
#include "gi_scenes.h"
#include "support/render.h"

namespace tyndall::test {
namespace {

const std::string kFog =
    R"({"name": "fog", "medium": {"type": "homogeneous", "shape": "box", "size": [4, 3, 4], "scattering": [0.3, 0.3, 0.3],
    "absorption": [0, 0.1, 0.2], "anisotropy": 0.5}, "translation": [0, 1.5, 0]},)";

const std::vector<std::string> kFew = {"gi.vpl.walks=32", "gi.vpl.mapSide=32", "gi.vpl.samples=8"};

RenderOptions optionsWith(std::vector<std::string> settings, TermSet terms = kIndirect) {
    RenderOptions options;
    options.width = 48;
    options.height = 27;
    options.gi = "vpl";
    options.terms = terms;
    options.settings = std::move(settings);
    return options;
}

TEST(Vpl, AClosedRoomStaysDarkByPoints) {
    // Walls of 2 cm are far thinner than what a map's texel covers, and lie askew to everything.
    for (const double thickness : {0.02, 0.3}) {
        const std::vector<std::string> settings = {"gi.vpl.walks=128", "gi.vpl.maps=points",
                                                   "gi.vpl.points=8192"};
        const double inside =
            indirectMean("vpl", sceneFromJson(sealedRoom(thickness, 0.3, true)), settings);
        const double outside =
            indirectMean("vpl", sceneFromJson(sealedRoom(thickness, 0.3, false)), settings);
        printf("walls of %.2f m: %.2e of the light outside\n", thickness, inside / outside);
        EXPECT_GT(outside, 0);
        EXPECT_LT(inside, 1e-4 * outside);
    }
}

TEST(Vpl, WhereNothingChangesNothingIsMadeAnew) {
    RenderOptions options = optionsWith(kFew);
    const Scene scene = sceneFromJson(corner(50, kFog));
    sharedRenderer().render(scene, options);
    const Rendered again = sharedRenderer().render(scene, options);
    for (const char* pass : {"gi.vpl.lights", "gi.vpl.walks", "gi.vpl.maps", "gi.traced.triangles"})
        EXPECT_EQ(again.passes.at(pass).substr(0, 6), "cached") << pass;
}

TEST(Vpl, AVeilOutOfViewDimsWhatIsInView) {
    // A lamp above the veil, an eye below it that looks down at the floor: all light of the lamp and of the ceiling crosses the veil's depth of 5 or more.
    const auto mean = [](int absorption) {
        const Scene scene = sceneFromJson(fmt::format(
            R"({{"tyndall": 1, "nodes": [
            {{"name": "floor", "primitive": {{"shape": "plane", "size": [6, 6]}}}},
            {{"name": "ceiling", "primitive": {{"shape": "box", "size": [6, 0.1, 6]}}, "translation": [0, 3, 0]}},
            {{"name": "veil", "medium": {{"type": "homogeneous", "shape": "box", "size": [20, 0.5, 20], "scattering": [0, 0, 0],
                "absorption": [{0}, {0}, {0}]}}, "translation": [0, 1.5, 0]}},
            {{"name": "lamp", "light": {{"type": "point", "intensity": 100}}, "translation": [0, 2.5, 0]}},
            {{"name": "eye", "camera": {{"type": "perspective", "yfov": 0.6, "znear": 0.01}}, "translation": [0, 1, 0],
                "rotation": [-0.70710678, 0, 0, 0.70710678]}}], "camera": "eye"}})",
            absorption));
        return meanOf(
            sharedRenderer().render(scene, optionsWith(kFew, kIndirectOnSurfaces)).beauty);
    };
    EXPECT_GT(mean(0), 0);
    EXPECT_LT(mean(10), std::exp(-5.0) * mean(0));
}

TEST(Vpl, ReceiversAndSourcesCanBeLeftOut) {
    const Scene scene = sceneFromJson(corner(50, kFog));
    const auto mean = [&](std::vector<std::string> settings, TermSet terms) {
        settings.insert(settings.end(), kFew.begin(), kFew.end());
        return meanOf(sharedRenderer().render(scene, optionsWith(settings, terms)).beauty);
    };
    const double all = mean({}, kIndirect), surfaces = mean({}, kIndirectOnSurfaces),
                 media = mean({}, kIndirectInMedia);
    EXPECT_GT(surfaces, 0);
    EXPECT_GT(media, 0);
    EXPECT_NEAR((surfaces + media) / all, 1, 1e-5);
    // On surfaces nothing but the lights themselves counts where nothing makes up for the bound.
    const std::string clamped = "gi.vpl.compensation=clamped", every = "gi.vpl.surfaceClasses=1";
    const double fromBoth = mean({clamped, every}, kIndirectOnSurfaces),
                 fromSurfaces =
                     mean({clamped, every, "gi.vpl.fromMedia=false"}, kIndirectOnSurfaces),
                 fromMedia =
                     mean({clamped, every, "gi.vpl.fromSurfaces=false"}, kIndirectOnSurfaces);
    EXPECT_GT(fromSurfaces, 0);
    EXPECT_GT(fromMedia, 0);
    // The bound follows from the mean distance of the lights that are kept.
    EXPECT_NEAR((fromSurfaces + fromMedia) / fromBoth, 1, 0.05);
}

TEST(Vpl, ExtremesStayFinite) {
    // The renderer of the tests fails on invalid pixels. An eye inside of the fog, sharp phase functions, a bright lamp, lights upon lights.
    for (const double g : {-0.99, 0.99})
        for (const char* clamp : {"0", "1", "100"}) {
            const Scene scene = sceneFromJson(corner(
                1e6,
                fmt::format(
                    R"({{"name": "fog", "medium": {{"type": "homogeneous", "shape": "box", "size": [14, 14, 14], "scattering": [2, 2, 2],
                    "absorption": [0, 0, 0], "anisotropy": {}}}}},)",
                    g)));
            std::vector<std::string> settings = kFew;
            settings.push_back(fmt::format("gi.vpl.clamp={}", clamp));
            settings.push_back("gi.vpl.walks=8");
            EXPECT_GT(indirectMean("vpl", scene, settings), 0) << g << ' ' << clamp;
        }
}

/// Gold and blue plaster in turn, texel by texel, on all surfaces; neighbouring pixels share no colour.
Scene cornerOfMetalAndPlaster() {
    Scene scene = sceneFromJson(corner(50, ""));
    constexpr int kSide = 256;
    ImageData base, metal;
    base.width = base.height = metal.width = metal.height = kSide;
    for (int i = 0; i < kSide * kSide; ++i) {
        const bool gold = (i % kSide + i / kSide) % 2 == 0;
        base.rgba.insert(base.rgba.end(), {uint8_t(gold ? 255 : 60), uint8_t(gold ? 200 : 90),
                                           uint8_t(gold ? 80 : 230), 255});
        metal.rgba.insert(metal.rgba.end(), {0, 230, uint8_t(gold ? 255 : 0), 255});
    }
    for (ImageData* image : {&base, &metal}) {
        Texture texture;
        texture.image = int(scene.images.size());
        texture.sampler = {Filter::Nearest, Filter::Nearest, MipFilter::None, Wrap::Repeat,
                           Wrap::Repeat};
        scene.images.push_back(std::move(*image));
        scene.textures.push_back(texture);
    }
    for (Material& material : scene.materials) {
        material.baseColor = vec4(1);
        material.metallic = material.roughness = material.specular = 1;
        material.baseColorTexture.texture = int(scene.textures.size()) - 2;
        material.metallicRoughnessTexture.texture = int(scene.textures.size()) - 1;
    }
    return scene;
}

class FewerSurfaces : public testing::TestWithParam<bool> {};

TEST_P(FewerSurfaces, ShowTheSame) {
    const Scene scene = GetParam() ? cornerOfMetalAndPlaster() : sceneFromJson(corner(50, kFog));
    RenderOptions options = optionsWith(
        {"gi.vpl.walks=64", "gi.vpl.candidates=1", "gi.vpl.compensation=clamped",
         "gi.vpl.surfaces.resolution=full"},
        kIndirectOnSurfaces);
    options.width = 192;
    options.height = 108;
    const Image every = sharedRenderer().render(scene, options).beauty;
    for (const char* resolution : {"half", "quarter"}) {
        options.settings.back() = fmt::format("gi.vpl.surfaces.resolution={}", resolution);
        const ImageMetrics found =
            compareImages(sharedRenderer().render(scene, options).beauty, every).value();
        printf("%s: relmse %.5f, energy %.4f\n", resolution, found.relmse, found.energy);
        EXPECT_LT(found.relmse, 0.02) << resolution;
        // Light is interpolated over 4 pixels of 108 at most, and takes some 10 % of its value in them beside the lamp and the corner.
        // Highlights of metal are as wide as 4 pixels.
        EXPECT_NEAR(found.energy, 1, GetParam() ? 0.04 : 0.02) << resolution;
    }
}

INSTANTIATE_TEST_SUITE_P(Of, FewerSurfaces, testing::Bool(), [](const auto& which) {
    return which.param ? "MetalAndPlaster" : "Plaster";
});

} // namespace
} // namespace tyndall::test
