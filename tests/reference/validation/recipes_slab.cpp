// Slabs: fluxes through reciprocity, fluxes order by order, radiances, X and Y functions, direct transmittance.

#include <algorithm>
#include <cmath>

#include "validation/recipes.h"
#include "validation/scenes.h"

namespace tyndall::validation {
namespace {

using tracing::CameraRays;
using tracing::Sampler;
using tracing::TermLight;
using reference::VolumePathTracer;
using Tracers = std::vector<VolumePathTracer>;

constexpr double kFarWall = 1; // metres between a slab and the wall that keeps the other side dark
constexpr double kScarce = 1e-6, kRare = 0.1,
                 kRareOrder = 0.004; // fluxes: not to be found, found with more effort
constexpr double kSkim = 1e-9;       // metres under the face: where rays of cosine 0 run

dvec3 downwards(double mu, double azimuth = 0) {
    const double s = std::sqrt(std::max(0.0, 1 - mu * mu));
    return {s * std::cos(azimuth), -mu, s * std::sin(azimuth)};
}

CameraRays::CameraRay eye(const dvec3& from, const dvec3& direction) {
    return {{from, glm::normalize(direction)}, 0};
}

/// Towards the slab's upper face: at a given cosine, or as diffuse light arrives.
CameraRays::CameraRay intoSlab(std::optional<double> mu0, Sampler& sampler) {
    if (mu0) return eye({0, 0, 0}, downwards(*mu0));
    const dvec2 u = sampler.next2();
    return eye({0, 0, 0}, downwards(std::sqrt(1 - u.x), 2 * kPi * u.y));
}

Scene litFrom(double albedo, double anisotropy, double tau, Side side) {
    SceneMaker maker;
    addSlab(maker, albedo, anisotropy, tau);
    maker.addBlackPlane(side == Side::Reflected ? -tau - kFarWall : kFarWall);
    maker.addWhiteEnvironment();
    return maker.take();
}

std::optional<double> incidenceOf(const Row& row) {
    return Row::numberAfter(row.incidence, "mu0=");
}

Side sideOf(const Row& row) {
    const bool through =
        row.quantityHas("transm") || row.quantity[0] == 'T' || row.quantity[0] == 'Y';
    return through ? Side::Transmitted : Side::Reflected;
}

/// Flux after exactly `order` scatterings, per albedo^order: by terms for the first two; for the others what the same path
/// brings when it may scatter that often, less what it brings when it may not.
Probe orderProbe(double anisotropy, double tau, int order, Side side) {
    Probe probe;
    probe.stage = Stage::make(litFrom(1, anisotropy, tau, side));
    probe.settings.assign(order > 2 ? 2 : 1, {});
    probe.settings[0].maxScatterings = order;
    if (order > 2) probe.settings[1].maxScatterings = order - 1;
    probe.sample = [order](Tracers& tracers, Sampler& sampler) {
        const CameraRays::CameraRay start = intoSlab(1.0, sampler);
        Sampler again = sampler;
        TermLight light, shorter;
        tracers[0].trace(start, sampler, light);
        if (order <= 2) return light.terms[size_t(order == 1 ? Term::LVE : Term::LVVE)].y;
        tracers[1].trace(start, again, shorter);
        return light.sum().y - shorter.sum().y;
    };
    return probe;
}

/// exp(-tau/mu0), or its mean over diffuse incidence, from the tracer's own transmittance.
Computed directTransmittance(double albedo, double anisotropy, double tau,
                             std::optional<double> mu0) {
    const auto stage = Stage::make(litFrom(albedo, anisotropy, tau, Side::Transmitted));
    const auto through = [&](double mu) {
        Sampler unused(0, 0, 0);
        return tracing::transmittance(*stage->traced.media, {dvec3(0), downwards(mu)},
                                        kInfinity, tracing::TransmittanceMode::Exact,
                                        unused)
            .y;
    };
    if (mu0) return {through(*mu0)};
    // Substituted so that the integrand 2µT(µ) is smooth at both ends: midpoints converge at once.
    constexpr int kPoints = 20000;
    double sum = 0;
    for (int i = 0; i < kPoints; ++i) {
        const double x = (i + 0.5) / kPoints, mu = x * x * (3 - 2 * x), slope = 6 * x * (1 - x);
        sum += 2 * mu * through(mu) * slope / kPoints;
    }
    return {sum};
}

Recipe fluxRecipe(const Row& row, double albedo, double anisotropy, double tau) {
    const auto mu0 = incidenceOf(row);
    if (row.quantityHas("direct transmittance"))
        return {mu0 ? "closed-form transmittance of one ray"
                    : "closed-form transmittance, averaged over incidence by quadrature",
                directTransmittance(albedo, anisotropy, tau, mu0)};
    if (row.expected < kScarce)
        return {"",
                Skipped{"of a million paths none gets through so thick a slab: beyond any effort "
                        "that this suite makes"}};
    Probe probe = slabFluxProbe(albedo, anisotropy, tau, mu0, sideOf(row));
    probe.effort = std::clamp(kRare / row.expected, 1.0, 16.0);
    return {"reciprocity: rays started at the slab's face against a sky of radiance 1 on one side "
            "of it; a black wall hides the other side",
            probe};
}

std::optional<Recipe> radianceRecipe(const Row& row, double albedo, double anisotropy, double tau) {
    const std::string how = "a ray started at the face, a sun of perpendicular irradiance π";
    if (const auto mu = Row::numberAfter(row.quantity, "radiance at mu="))
        return Recipe{
            how, slabRadianceProbe(albedo, anisotropy, tau, *incidenceOf(row), *mu, sideOf(row))};
    if (row.name == "vdH12") {
        const double mu0 = *Row::numberAfter(row.incidence, "mu0="),
                     mu = *Row::numberAfter(row.incidence, "(mu=");
        Probe probe = slabRadianceProbe(albedo, anisotropy, tau, mu0, mu, sideOf(row));
        probe.value = [mu0](double radiance) { return radiance / mu0; };
        return Recipe{how + "; divided by µ0", probe};
    }
    if (row.name == "ChandrasekharXY") {
        const double mu0 = *Row::numberAfter(row.quantity, "(");
        Probe probe = slabRadianceProbe(albedo, anisotropy, tau, mu0, 0, sideOf(row));
        probe.value = [albedo](double radiance) { return 4 * radiance / albedo; };
        return Recipe{"4/albedo times the radiance along the lit (X) or the far face (Y) under a "
                      "sun at µ",
                      probe};
    }
    return std::nullopt;
}

} // namespace

Probe slabFluxProbe(double albedo, double anisotropy, double tau, std::optional<double> mu0,
                    Side side) {
    Probe probe;
    probe.stage = Stage::make(litFrom(albedo, anisotropy, tau, side));
    // Half the paths find the sky by themselves: next-event estimation would cost more than it saves.
    probe.settings[0].nextEventEstimation = false;
    probe.sample = [mu0](Tracers& tracers, Sampler& sampler) {
        TermLight light;
        tracers[0].trace(intoSlab(mu0, sampler), sampler, light);
        return light.sum().y;
    };
    return probe;
}

Probe slabRadianceProbe(double albedo, double anisotropy, double tau, double mu0, double mu,
                        Side side) {
    SceneMaker maker;
    addSlab(maker, albedo, anisotropy, tau);
    maker.addSun(downwards(mu0), kPi);
    Probe probe;
    probe.stage = Stage::make(maker.take());
    const double face = side == Side::Reflected ? 0 : -tau,
                 skim = mu > 0 ? 0 : (side == Side::Reflected ? -kSkim : kSkim);
    dvec3 direction = downwards(mu);
    if (side == Side::Transmitted) direction.y = -direction.y;
    const CameraRays::CameraRay start = eye({0, face + skim, 0}, direction);
    probe.sample = [start](Tracers& tracers, Sampler& sampler) {
        TermLight light;
        tracers[0].trace(start, sampler, light);
        return light.sum().y;
    };
    return probe;
}

std::optional<Recipe> slabRecipe(const Row& row) {
    const bool slab = row.name == "MCML-vdH35" || row.name == "vdH12" || row.name == "slab-MC" ||
                      row.name.rfind("slab-", 0) == 0 || row.name == "ChandrasekharXY";
    if (!slab) return std::nullopt;
    const double anisotropy = Row::number(row.anisotropy), tau = Row::number(row.tau);
    if (row.name == "slab-orders") {
        const double order = *Row::numberAfter(row.quantity, "_");
        Probe probe = orderProbe(anisotropy, tau, int(order), sideOf(row));
        probe.effort = std::clamp(kRareOrder / row.expected, 1.0, 8.0);
        return Recipe{"rays as for fluxes, albedo 1; LVE, LVVE, or the difference that one more "
                      "permitted scattering makes to the same path",
                      probe};
    }
    const double albedo = Row::number(row.albedo);
    if (auto recipe = radianceRecipe(row, albedo, anisotropy, tau)) return recipe;
    return fluxRecipe(row, albedo, anisotropy, tau);
}

std::optional<Recipe> halfSpaceRecipe(const Row& row) {
    if (row.name == "Milne") {
        constexpr double kEffort = 10; // long paths
        if (row.quantityHas("T ~")) {
            const double tau = Row::number(row.tau);
            Probe probe = slabFluxProbe(1, 0, tau, std::nullopt, Side::Transmitted);
            probe.effort = kEffort;
            return Recipe{"as other fluxes of slabs", probe};
        }
        constexpr double kThick = 8; // transients are down to e^-16 of the flux
        if (row.quantityHas("extrapolation")) {
            Probe probe = slabFluxProbe(1, 0, kThick, std::nullopt, Side::Transmitted);
            probe.value = [](double flux) { return 0.5 * (4 / (3 * flux) - kThick); };
            probe.effort = kEffort;
            return Recipe{"from the diffuse transmittance T of a slab of tau 8: (4/(3T) - 8)/2",
                          probe};
        }
        Probe probe = slabFluxProbe(1, 0, kThick, std::nullopt, Side::Transmitted);
        probe.sample = [](Tracers& tracers, Sampler& sampler) {
            TermLight light;
            tracers[0].trace(eye({0, -kSkim, 0}, {1, 0, 0}), sampler, light);
            return light.sum().y;
        };
        probe.value = [](double radiance) { return radiance * (kThick + 2 * kMilneExtrapolation); };
        return Recipe{"radiance along the dark face of a slab of tau 8 lit from below, over 3/4 of "
                      "its flux",
                      probe};
    }
    if (row.name != "H-function" && row.name != "half-space-albedo") return std::nullopt;
    const double albedo = Row::number(row.albedo);
    // A slab is a half-space where what its far side changes, exp(-2·tau/diffusion length), is below 1e-7.
    const double thick = albedo < 1 ? 12 + 8 / std::sqrt(3 * (1 - albedo)) : 12;
    if (row.name == "half-space-albedo")
        return Recipe{"as fluxes of slabs, of a thickness that makes no difference",
                      slabFluxProbe(albedo, 0, thick, incidenceOf(row), Side::Reflected)};
    const double mu0 = *Row::numberAfter(row.quantity, "(");
    Probe probe = slabRadianceProbe(albedo, 0, thick, mu0, 0, Side::Reflected);
    // Without absorption the far side is felt however far it is: X(µ) = H(µ)·(1 - µ/(tau + 2·z0)) but for transients.
    const double finite = albedo < 1 ? 1 : 1 - mu0 / (thick + 2 * kMilneExtrapolation);
    probe.value = [albedo, finite](double radiance) { return 4 * radiance / albedo / finite; };
    return Recipe{albedo < 1 ? "4/albedo times the radiance along the face under a sun at µ"
                             : "4 times the radiance along the face of a slab of tau 12, over "
                               "1 - µ/(tau + 2·z0), which turns X into H",
                  probe};
}

} // namespace tyndall::validation
