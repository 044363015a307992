// Virtual point lights of walks that are kept while media move.

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "gi_scenes.h"
#include "support/content.h"
#include "support/render.h"

namespace tyndall::test {
namespace {

/// A puff of smoke and a bank of fog in a corner with a lamp.
Scene smokyCorner() {
    return sceneFromJson(corner(
        50,
        fmt::format(
            R"({{"name": "puff", "medium": {{"type": "grid", "file": "{}", "grid": "density", "scattering": [4, 4, 4], "absorption": [0.5, 0.5, 0.5]}},
                "translation": [0.36, 0.99, 0], "scale": [0.6, 0.6, 0.6]}},
                {{"name": "bank", "medium": {{"type": "homogeneous", "shape": "box", "size": [3, 1, 2], "scattering": [0.3, 0.3, 0.3],
                "absorption": [0, 0.1, 0.2]}}, "translation": [0.01, 0.5, 0.01]}},)",
            (sourceDir() / "content/smoke_puff.vdb").string())));
}

Node& nodeOf(Scene& scene, const std::string& name) {
    for (Node& node : scene.nodes)
        if (node.name == name) return node;
    throw std::runtime_error("no node " + name);
}

void move(Scene& scene, const std::string& name, const dvec3& by) {
    nodeOf(scene, name).translation += by;
    scene.versions.transforms = nextVersion();
}

RenderOptions incremental() {
    RenderOptions options;
    options.width = 48;
    options.height = 27;
    options.gi = "vpl";
    options.terms = kIndirect;
    options.statistics = true;
    options.settings = {"gi.vpl.incremental=true", "gi.vpl.walks=64", "gi.vpl.mapSide=32",
                        "gi.vpl.samples=8"};
    return options;
}

/// The greatest difference of two pictures over the mean of one.
double apart(const Image& a, const Image& b) {
    double most = 0;
    for (size_t i = 0; i < a.pixels.size(); ++i)
        most = std::max(most, std::abs(double(a.pixels[i]) - double(b.pixels[i])));
    return most / meanOf(b);
}

std::string stateOf(const Rendered& rendered, const char* pass) {
    return rendered.passes.at(pass).substr(0, 6);
}

TEST(VplIncremental, MediaThatMoveALittleNeitherTraceNorMap) {
    const RenderOptions options = incremental();
    TestRenderer kept;
    Scene scene = smokyCorner();
    const Rendered first = kept.render(scene, options);
    EXPECT_EQ(first.statistics.at("walks_traced.gi.vpl"), 64);
    Image before = first.beauty;
    for (int step = 0; step < 3; ++step) {
        move(scene, "puff", {0.004, 0.002, 0});
        move(scene, "bank", {0.003, 0.004, 0});
        scene.media[0].scattering *= 1.01f;
        scene.versions.media = scene.media[0].version = nextVersion();
        const Rendered now = kept.render(scene, options);
        EXPECT_EQ(now.statistics.at("walks_traced.gi.vpl"), 0);
        for (const char* pass : {"gi.vpl.maps", "gi.vpl.walks", "gi.traced.triangles", "gi.traced.tree"})
            EXPECT_EQ(stateOf(now, pass), "cached") << pass;
        EXPECT_NE(stateOf(now, "gi.vpl.lights"), "cached");
        TestRenderer fresh;
        const Rendered scratch = fresh.render(scene, options);
        EXPECT_EQ(scratch.statistics.at("walks_traced.gi.vpl"), 64);
        EXPECT_LE(apart(now.beauty, scratch.beauty), 1e-5);
        EXPECT_GT(apart(now.beauty, before), 1e-3) << "nothing moved";
        before = now.beauty;
    }
}

TEST(VplIncremental, SplattedMapsAreKept) {
    RenderOptions options = incremental();
    options.settings = {"gi.vpl.incremental=true", "gi.vpl.walks=16",    "gi.vpl.mapSide=16",
                        "gi.vpl.samples=4",        "gi.vpl.maps=points", "gi.vpl.points=512"};
    TestRenderer kept;
    Scene scene = smokyCorner();
    EXPECT_NE(stateOf(kept.render(scene, options), "gi.vpl.maps"), "cached");
    move(scene, "puff", {0.004, 0.002, 0});
    const Rendered now = kept.render(scene, options);
    EXPECT_EQ(stateOf(now, "gi.vpl.maps"), "cached");
    EXPECT_EQ(stateOf(now, "gi.vpl.points"), "cached");
    TestRenderer fresh;
    EXPECT_LE(apart(now.beauty, fresh.render(scene, options).beauty), 1e-5);
}

TEST(VplIncremental, WhatElseChangesTracesAnew) {
    const RenderOptions options = incremental();
    TestRenderer kept;
    Scene scene = smokyCorner();
    kept.render(scene, options);
    const auto traced = [&] {
        return kept.render(scene, options).statistics.at("walks_traced.gi.vpl");
    };
    EXPECT_EQ(traced(), 0);
    move(scene, "lamp", {0.01, 0, 0});
    EXPECT_EQ(traced(), 64);
    move(scene, "wall", {0, 0, 0.01});
    EXPECT_EQ(traced(), 64);
    move(scene, "puff", {0.5, 0, 0});
    EXPECT_EQ(traced(), 64);
    TestRenderer fresh;
    EXPECT_LE(apart(kept.render(scene, options).beauty, fresh.render(scene, options).beauty), 1e-5);
    EXPECT_EQ(traced(), 0);
    RenderOptions other = options;
    other.settings[0] = "gi.vpl.incremental=false";
    other.settings.push_back("gi.vpl.candidates=1");
    EXPECT_EQ(kept.render(scene, other).statistics.at("walks_traced.gi.vpl"), 64);
}

TEST(VplRenewed, SoManyWalksAFrameUntilAllAreOfTheSceneAsItIs) {
    for (const char* maps : {"gi.vpl.maps=rays", "gi.vpl.maps=points"}) {
        RenderOptions options = incremental();
        options.settings = {"gi.vpl.renewed=16", "gi.vpl.walks=40",  "gi.vpl.mapSide=16",
                            "gi.vpl.points=512", "gi.vpl.samples=4", maps};
        TestRenderer kept;
        Scene scene = smokyCorner();
        const auto traced = [&](Image& beauty) {
            const Rendered now = kept.render(scene, options);
            beauty = now.beauty;
            return now.statistics.at("walks_traced.gi.vpl");
        };
        Image dim, now;
        EXPECT_EQ(traced(dim), 40);
        EXPECT_EQ(traced(now), 0);
        for (Light& light : scene.lights) light.intensity *= 4;
        scene.versions.lights = nextVersion();
        double before = meanOf(dim);
        for (const int expected : {16, 16, 8}) {
            EXPECT_EQ(traced(now), expected) << maps;
            EXPECT_GT(meanOf(now), before) << "light comes little by little";
            before = meanOf(now);
        }
        EXPECT_EQ(traced(now), 0);
        TestRenderer fresh;
        EXPECT_LE(apart(now, fresh.render(scene, options).beauty), 1e-5) << maps;
        // Light is linear; sums in single precision.
        EXPECT_NEAR(meanOf(now), 4 * meanOf(dim), 1e-4 * meanOf(now));
        // The medium changes while walks are being renewed: all of them are, from where it stands.
        move(scene, "puff", {0.1, 0, 0});
        EXPECT_EQ(traced(now), 16);
        move(scene, "puff", {0.1, 0, 0});
        for (const int expected : {16, 8, 16, 0}) EXPECT_EQ(traced(now), expected) << maps;
        TestRenderer again;
        EXPECT_LE(apart(now, again.render(scene, options).beauty), 1e-5) << maps;
        // Surfaces that move leave no map as it was.
        move(scene, "wall", {0, 0, 0.01});
        EXPECT_EQ(traced(now), 40);
    }
}

TEST(VplIncremental, ShowsTheSameOnAverage) {
    const Scene scene = smokyCorner();
    RenderOptions options = incremental();
    options.frames = 8;
    constexpr int kSeeds = 12;
    double mean[2] = {}, variance[2] = {}; // of pictures' means
    for (const int kept : {0, 1}) {
        options.settings[0] = kept ? "gi.vpl.incremental=true" : "gi.vpl.incremental=false";
        double squares = 0;
        for (int seed = 0; seed < kSeeds; ++seed) {
            options.seed = uint32_t(1 + seed + kept * kSeeds);
            const double one = meanOf(sharedRenderer().render(scene, options).beauty);
            mean[kept] += one / kSeeds;
            squares += one * one / kSeeds;
        }
        variance[kept] = (squares - mean[kept] * mean[kept]) / (kSeeds - 1);
    }
    const double error = std::sqrt(variance[0] + variance[1]);
    printf("kept over followed: %.3f, %.1f standard errors of %.1f %%\n", mean[1] / mean[0],
           (mean[1] - mean[0]) / error, 100 * error / mean[0]);
    EXPECT_LT(std::abs(mean[1] - mean[0]),
              3.5 * error); // 3.5: of a mean of so few the error itself is known to a fifth
    EXPECT_LT(error, 0.1 * mean[0]) << "too coarse to tell anything";
}

} // namespace
} // namespace tyndall::test
