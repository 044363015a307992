// Flux of lights against integrals over directions, and areas against outlines.
#include "scene/light_flux.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace tyndall {
namespace {

/// ∫ f(cosine) dω over the directions around an axis, by the midpoint rule in the cosine.
double overDirections(const std::function<double(double)>& f, double least) {
    constexpr int kSteps = 2'000'000;
    const double step = (1 - least) / kSteps;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) sum += f(least + (i + 0.5) * step);
    return 2 * kPi * step * sum;
}

/// The steepest fall-off here is 0.001 wide and has more than 1000 steps: the midpoint rule errs by their inverse square at most.
constexpr double kIntegration = 1e-6;

TEST(LightFlux, OfAPointIsItsIntensityOverAllDirections) {
    const double expected = overDirections([](double) { return 3.0; }, -1);
    EXPECT_NEAR(pointFlux(3.0), expected, kIntegration * expected);
    EXPECT_EQ(pointFlux(dvec3(3, 0, 1)), dvec3(pointFlux(3.0), 0, pointFlux(1.0)));
}

TEST(LightFlux, OfAConeIsItsIntensityOverItsSolidAngle) {
    for (const double angle : {0.1, 1.0, 0.5 * kPi}) {
        const double expected = overDirections([](double) { return 3.0; }, std::cos(angle));
        EXPECT_NEAR(coneFlux(3.0, std::cos(angle)), expected, kIntegration * expected) << angle;
    }
    EXPECT_DOUBLE_EQ(coneFlux(3.0, -1), pointFlux(3.0)) << "a cone that is open all round";
}

TEST(LightFlux, OfASpotIsTheIntegralOfItsFallOff) {
    struct Case {
        double inner, outer; // radians
    };
    // Wide penumbrae, one from the axis, a sharp edge, and cones so narrow that the extension's least width reaches past the axis.
    for (const Case& c : {Case{0.3, 0.8}, Case{0, 0.8}, Case{0.6, 0.5 * kPi}, Case{0.7, 0.7},
                          Case{0.02, 0.03}, Case{0.01, 0.01}}) {
        const double inner = std::cos(c.inner), outer = std::cos(c.outer);
        // As the extension's text has it.
        const double scale = 1 / std::max(0.001, inner - outer), offset = -outer * scale;
        const double expected = overDirections(
            [&](double cosine) {
                const double attenuation = std::clamp(cosine * scale + offset, 0.0, 1.0);
                return 5 * attenuation * attenuation;
            },
            outer);
        EXPECT_NEAR(spotFlux(5.0, inner, outer), expected, kIntegration * expected)
            << c.inner << " " << c.outer;
        EXPECT_LE(spotFlux(5.0, inner, outer), coneFlux(5.0, outer));
    }
}

TEST(LightFlux, OfARectIsItsRadianceWithTheCosineOverAHemisphere) {
    const double area = 0.75;
    const double expected = overDirections([&](double cosine) { return 4 * area * cosine; }, 0);
    EXPECT_NEAR(lambertFlux(4.0, area), expected, kIntegration * expected);
    // A Lambertian ball of radius r and radiance L has the intensity πr²L in all directions.
    const double r = 0.3;
    EXPECT_NEAR(lambertFlux(4.0, 4 * kPi * r * r), pointFlux(4 * kPi * r * r), 1e-12);
}

/// Area of the outline that the box's corners have in a plane across the direction: the convex hull of eight points (Andrew's chain).
double outlineArea(const Bounds& box, const dvec3& direction) {
    const dvec3 x = glm::normalize(
        glm::cross(direction, std::abs(direction.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0)));
    const dvec3 y = glm::cross(direction, x);
    std::vector<dvec2> points;
    for (int i = 0; i < 8; ++i) {
        const dvec3 corner((i & 1) ? box.maximum.x : box.minimum.x,
                           (i & 2) ? box.maximum.y : box.minimum.y,
                           (i & 4) ? box.maximum.z : box.minimum.z);
        points.emplace_back(glm::dot(x, corner), glm::dot(y, corner));
    }
    std::sort(points.begin(), points.end(),
              [](const dvec2& a, const dvec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    double doubled = 0;
    for (int side = 0; side < 2; ++side) {
        std::vector<dvec2> chain;
        for (const dvec2& p : points) {
            while (chain.size() > 1) {
                const dvec2 a = chain[chain.size() - 1] - chain[chain.size() - 2],
                            b = p - chain.back();
                if (a.x * b.y - a.y * b.x > 0) break;
                chain.pop_back();
            }
            chain.push_back(p);
        }
        for (size_t i = 1; i < chain.size(); ++i)
            doubled += chain[i - 1].x * chain[i].y - chain[i - 1].y * chain[i].x;
        std::reverse(points.begin(), points.end());
    }
    return 0.5 * doubled;
}

TEST(LightFlux, OfParallelLightIsItsIlluminanceOnTheOutlineOfTheBox) {
    const Bounds box{{-1, 2, 0.5}, {1, 3, 3.5}};
    for (const dvec3& d : {dvec3(0, -1, 0), dvec3(1, -1, 0.2), dvec3(-0.3, 0.1, -2)}) {
        const dvec3 direction = glm::normalize(d);
        EXPECT_NEAR(projectedArea(box, direction), outlineArea(box, direction), 1e-12);
        EXPECT_NEAR(parallelFlux(7.0, projectedArea(box, direction)),
                    7 * outlineArea(box, direction), 1e-11);
    }
    EXPECT_EQ(projectedArea({}, {0, 1, 0}), 0) << "an empty box covers nothing";
}

TEST(LightFlux, MeanProjectedAreaIsTheMeanOverAllDirections) {
    const Bounds box{{-1, 2, 0.5}, {1, 3, 3.5}};
    constexpr int kRows = 400, kColumns = 800;
    double sum = 0;
    for (int i = 0; i < kRows; ++i)
        for (int k = 0; k < kColumns; ++k) {
            const double y = 2 * (i + 0.5) / kRows - 1, s = std::sqrt(1 - y * y),
                         turn = 2 * kPi * (k + 0.5) / kColumns;
            sum += projectedArea(box, {s * std::cos(turn), y, s * std::sin(turn)});
        }
    // The integrand has kinks where a face is seen from its edge: the rule's error goes with 1/kRows² there.
    EXPECT_NEAR(meanProjectedArea(box), sum / (kRows * kColumns), 1e-4 * meanProjectedArea(box));
}

} // namespace
} // namespace tyndall
