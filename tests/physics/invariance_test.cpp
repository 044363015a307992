// Statements that need no reference: scale, equal descriptions of one medium, what is skipped when nothing needs it.

#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "scene/scene_file.h"
#include "support/content.h"
#include "support/render.h"

namespace tyndall::test {
namespace {

double relmse(const Image& v, const Image& r) {
    double mean = 0;
    for (float value : r.pixels) mean += double(value) / double(r.pixels.size());
    double sum = 0;
    for (size_t i = 0; i < r.pixels.size(); ++i) {
        const double d = double(v.pixels[i]) - double(r.pixels[i]);
        sum += d * d / (double(r.pixels[i]) * double(r.pixels[i]) + 0.01 * mean * mean);
    }
    return sum / double(r.pixels.size());
}

double mean(const Image& image) {
    double sum = 0;
    for (float value : image.pixels) sum += double(value);
    return sum / double(image.pixels.size());
}

/// A room corner, a column, fog in a box, a ball of smoke, haze and three lights; lengths times `s`, candela times s², σ over s.
Scene testScene(double s, const std::string& media = "") {
    const std::string fog =
        media.empty()
            ? fmt::format(
                  R"(,{{"name": "fog", "medium": {{"type": "homogeneous", "shape": "box", "size": [{0}, {1}, {0}], "scattering": [{2}, {2}, {3}], "absorption": [{4}, {4}, {4}], "anisotropy": 0.4}}, "translation": [0, {5}, 0]}},
            {{"name": "ball", "medium": {{"type": "homogeneous", "shape": "sphere", "size": [{1}, {1}, {1}], "scattering": [{3}, {2}, {2}], "absorption": [0, 0, 0]}}, "translation": [{5}, {5}, 0]}},
            {{"name": "haze", "medium": {{"type": "homogeneous", "shape": "height", "scaleHeight": {0}, "scattering": [{4}, {4}, {4}], "absorption": [0, 0, 0]}}}})",
                  4 * s, 1.5 * s, 0.6 / s, 0.8 / s, 0.05 / s, 0.75 * s)
        : media == "none" ? ""
                          : media;
    return sceneFromJson(fmt::format(
        R"({{"tyndall": 1, "nodes": [
          {{"name": "floor", "primitive": {{"shape": "box", "size": [{0}, {1}, {0}]}}, "translation": [0, {2}, 0], "material": {{"baseColor": [0.7, 0.6, 0.5], "metallic": 0, "roughness": 0.6}}}},
          {{"name": "wall", "primitive": {{"shape": "box", "size": [{0}, {0}, {1}]}}, "translation": [0, 0, {3}], "material": {{"baseColor": [0.5, 0.6, 0.7], "metallic": 0, "roughness": 1}}}},
          {{"name": "column", "primitive": {{"shape": "cylinder", "size": [{4}, {5}, {4}]}}, "translation": [{6}, {7}, 0], "material": {{"baseColor": [0.9, 0.8, 0.3], "metallic": 1, "roughness": 0.4}}}},
          {{"name": "sun", "light": {{"type": "directional", "intensity": 8}}, "rotation": [-0.4, 0.2, 0.1, 0.9]}},
          {{"name": "lamp", "light": {{"type": "point", "intensity": {8}}}, "translation": [{4}, {5}, {4}]}},
          {{"name": "torch", "light": {{"type": "spot", "intensity": {9}, "outerConeAngle": 0.6}}, "translation": [{6}, {10}, {4}], "rotation": [-0.5, 0, 0, 0.866]}}
          {11},
          {{"name": "eye", "camera": {{"type": "perspective", "yfov": 0.9, "znear": {12}}}, "translation": [0, {5}, {10}]}}], "camera": "eye"}})",
        10 * s, 0.2 * s, -0.1 * s, -3 * s, 0.5 * s, 1.6 * s, -0.8 * s, 0.8 * s, 20 * s * s,
        40 * s * s, 4 * s, fog, 0.05 * s));
}

RenderOptions options(int frames = 1) {
    RenderOptions o;
    o.width = 64;
    o.height = 48;
    o.frames = frames;
    return o;
}

TEST(Invariance, TheSamePictureAtEveryScale) {
    const Rendered metres = sharedRenderer().render(testScene(1), options());
    for (double scale : {1e-3, 1e3}) {
        const Rendered scaled = sharedRenderer().render(testScene(scale), options());
        const double error = relmse(scaled.beauty, metres.beauty);
        std::printf("scale %g: relmse %.2e\n", scale, error);
        EXPECT_LE(error, 1e-3);
        EXPECT_NEAR(mean(scaled.beauty) / mean(metres.beauty), 1, 1e-3);
    }
}

TEST(Invariance, FarFromTheOriginTheSamePicture) {
    Scene near = testScene(1);
    Scene far = near;
    for (Node& node : far.nodes)
        if (node.parent == kNone) node.translation += dvec3(1e6, 0, -1e6);
    far.versions.transforms = nextVersion();
    EXPECT_LE(relmse(sharedRenderer().render(far, options()).beauty,
                     sharedRenderer().render(near, options()).beauty),
              1e-3);
}

/// The test scene, and far behind the eye a thing too small to be seen from here: a black box, fog, or a lamp that is out.
Scene withSpeck(const std::string& media, const std::string& thing, double distance) {
    return testScene(1, media + fmt::format(R"(,{{"name": "speck", "translation": [0, 1, {}], {}}})",
                                            distance, thing));
}

TEST(Invariance, WhatIsFarAwayAndUnseenChangesNothing) {
    const std::string fog =
        R"(,{"name": "fog", "medium": {"type": "homogeneous", "shape": "box", "size": [4, 1.5, 4], "scattering": [0.6, 0.6, 0.8], "absorption": [0.05, 0.05, 0.05]}, "translation": [0, 0.75, 0]})";
    for (const int frames : {1, 4}) {
        const Image alone = sharedRenderer().render(testScene(1, fog), options(frames)).beauty;
        for (const std::string thing :
             {R"("primitive": {"shape": "box", "size": [0.1, 0.1, 0.1]}, "material": {"baseColor": [0, 0, 0], "specular": 0})",
              R"("medium": {"type": "homogeneous", "shape": "box", "size": [0.1, 0.1, 0.1], "scattering": [1, 1, 1]})",
              R"("light": {"type": "point", "intensity": 0})"})
            for (const double distance : {1e2, 1e4, 1e7})
                EXPECT_LE(relmse(sharedRenderer()
                                     .render(withSpeck(fog, thing, distance), options(frames))
                                     .beauty,
                                 alone),
                          1e-8)
                    << thing << ", " << distance << " m";
    }
}

/// The box medium of `shape` as a constant grid of n voxels an edge. Voxel centres: the cube's faces lie half a voxel outside them.
Scene asGrid(const Scene& shape, int n) {
    Scene grid = shape;
    for (Medium& medium : grid.media) {
        const double h = 2.0 / n;
        dmat4 worldFromIndex(h);
        worldFromIndex[3] = dvec4(dvec3(-1 + h / 2), 1);
        medium.kind = MediumKind::Grid;
        medium.density = std::make_shared<BrickGrid>(
            makeBrickGrid(std::vector<float>(size_t(n) * size_t(n) * size_t(n), 1.0f), ivec3(0),
                          ivec3(n), worldFromIndex));
        medium.version = nextVersion();
    }
    grid.versions.media = nextVersion();
    return grid;
}

struct Comparison {
    double relmse, energy,
        scattered; // of the grid against the box; ratios of the means of beauty and of LVE
};

Comparison gridAgainstBox(dvec3 lamp) {
    Scene shape = testScene(
        1,
        R"(,{"name": "m", "medium": {"type": "homogeneous", "shape": "box", "size": [2, 2, 2], "scattering": [0.9, 0.7, 0.5], "absorption": [0.1, 0.1, 0.1], "anisotropy": 0.3}, "translation": [0, 1, 0]})");
    for (Node& node : shape.nodes)
        if (node.name == "lamp") node.translation = lamp;
    RenderOptions o = options(16);
    o.settings = {"media.integration=exact", "media.lightOpticalDepth=exact"};
    const Rendered box = sharedRenderer().render(shape, o);
    const Rendered grid = sharedRenderer().render(asGrid(shape, 64), o);
    const Comparison c{relmse(grid.beauty, box.beauty), mean(grid.beauty) / mean(box.beauty),
                       mean(grid.terms.at("LVE")) / mean(box.terms.at("LVE"))};
    std::printf("relmse %.2e; energy %.5f, of the scattered light alone %.5f\n", c.relmse, c.energy,
                c.scattered);
    return c;
}

TEST(Invariance, ABoxAndAConstantGridAreTheSameMedium) {
    // A trilinear field fades over a voxel at its border, half of it outside the box: as much matter, a little more spread
    // out. What that changes is of second order in the voxel's optical depth of 0.03: some 5e-4.
    const Comparison c = gridAgainstBox(dvec3(0.5, 3, 0.5));
    EXPECT_LE(c.relmse, 1e-3);
    EXPECT_NEAR(c.energy, 1, 1e-3);
    EXPECT_NEAR(c.scattered, 1, 1e-3);
}

TEST(Invariance, ABoxAndAConstantGridAreTheSameMediumAroundALamp) {
    // Radiance has a pole where a ray meets the lamp, one over the distance. Its four pixels hold a fifth of the light and
    // differ by the noise of 16 frames, some 10 %: 2 % of the light that is scattered, half of that of the picture.
    const Comparison c = gridAgainstBox(dvec3(0.5, 1.6, 0.5));
    EXPECT_LE(c.relmse, 1e-3);
    EXPECT_NEAR(c.energy, 1, 1e-2);
    EXPECT_NEAR(c.scattered, 1, 2e-2);
}

bool isMediaPass(const std::string& name) { return name.rfind("media", 0) == 0; }

TEST(Skips, WithoutMediaEveryMediaPassIsSkippedWithItsReason) {
    const Rendered picture = sharedRenderer().render(testScene(1, "none"), options());
    int mediaPasses = 0;
    for (const auto& [name, status] : picture.passes)
        if (isMediaPass(name)) {
            ++mediaPasses;
            EXPECT_EQ(status, "skipped: no medium in the scene") << name;
        }
    EXPECT_GT(mediaPasses, 0)
        << "the passes are still declared, so that a person can see why they did not run";
}

TEST(Skips, WithoutMediaThePictureIsBitIdenticalToMediaSwitchedOff) {
    const Rendered vacuum = sharedRenderer().render(testScene(1, "none"), options());
    RenderOptions off = options();
    off.settings = {"media.enabled=false"};
    const Rendered switchedOff = sharedRenderer().render(testScene(1), off);
    EXPECT_EQ(vacuum.beauty.pixels, switchedOff.beauty.pixels);
    EXPECT_EQ(vacuum.display, switchedOff.display);
}

TEST(Skips, AMediumOutOfViewAndOffEveryLightPathIsSkippedAndOneInTheLightsPathIsNot) {
    const auto scene = [](double z) {
        return sceneFromJson(fmt::format(
            R"({{"tyndall": 1, "nodes": [
              {{"name": "floor", "primitive": {{"shape": "box", "size": [2, 0.1, 2]}}, "translation": [0, 0, -4]}},
              {{"name": "lamp", "light": {{"type": "point", "intensity": 10}}, "translation": [0, 3, -4]}},
              {{"name": "puff", "medium": {{"type": "homogeneous", "shape": "sphere", "size": [1, 1, 1], "scattering": [1, 1, 1], "absorption": [0, 0, 0]}}, "translation": [0, {}, {}]}},
              {{"name": "eye", "camera": {{"type": "perspective", "yfov": 0.5}}, "translation": [0, 0.5, 0]}}], "camera": "eye"}})",
            z > 0 ? 0.5 : 2.2, z));
    };
    RenderOptions off = options();
    off.settings = {"media.enabled=false"};
    const Rendered behind = sharedRenderer().render(scene(20), options());
    EXPECT_EQ(behind.beauty.pixels, sharedRenderer().render(scene(20), off).beauty.pixels);
    int skipped = 0;
    for (const auto& [name, status] : behind.passes)
        skipped += isMediaPass(name) && status.rfind("skipped", 0) == 0;
    EXPECT_GT(skipped, 0);
    for (const auto& [name, status] : behind.passes)
        EXPECT_TRUE(!isMediaPass(name) || status.rfind("ran", 0) != 0) << name;
    // Above the picture, but between the lamp and the floor: it dims the floor.
    EXPECT_LT(mean(sharedRenderer().render(scene(-4), options()).beauty),
              0.95 * mean(sharedRenderer().render(scene(-4), off).beauty));
}

TEST(Skips, PoisonedResourcesNeverReachThePicture) {
    RendererOptions poisoned;
    poisoned.poison = true;
    static TestRenderer renderer(gl::Backend::Egl, poisoned);
    for (const char* media : {"", "none"}) {
        const Rendered clean = sharedRenderer().render(testScene(1, media), options());
        const Rendered poison = renderer.render(testScene(1, media), options()); // fails on any NaN
        EXPECT_EQ(clean.beauty.pixels, poison.beauty.pixels);
    }
}

// Light gathered at every cell, through every cell on its way, is a great many rounds of loops. Some drivers end all loops of a shader
// after so many (llvmpipe: 65,535): the rest of the ray would be missing from the emission, too.
TEST(Invariance, EmissionIsTheSameWhetherLightIsGatheredOrNot) {
    Result<LoadedScene> loaded = loadScene(sourceDir() / "content/campfire.scene.json");
    ASSERT_TRUE(loaded.ok()) << loaded.message();
    RenderOptions o;
    o.width = 32;
    o.height = 18;
    o.frames = 2;
    o.converge = true;
    o.terms = bit(Term::LE);
    const Image alone = sharedRenderer().render(loaded->scene, o).terms.at("LE");
    o.terms = terms(Term::LE, Term::LVE);
    const Image beside = sharedRenderer().render(loaded->scene, o).terms.at("LE");
    EXPECT_GT(mean(alone), 0);
    // Two shaders may round differently.
    EXPECT_LE(relmse(beside, alone), 1e-10);
}

TEST(Determinism, TheSameFrameTwiceIsTheSameBits) {
    const Rendered a = sharedRenderer().render(testScene(1), options(3)),
                   b = sharedRenderer().render(testScene(1), options(3));
    EXPECT_EQ(a.beauty.pixels, b.beauty.pixels);
    EXPECT_EQ(a.display, b.display);
}

} // namespace
} // namespace tyndall::test
