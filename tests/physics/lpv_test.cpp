// Light propagation volumes in pictures: what is theirs alone. technique_laws_test.cpp has what holds for all techniques.

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/image_metrics.h"
#include "gi_scenes.h"
#include "support/render.h"

namespace tyndall::test {
namespace {

TEST(Lpv, AFloorUnderFogGetsWhatTheTablesSay) {
    // rt-tables.csv, slab-flux, τ 4, isotropic, collimated µ0 = 1: T less e⁻⁴, of the sun's light. Cells are 1.4 free paths, so that what is between
    // a surface and the middle of its cell matters. Right under a wide slab its edges are far.
    const std::pair<double, double> rows[] = {{1.0, 0.3090738216}, {0.9, 0.1285237}};
    for (const auto& [albedo, transmitted] : rows) {
        const Scene scene = sceneFromJson(fmt::format(
            R"({{"tyndall": 1, "nodes": [
            {{"name": "floor", "primitive": {{"shape": "plane", "size": [40, 40]}}, "material": {{"baseColor": [0.02, 0.02, 0.02], "specular": 0}}}},
            {{"name": "fog", "medium": {{"type": "homogeneous", "shape": "box", "size": [40, 4, 40], "scattering": [{0}, {0}, {0}],
                "absorption": [{1}, {1}, {1}]}}, "translation": [0, 2, 0]}},
            {{"name": "sun", "light": {{"type": "directional", "intensity": 100}}, "rotation": [-0.70710678, 0, 0, 0.70710678]}},
            {{"name": "eye", "camera": {{"type": "perspective", "yfov": 0.3, "znear": 0.01}}, "translation": [0, 0.05, 0],
                "rotation": [-0.70710678, 0, 0, 0.70710678]}}], "camera": "eye"}})",
            albedo, 1 - albedo));
        RenderOptions options;
        options.gi = "lpv";
        options.terms = kIndirect;
        options.settings = {"gi.lpv.resolution=30"};
        double radiance = 0; // on the floor, behind 5 cm of fog
        for (const auto& [name, picture] : sharedRenderer().render(scene, options).terms)
            if (name.find("LVSE") != std::string::npos) radiance += meanOf(picture);
        const double irradiance = radiance * kPi / 0.02 * std::exp(0.05);
        const double expected = 100 * (transmitted - std::exp(-4.0));
        printf("albedo %.1f: %.2f (%.2f)\n", albedo, irradiance, expected);
        EXPECT_NEAR(irradiance / expected, 1, 0.1) << albedo;
    }
}

TEST(Lpv, FewerRaysShowTheSameMedia) {
    // A post that is thinner than a square of pixels. What is marched on its own beside it and light scaled by opacity keep the error small: without
    // the latter it is 0.003.
    const Scene scene = sceneFromJson(corner(
        50,
        R"({"name": "fog", "medium": {"type": "homogeneous", "shape": "box", "size": [4, 3, 4], "scattering": [0.3, 0.3, 0.3],
        "absorption": [0, 0.1, 0.2]}, "translation": [0, 1.5, 0]},
        {"name": "post", "primitive": {"shape": "box", "size": [0.03, 3, 0.03]}, "translation": [0.3, 1.5, 1.2]},)"));
    RenderOptions options;
    options.width = 192;
    options.height = 108;
    options.gi = "lpv";
    options.terms = kIndirectInMedia;
    const auto media = [&](const char* resolution) {
        options.settings = {"gi.lpv.resolution=12", "gi.lpv.rsmSize=64",
                            fmt::format("gi.lpv.march={}", resolution)};
        return sharedRenderer().render(scene, options);
    };
    const Rendered every = media("full");
    EXPECT_EQ(every.passes.count("gi.lpv.upsample"), 0u);
    for (const char* resolution : {"half", "quarter"}) {
        const Rendered fewer = media(resolution);
        EXPECT_EQ(fewer.passes.at("gi.lpv.upsample"), "ran");
        const ImageMetrics found = compareImages(fewer.beauty, every.beauty).value();
        printf("%s: relmse %.5f, energy %.4f\n", resolution, found.relmse, found.energy);
        EXPECT_GT(found.relmse, 0) << resolution;
        EXPECT_LT(found.relmse, 0.001) << resolution;
        // A weighted mean of rays gives and takes alike, but at the picture's and the fog's rims: one pixel in 50 here.
        EXPECT_NEAR(found.energy, 1, 0.005) << resolution;
    }
}

TEST(Lpv, SettledLightIsLeftAlone) {
    RenderOptions options;
    options.gi = "lpv";
    options.terms = kIndirect;
    options.statistics = true;
    options.settings = {"gi.lpv.resolution=12", "gi.lpv.rsmSize=64", "gi.lpv.steps=512"};
    const Scene scene = sceneFromJson(corner(50, ""));
    const Rendered once = sharedRenderer().render(scene, options);
    EXPECT_GT(once.statistics.at("iterations.gi.lpv"), 8);
    EXPECT_LT(once.statistics.at("iterations.gi.lpv"), 512);
    EXPECT_LE(once.statistics.at("remaining.gi.lpv"), 0.002);
    options.frames = 3; // averaged: the direct passes see another point of the lamp in each
    const Rendered often = sharedRenderer().render(scene, options);
    EXPECT_EQ(often.statistics, once.statistics);
    EXPECT_EQ(often.passes.count("gi.lpv.inject"), 0u) << "nothing has changed";
    // The estimate of what was left to come is no guess: run on to the end.
    options.frames = 1;
    options.settings.push_back("gi.lpv.tolerance=0");
    const Rendered end = sharedRenderer().render(scene, options);
    const double stored = end.statistics.at("energy.gi.lpv.stored");
    EXPECT_NEAR(once.statistics.at("energy.gi.lpv.stored") / stored, 1, 0.004);
}

/// `name` of the statistics, of an image of one frame.
std::map<std::string, double> statisticsOf(const std::string& json,
                                           std::vector<std::string> settings) {
    RenderOptions options;
    options.gi = "lpv";
    options.terms = kIndirect;
    options.statistics = true;
    options.settings = std::move(settings);
    return sharedRenderer().render(sceneFromJson(json), options).statistics;
}

TEST(Lpv, TheLedgerOfPowerCloses) {
    const std::string fog =
        R"({"name": "fog", "medium": {"type": "homogeneous", "shape": "box", "size": [4, 3, 4], "scattering": [3, 3, 3],
        "absorption": [0, 0.1, 2], "anisotropy": 0.5}, "translation": [0, 1.5, 0]},)";
    const std::string scenes[] = {corner(50, ""), corner(50, fog), sealedRoom(0.02, 0.3, false)};
    for (const std::string& scene : scenes)
        for (const char* extent : {"gi.lpv.extent=0", "gi.lpv.extent=1.5"}) {
            const auto s = statisticsOf(
                scene, {"gi.lpv.resolution=12", "gi.lpv.rsmSize=64", "gi.lpv.steps=24", extent});
            int lattices = 0;
            for (const char* lattice : {"gi.lpv", "gi.lpv.outer1", "gi.lpv.outer2"}) {
                const auto value = [&](const char* what) {
                    return s.at(std::string("energy.") + lattice + "." + what);
                };
                if (s.count(std::string("iterations.") + lattice) == 0) continue;
                ++lattices;
                EXPECT_GT(value("injected"), 0);
                EXPECT_GT(value("escaped"), 0);
                const double rest = value("injected") - value("absorbed") - value("escaped") -
                                    value("blocked") - value("change");
                EXPECT_LT(std::abs(rest), 1e-4 * value("injected")) << lattice << " " << extent;
                EXPECT_LT(std::abs(value("imbalance")), 1e-5);
            }
            EXPECT_EQ(lattices, std::string(extent) == "gi.lpv.extent=0" ? 1 : 3);
        }
}

TEST(Lpv, InjectedPowerIsItsClosedForm) {
    const auto injected = [](const std::string& nodes, const char* rsmSize = "gi.lpv.rsmSize=128") {
        const std::string json = R"({"tyndall": 1, "nodes": [)" + nodes + R"(
            {"name": "eye", "camera": {"type": "perspective", "yfov": 0.8}, "translation": [0, 0, 9]}], "camera": "eye"})";
        return statisticsOf(json, {"gi.lpv.resolution=13", rsmSize}).at("energy.gi.lpv.injected");
    };
    // A lamp in the middle of a ball: of 4π I all but e^(-σ r) collides, and of that the albedo is scattered.
    const auto ball = [](double scattering, double absorption, double g) {
        return fmt::format(
            R"({{"name": "ball", "medium": {{"type": "homogeneous", "shape": "sphere", "size": [3, 3, 3],
            "scattering": [{0}, {0}, {0}], "absorption": [{1}, {1}, {1}], "anisotropy": {2}}}}},)",
            scattering, absorption, g);
    };
    for (const double scattering : {0.1, 1.0, 30.0}) // the last one within a cell of 0.27 m
        for (const double g : {0.0, 0.7, -0.4}) {
            const double absorption = 0.25 * scattering;
            const double expected = 3 * 4 * kPi * 1e6 * 0.8 * -std::expm1(-1.25 * scattering * 1.5);
            EXPECT_NEAR(
                injected(ball(scattering, absorption, g) +
                         R"({"name": "lamp", "light": {"type": "point", "intensity": 1e6}},)") /
                    expected,
                1, 0.01)
                << scattering << " " << g;
        }
    // Sunlight on a square: E A cos θ times the albedo; through mist before it (none of it scatters): times e^(-τ/cos θ).
    const std::string square =
        R"({"name": "square", "primitive": {"shape": "plane", "size": [2, 2]}, "material": {"baseColor": [0.5, 0.25, 0.125], "specular": 0}},)";
    const std::string sun = // 40° from the vertical
        R"({"name": "sun", "light": {"type": "directional", "intensity": 7}, "rotation": [-0.422618262, 0, 0, 0.906307787]},)";
    const double cosine = std::cos(40 * kPi / 180), lit = 7 * 4 * cosine * 0.875;
    EXPECT_NEAR(injected(square + sun, "gi.lpv.rsmSize=512") / lit, 1, 0.01);
    const std::string mist =
        R"({"name": "mist", "medium": {"type": "homogeneous", "shape": "box", "size": [8, 1, 8], "scattering": [0, 0, 0],
        "absorption": [0.6, 0.6, 0.6]}, "translation": [0, 2, 0]},)";
    EXPECT_NEAR(injected(square + mist + sun, "gi.lpv.rsmSize=1024") /
                    (lit * std::exp(-0.6 / cosine)),
                1, 0.01);
}

TEST(Lpv, AsPrintedLosesLight) {
    // In a thick cloud of albedo 1 nothing is absorbed, and the middle is far from the borders: what the ledger misses is the scheme's loss, 30.4 %
    // of what is scattered (transport.md, finding 1), λ = 1.416 σ d of it.
    const std::string json = R"({"tyndall": 1, "nodes": [
        {"name": "cloud", "medium": {"type": "homogeneous", "shape": "box", "size": [10, 10, 10], "scattering": [1, 1, 1], "absorption": [0, 0, 0]}},
        {"name": "lamp", "light": {"type": "point", "intensity": 10}},
        {"name": "eye", "camera": {"type": "perspective", "yfov": 0.8}, "translation": [0, 0, 20]}], "camera": "eye"})";
    const auto s = statisticsOf(
        json, {"gi.lpv.resolution=22", "gi.lpv.rsmSize=64", "gi.mode=paper", "gi.lpv.steps=4"});
    EXPECT_EQ(s.at("iterations.gi.lpv"), 4);
    const double lambda = 1.416 * 1.0 * 0.5;
    EXPECT_NEAR(s.at("energy.gi.lpv.imbalance") / (0.304 * lambda), 1, 0.01);
    EXPECT_LT(s.at("energy.gi.lpv.change"), 0);
}

TEST(Lpv, AFineLatticeInACoarseOneIsNearTheFineOneAlone) {
    const std::string scene = sealedRoom(0.3, 0.3, false);
    RenderOptions options;
    options.width = 48;
    options.height = 27;
    options.gi = "lpv";
    options.terms = kIndirect;
    // The eye looks along -z from (0, 1, 9): the fine half of the scene is before it.
    options.settings = {"gi.lpv.resolution=32", "gi.lpv.rsmSize=128"};
    const Image all = sharedRenderer().render(sceneFromJson(scene), options).beauty;
    options.settings = {"gi.lpv.resolution=17", "gi.lpv.rsmSize=128", "gi.lpv.extent=7"};
    const Rendered nested = sharedRenderer().render(sceneFromJson(scene), options);
    options.settings = {"gi.lpv.resolution=17", "gi.lpv.rsmSize=128"};
    const Image coarse = sharedRenderer().render(sceneFromJson(scene), options).beauty;
    const ImageMetrics with = compareImages(nested.beauty, all).value(),
                       without = compareImages(coarse, all).value();
    printf("nested: relmse %.4f, energy %.4f; coarse alone: %.4f, %.4f\n", with.relmse, with.energy,
           without.relmse, without.energy);
    // The light that comes in is the coarse one's.
    EXPECT_LT(std::abs(with.energy - 1), 0.7 * std::abs(without.energy - 1));
    EXPECT_LT(with.relmse, 0.5 * without.relmse);
}

} // namespace
} // namespace tyndall::test
