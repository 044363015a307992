// Virtual point lights in slabs: what media scatter twice and more often, against the design's tables (rt-tables.csv) less the closed form of the first
// order. A wide slab under a narrow beam, seen whole from afar: what leaves all of it in one direction is, by translation, what leaves each point of a
// slab under a beam without an end; and every virtual light counts.

#include <array>
#include <cmath>
#include <ostream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "gi_scenes.h"
#include "support/render.h"

namespace tyndall::test {
namespace {

constexpr std::array kMu = {0.1, 0.3, 0.5, 0.7, 0.9, 1.0};
constexpr int kFrames = 8;

/// Radiances of all orders under a beam of π lux, of a slab whose extinction is 1/m.
struct SlabRow {
    const char* name;
    double albedo, anisotropy, tau;
    std::array<double, kMu.size()> reflected, transmitted; // at kMu
    double absorbed;                                       // of the beam; -1: not looked at
    int walks;
    uint32_t seeds;
    double noise; // of a flux, relative, from its spread among seeds
};

/// Peaks of phase functions face each other where light is scattered forward: few lights count, and the spread is wide. There the sum over five
/// directions is not a flux either, and no power is balanced.
const SlabRow kRows[] = {
    {"slab-radiance, albedo 1, tau 1",
     1,
     0,
     1,
     {0.4648767822, 0.4366583337, 0.3805144274, 0.3289102457, 0.2870313101, 0.2693874572},
     {0.2934023444, 0.336361745, 0.3209133076, 0.2902992861, 0.2601842286, 0.2465293847},
     0,
     2048,
     1,
     0.012},
    {"slab-radiance, albedo 0.9, tau 1",
     0.9,
     0,
     1,
     {0.37266931, 0.3442406155, 0.2981512614, 0.2569735345, 0.2238849939, 0.210000792},
     {0.2240329948, 0.257581678, 0.2466789745, 0.2236334179, 0.2007042618, 0.1902646667},
     1 - 0.2674103351 - 0.5916250896,
     2048,
     1,
     0.012},
    {"slab-radiance, albedo 1, tau 4",
     1,
     0,
     4,
     {0.6573723838, 0.6986224865, 0.7059764431, 0.6972303754, 0.679459045, 0.6685496459},
     {0.16476445, 0.2160467294, 0.2623004037, 0.3023385143, 0.3335226761, 0.3455754541},
     0,
     2048,
     1,
     0.015},
    {"MCML-vdH35, albedo 0.9, g 0.75, tau 2",
     0.9,
     0.75,
     2,
     {0.13304, 0.13856, 0.11956, 0.09411, 0.07132, 0.06180},
     {0.16486, 0.22473, 0.27785, 0.36889, 0.72155, 2.40270},
     -1,
     2048,
     4,
     0.025},
};

/// In closed form: what a point scatters once, times transmittance to it and from it.
double firstOrder(const SlabRow& row, double mu, bool transmitted) {
    const double g = row.anisotropy, tau = row.tau, cosine = transmitted ? mu : -mu;
    const double phase = (1 - g * g) / std::pow(1 + g * g - 2 * g * cosine, 1.5);
    const double depth = !transmitted ? -std::expm1(-tau * (1 + 1 / mu)) / (1 + mu)
                         : mu == 1    ? tau * std::exp(-tau)
                                      : (std::exp(-tau) - std::exp(-tau / mu)) / (1 - mu);
    return 0.25 * row.albedo * phase * depth;
}

constexpr double kOuter = 0.06, kInner = 0.04, kLampHeight = 50; // a beam of 3 m to each side

/// Of the light 4e-4 gets as far from the beam as the slab's ends are: e^(-π w/(τ + 1.42)) (validation.md, 1.1).
double widthOf(double tau) { return 2 * (kOuter * kLampHeight + 2.5 * (tau + 1.42)); }

struct Leaving {
    double first = 0, more = 0; // radiance under a beam of π lux
};

Leaving leavingLight(const SlabRow& row, double mu, bool transmitted) {
    const double width = widthOf(row.tau), sine = std::sqrt(1 - mu * mu), distance = 2 * width;
    const double turn = // half of it, about X
        (transmitted ? 1 : -1) * (0.25 * kPi - 0.5 * std::acos(mu));
    RenderOptions options;
    options.gi = "vpl";
    options.terms = bit(Term::LVE) | kIndirectInMedia;
    options.width = 16;
    options.height = // all of the slab
        std::max(4, int(std::ceil(options.width * (mu + sine * row.tau / width))));
    options.frames = kFrames;
    options.settings = {fmt::format("gi.vpl.walks={}", row.walks), "gi.vpl.classes=32",
                        "gi.vpl.samples=8", "gi.vpl.march=full", "gi.vpl.candidates=4"};
    const Scene scene = sceneFromJson(fmt::format(
        R"({{"tyndall": 1, "nodes": [
        {{"name": "slab", "medium": {{"type": "homogeneous", "shape": "box", "size": [{0}, {1}, {0}], "scattering": [{2}, {2}, {2}],
            "absorption": [{3}, {3}, {3}], "anisotropy": {4}}}}},
        {{"name": "beam", "light": {{"type": "spot", "intensity": 1, "outerConeAngle": {5}, "innerConeAngle": {6}}}, "translation": [0, {7}, 0],
            "rotation": [-0.7071067811865476, 0, 0, 0.7071067811865476]}},
        {{"name": "eye", "camera": {{"type": "orthographic", "ymag": {8}}}, "translation": [0, {9}, {10}], "rotation": [{11}, 0, 0, {12}]}}],
        "camera": "eye"}})",
        width, row.tau, row.albedo, 1 - row.albedo, row.anisotropy, kOuter, kInner,
        kLampHeight + 0.5 * row.tau, 0.5 * width * options.height / options.width,
        (transmitted ? -1 : 1) * mu * distance, sine * distance, std::sin(turn), std::cos(turn)));
    // Of the spot: all inside, and a third of the penumbra, which fades quadratically.
    const double inner = std::cos(kInner), outer = std::cos(kOuter),
                 power = 2 * kPi * ((1 - inner) + (inner - outer) / 3);
    // A square metre across the view is 1/µ of the slab.
    const double scale = width * width * options.height / options.width / mu / (power / kPi);
    Leaving light;
    for (options.seed = 0; options.seed < row.seeds; ++options.seed) {
        const Rendered picture = sharedRenderer().render(scene, options);
        for (const auto& [name, image] : picture.terms)
            (name == "LVE" ? light.first : light.more) += scale * meanOf(image) / row.seeds;
    }
    return light;
}

void PrintTo(const SlabRow& row, std::ostream* out) { *out << row.name; }

class VplOrders : public ::testing::TestWithParam<SlabRow> {};

TEST_P(VplOrders, SlabsScatterMoreThanOnceWhatTheTablesSay) {
    const SlabRow& row = GetParam();
    double energy = std::exp(-row.tau);
    for (const bool transmitted : {false, true}) {
        double found = 0, expected = 0;
        for (size_t i = 0; i < kMu.size(); ++i) {
            const double mu = kMu[i], first = firstOrder(row, mu, transmitted);
            const double more = (transmitted ? row.transmitted : row.reflected)[i] - first;
            const Leaving light = leavingLight(row, mu, transmitted);
            printf("%s, mu %.1f: first order %.3f, the others %.3f of the table's\n",
                   transmitted ? "transmitted" : "reflected", mu, light.first / first,
                   light.more / more);
            if (mu < 1) { // the middles of five equal parts: a sum for the flux, ∫ 2 µ L dµ
                found += 0.4 * mu * light.more;
                expected += 0.4 * mu * more;
                energy += 0.4 * mu * (light.first + light.more);
            }
            // Of four rows of pixels some are half on the slab: a grazing view is noisy, and of little weight in the flux. One direction has
            // about twice the flux's noise; four times that.
            if (mu < 0.2) continue;
            EXPECT_LT(light.more / more, 1 + 8 * row.noise) << mu;
            EXPECT_GT(light.more / more, 1 - 8 * row.noise) << mu;
        }
        printf("%s, %s: %.4f of the table's flux\n", row.name,
               transmitted ? "transmitted" : "reflected", found / expected);
        EXPECT_LT(found / expected, 1 + 4 * row.noise);
        EXPECT_GT(found / expected, 1 - 4 * row.noise);
    }
    if (row.absorbed < 0) return;
    // The sum for an integral is within 0.5 % of the table's own fluxes; both sides are noisy together.
    printf("%s: %.4f of the light is accounted for\n", row.name, energy + row.absorbed);
    EXPECT_LT(energy + row.absorbed, 1.005 + 4 * row.noise);
    EXPECT_GT(energy + row.absorbed, 0.995 - 4 * row.noise);
}

INSTANTIATE_TEST_SUITE_P(Tables, VplOrders, ::testing::ValuesIn(kRows));

} // namespace
} // namespace tyndall::test
