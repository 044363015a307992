// Without chance: transmittance in closed form, phase functions by quadrature.

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "validation/recipes.h"
#include "validation/scenes.h"

namespace tyndall::validation {
namespace {

using tracing::MediaField;
using tracing::MediumSource;
using tracing::Ray;
using tracing::Sampler;

double transmittanceOf(const Medium& medium, const Ray& ray, double length) {
    SceneMaker maker;
    maker.addMedium(medium);
    const MediaField field(maker.scene(), dvec3(0));
    Sampler unused(0, 0, 0);
    return tracing::transmittance(field, ray, length, tracing::TransmittanceMode::Exact, unused)
        .y;
}

Medium pureAbsorber(MediumKind kind, float perMetre) {
    Medium medium;
    medium.kind = kind;
    medium.absorption = vec3(perMetre);
    return medium;
}

/// Density `f` of the distance along x, from `first` to `last`, in `cells` cells; the same across, two cells wide.
template <typename F> double alongGrid(double first, double last, int cells, const F& f) {
    const double spacing = (last - first) / cells;
    const int from = int(std::lround(first / spacing));
    Medium medium = pureAbsorber(MediumKind::Grid, 1);
    medium.density = sampledGrid(ivec3(from, -1, -1), ivec3(cells + 1, 3, 3), dvec3(spacing, 1, 1),
                                 [&](const dvec3& p) { return f(p.x); });
    return transmittanceOf(medium, {{first, 0, 0}, {1, 0, 0}}, last - first);
}

/// The blob in its own grid round the ray, fine enough: linear interpolation is off by at most h²/8·|f''| per metre, which for
/// these cells makes 3e-8 of optical depth.
double blob(double impact) {
    constexpr int kCells = 16000; // along [-1,1]
    constexpr double kSpacing = 2.0 / kCells, kWidth = 0.3;
    const int row = int(std::lround(impact / kSpacing));
    Medium medium = pureAbsorber(MediumKind::Grid, 1);
    medium.density = sampledGrid(
        ivec3(-kCells / 2, row - 1, -1), ivec3(kCells + 1, 3, 3), dvec3(kSpacing),
        [](const dvec3& p) { return 2 * std::exp(-glm::dot(p, p) / (2 * kWidth * kWidth)); });
    return transmittanceOf(medium, {{-1, row * kSpacing, 0}, {1, 0, 0}}, 2);
}

double heightFog(const Row& row) {
    Medium fog = pureAbsorber(MediumKind::Height, 0.8f);
    fog.scaleHeight = *Row::numberAfter(row.incidence, "H=");
    const double low = *Row::numberAfter(row.incidence, "z0="),
                 slope = *Row::numberAfter(row.incidence, "dz/ds="),
                 length = *Row::numberAfter(row.incidence, "L=");
    return transmittanceOf(
        fog, {{0, low, 0}, {std::sqrt(std::max(0.0, 1 - slope * slope)), slope, 0}}, length);
}

/// Segments inside single cells of a random grid against L/6·(s(0)+4·s(½)+s(1)): the worst relative difference.
double worstCell() {
    Medium medium = pureAbsorber(MediumKind::Grid, 1);
    medium.density = lumpyGrid(19, 4, 23); // cells of one metre
    SceneMaker maker;
    maker.addMedium(medium);
    const MediaField field(maker.scene(), dvec3(0));
    double worst = 0;
    for (uint32_t i = 0; i < 5000; ++i) {
        Sampler sampler(17, 0, i);
        const auto any = [&] {
            return dvec3(sampler.random(), sampler.random(), sampler.random());
        };
        const dvec3 cell = glm::floor(any() * 19.0), a = cell + any() - 9.5, b = cell + any() - 9.5;
        const Ray ray{a, glm::normalize(b - a)};
        const double length = glm::length(b - a);
        const auto at = [&](double t) { return medium.density->sample(ray.at(t) + 9.5); };
        const double simpson = length / 6 * (at(0) + 4 * at(0.5 * length) + at(length));
        const double depth =
            -std::log(tracing::transmittance(field, ray, length,
                                               tracing::TransmittanceMode::Exact, sampler)
                          .y);
        worst = std::max(worst, std::abs(depth - simpson) / std::max(simpson, 1e-3));
    }
    return worst;
}

Recipe transmittanceRecipe(const Row& row) {
    const std::string how = "the tracer's exact transmittance through a grid of it";
    if (row.quantityHas("linear density 0.2"))
        return {how, Computed{alongGrid(0, 3, 96, [](double x) { return 0.2 + 1.6 * x / 3; })}};
    if (row.quantityHas("linear 0->2"))
        return {how, Computed{alongGrid(0, 2, 64, [](double x) { return x; })}};
    if (row.incidence.rfind("trilinear cell", 0) == 0)
        return {"exact transmittance in 5000 random cells: the largest relative difference of "
                "optical depths; expected: 0",
                Computed{worstCell(), 1e-9}};
    if (const auto k = Row::numberAfter(row.incidence, "k="))
        return {how + " of 65536 cells", Computed{alongGrid(0, 1, 65536, [k](double x) {
                    return 5 * (1 + std::sin(2 * kPi * *k * x));
                })}};
    if (const auto impact = Row::numberAfter(row.incidence, "impact "))
        return {how + ", 16000 cells long", Computed{blob(*impact)}};
    if (row.incidence.rfind("exp height fog", 0) == 0)
        return {"the tracer's exact transmittance of height fog", Computed{heightFog(row)}};
    throw std::runtime_error("no recipe for the transmittance of " + row.incidence);
}

/// ∫ f(cosθ)·p over cosines [-1,last], times 2π.
template <typename F> double overPhase(const MediumSource& medium, double last, const F& f) {
    // Peaks are some (1-g) wide in the versine: points are spread evenly in its fourth root.
    constexpr int kPoints = 20000;
    double sum = 0;
    const double top = std::pow(2, 0.25), bottom = std::pow(1 - last, 0.25);
    for (int i = 0; i < kPoints; ++i) {
        const double x = bottom + (top - bottom) * (i + 0.5) / kPoints, versine = x * x * x * x;
        sum += f(1 - versine) * medium.phaseValue(versine) * 4 * x * x * x;
    }
    return 2 * kPi * sum * (top - bottom) / kPoints;
}

Recipe phaseRecipe(const Row& row) {
    Medium medium = matter(MediumKind::Everywhere, 1, Row::number(row.anisotropy));
    if (row.name == "Cornette-Shanks") medium.phase = PhaseFunction::CornetteShanks;
    const MediumSource source(medium, dmat4(1.0));
    const std::string how = "quadrature over the tracer's phase function";
    if (row.quantityHas("back-hemisphere"))
        return {how, Computed{overPhase(source, 0, [](double) { return 1.0; })}};
    if (row.quantityHas("integral"))
        return {how, Computed{overPhase(source, 1, [](double) { return 1.0; })}};
    return {how, Computed{overPhase(source, 1, [](double cosine) { return cosine; })}};
}

} // namespace

std::optional<Recipe> closedFormRecipe(const Row& row) {
    if (row.name == "transmittance") return transmittanceRecipe(row);
    if (row.name == "HG" || row.name == "Cornette-Shanks") return phaseRecipe(row);
    return std::nullopt;
}

} // namespace tyndall::validation
