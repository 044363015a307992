// Single scattering of a point light in an endless homogeneous medium: the airlight integral of Sun et al. 2005.
// Values from the design's table (they equal direct quadrature to ten digits). Bound: 0.3 %.

#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/render.h"

namespace tyndall::test {
namespace {

struct Row {
    double beta, lightDistance, surfaceDistance, degrees, radiance;
};
constexpr Row kRows[] = {
    {0.1, 10, 20, 30, 8.174737694e-4}, {0.5, 4, 10, 45, 1.409133662e-3},
    {1, 2, 5, 60, 3.484834779e-3},     {0.05, 20, 60, 90, 3.844005116e-5},
    {2, 1, 3, 15, 0.1286970871},
};

class Airlight : public ::testing::TestWithParam<Row> {};

/// Eye at the origin looking along -Z, light of 1 cd at an angle, a black wall at the given distance.
Scene airlightScene(const Row& row, double scale = 1) {
    const double angle = row.degrees * kPi / 180;
    return sceneFromJson(fmt::format(
        R"({{"tyndall": 1, "nodes": [
          {{"name": "wall", "primitive": {{"shape": "box", "size": [{0}, {0}, {1}]}}, "translation": [0, 0, {2}], "material": {{"baseColor": [0, 0, 0], "metallic": 0, "roughness": 1, "specular": 0}}}},
          {{"name": "lamp", "light": {{"type": "point", "intensity": {3}}}, "translation": [{4}, 0, {5}]}},
          {{"name": "air", "medium": {{"type": "homogeneous", "shape": "everywhere", "scattering": [{6}, {6}, {6}], "absorption": [0, 0, 0]}}}},
          {{"name": "eye", "camera": {{"type": "perspective", "yfov": 0.01, "znear": {7}}}}}], "camera": "eye"}})",
        1000 * scale, scale, -(row.surfaceDistance + 0.5) * scale, scale * scale,
        row.lightDistance * std::sin(angle) * scale, -row.lightDistance * std::cos(angle) * scale,
        row.beta / scale, 1e-3 * scale));
}

TEST_P(Airlight, MatchesTheIntegralOnceConverged) {
    RenderOptions options;
    options.width = options.height = 8;
    options.frames = 32;
    const Rendered picture = sharedRenderer().render(airlightScene(GetParam()), options);
    double mean = 0;
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) mean += double(picture.pixel(x, y, "LVE").y) / 64;
    EXPECT_NEAR(mean / GetParam().radiance, 1.0, 0.003) << mean;
    std::printf("relative error %.2e\n", mean / GetParam().radiance - 1);
}

TEST_P(Airlight, IsTheSameInMillimetresAndInKilometres) {
    RenderOptions options;
    options.width = options.height = 8;
    const Rendered metres = sharedRenderer().render(airlightScene(GetParam()), options);
    for (double scale : {1e-3, 1e3}) {
        const Rendered scaled = sharedRenderer().render(airlightScene(GetParam(), scale), options);
        // I grows with the square of the scale, so that I/d² stays; σ shrinks with it, so that σ·ds stays.
        for (int i = 0; i < 8; ++i)
            EXPECT_NEAR(double(scaled.pixel(i, i, "LVE").y / metres.pixel(i, i, "LVE").y), 1.0,
                        1e-3)
                << "scale " << scale;
    }
}

/// A lamp in a box of fog: nits that fog of this size scatters once towards an eye 6 m from the lamp, along a ray that passes the lamp at `height`.
double scatteredPast(double height, double size) {
    const double scattering = 0.15, extinction = 0.4, candela = 50, eye = 6;
    const double along = std::sqrt(eye * eye - height * height); // to where the lamp is abreast
    const double end = along + std::min(0.5 * size, 100.0);
    double sum = 0;
    const int steps = 1 << 20;
    for (int i = 0; i < steps; ++i) {
        const double t = (i + 0.5) / steps * end, x = t - along, d = std::hypot(height, x);
        sum += std::exp(-extinction * (t + d)) / (d * d);
    }
    return sum * end / steps * candela * scattering / (4 * kPi);
}

TEST(Airlight, HowFarAbsorbingFogGoesOnDoesNotMatter) {
    for (const double height : {0.5, 1.0, 2.0}) {
        const double expected = scatteredPast(height, 16), angle = std::asin(height / 6);
        std::printf("%.1f m from the lamp: %.5f nits\n", height, expected);
        for (const double size : {16.0, 1e2, 1e3, 1e4, 1e5}) {
            const Scene scene = sceneFromJson(fmt::format(
                R"({{"tyndall": 1, "nodes": [
                {{"name": "fog", "medium": {{"type": "homogeneous", "shape": "box", "size": [{0}, {0}, {0}], "scattering": [0.15, 0.15, 0.15],
                    "absorption": [0.25, 0.25, 0.25]}}}},
                {{"name": "lamp", "light": {{"type": "point", "intensity": 50}}}},
                {{"name": "eye", "camera": {{"type": "perspective", "yfov": 0.001}}, "translation": [0, 0, 6], "rotation": [{1}, 0, 0, {2}]}}],
                "camera": "eye"}})",
                size, std::sin(angle / 2), std::cos(angle / 2)));
            RenderOptions options;
            options.width = options.height = 8;
            options.frames = 16;
            const Rendered picture = sharedRenderer().render(scene, options);
            double mean = 0;
            for (int y = 0; y < 8; ++y)
                for (int x = 0; x < 8; ++x) mean += double(picture.pixel(x, y, "LVE").y) / 64;
            EXPECT_NEAR(mean / expected, 1, 0.003) << size << " m of fog";
        }
    }
}

INSTANTIATE_TEST_SUITE_P(SunEtAl, Airlight, ::testing::ValuesIn(kRows));

} // namespace
} // namespace tyndall::test
