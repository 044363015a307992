// First order of scattering of a slab under a normal beam of irradiance π: pixel radiances and hemispherical fluxes.
// Expected values: the order-resolved table of the design's validation page, and the closed forms behind it. Bound: 0.3 %.

#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/render.h"

namespace tyndall::test {
namespace {

constexpr double kBound = 0.003;

struct SlabCase {
    double tau, r1, t1;
};
class Slab : public ::testing::TestWithParam<SlabCase> {};

/// An orthographic eye on one side of a slab of optical thickness tau (σt = 1/m, albedo 1, isotropic), at angle acos(mu) to the normal.
double pixelRadiance(double tau, double mu, bool transmitted) {
    const double angle =
        std::acos(mu) * 0.5; // half of the turn about X, away from looking straight at the slab
    const double look = (transmitted ? kPi / 2 : -kPi / 2) * 0.5;
    const double turn = look + (transmitted ? -angle : angle);
    const double distance = 3000;
    const double height = (transmitted ? -1 : 1) * mu * distance,
                 side = std::sqrt(1 - mu * mu) * distance;
    const Scene scene = sceneFromJson(fmt::format(
        R"({{"tyndall": 1, "nodes": [
          {{"name": "slab", "medium": {{"type": "homogeneous", "shape": "box", "size": [1000, {}, 1000], "scattering": [1, 1, 1], "absorption": [0, 0, 0]}}}},
          {{"name": "beam", "light": {{"type": "directional", "intensity": 3.14159265358979}}, "rotation": [-0.7071067811865476, 0, 0, 0.7071067811865476]}},
          {{"name": "eye", "camera": {{"type": "orthographic", "ymag": 0.01}}, "translation": [0, {}, {}], "rotation": [{}, 0, 0, {}]}}], "camera": "eye"}})",
        tau, height, side, std::sin(turn), std::cos(turn)));
    RenderOptions options;
    options.width = options.height = 4;
    options.frames = 16;
    const Rendered picture = sharedRenderer().render(scene, options);
    double mean = 0;
    for (int i = 0; i < 16; ++i) mean += double(picture.pixel(i % 4, i / 4, "LVE").y) / 16;
    return mean;
}

/// 12-point Gauss-Legendre nodes and weights on [0,1], by Newton's iteration on the polynomial.
std::vector<std::pair<double, double>> gaussNodes(int n) {
    std::vector<std::pair<double, double>> nodes;
    for (int i = 0; i < n; ++i) {
        double x = std::cos(kPi * (i + 0.75) / (n + 0.5)), derivative = 1;
        for (int iteration = 0; iteration < 50; ++iteration) {
            double p0 = 1, p1 = x;
            for (int k = 2; k <= n; ++k) {
                const double p2 = ((2 * k - 1) * x * p1 - (k - 1) * p0) / k;
                p0 = p1;
                p1 = p2;
            }
            derivative = n * (x * p1 - p0) / (x * x - 1);
            x -= p1 / derivative;
        }
        nodes.emplace_back(0.5 * (1 + x), 1 / ((1 - x * x) * derivative * derivative));
    }
    return nodes;
}

TEST_P(Slab, FirstOrderReflectionAndTransmission) {
    const auto [tau, r1, t1] = GetParam();
    double reflected = 0, transmitted = 0;
    for (const auto& [mu, weight] : gaussNodes(12)) {
        const double r = pixelRadiance(tau, mu, false), t = pixelRadiance(tau, mu, true);
        EXPECT_NEAR(r / (0.25 / (1 + mu) * -std::expm1(-tau * (1 + 1 / mu))), 1, kBound)
            << "reflected at mu " << mu;
        EXPECT_NEAR(t / (0.25 * (std::exp(-tau) - std::exp(-tau / mu)) / (1 - mu)), 1, kBound)
            << "transmitted at mu " << mu;
        reflected += 2 * weight * mu * r;
        transmitted += 2 * weight * mu * t;
    }
    EXPECT_NEAR(reflected / r1, 1, kBound);
    EXPECT_NEAR(transmitted / t1, 1, kBound);
    std::printf("tau %g: R1 %.7f (%+.2e), T1 %.7f (%+.2e)\n", tau, reflected, reflected / r1 - 1,
                transmitted, transmitted / t1 - 1);
}

INSTANTIATE_TEST_SUITE_P(OrderTable, Slab,
                         ::testing::Values(SlabCase{1, .1420154, .1061729},
                                           SlabCase{2, .1523059, .0615122}));

} // namespace
} // namespace tyndall::test
