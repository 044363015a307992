// Bodies without walls: spheres in a furnace, point sources in endless matter, airlight, furnaces.

#include <algorithm>
#include <cmath>

#include "reference/simple_path_tracer.h"
#include "validation/recipes.h"
#include "validation/scenes.h"

namespace tyndall::validation {
namespace {

using tracing::CameraRays;
using tracing::Sampler;
using tracing::TermLight;
using reference::VolumePathTracer;
using Tracers = std::vector<VolumePathTracer>;

dvec3 anyDirection(Sampler& sampler) {
    const dvec2 u = sampler.next2();
    return tracing::directionAround(1 - 2 * u.x, u.y);
}

double seen(Tracers& tracers, const dvec3& from, const dvec3& direction, Sampler& sampler) {
    TermLight light;
    tracers[0].trace({{from, direction}, 0}, sampler, light);
    return light.sum().y;
}

std::shared_ptr<const Stage> sphereInFurnace(double radius, double albedo) {
    SceneMaker maker;
    Medium ball = matter(MediumKind::Sphere, albedo, 0);
    ball.size = dvec3(2 * radius);
    maker.addMedium(ball);
    maker.addWhiteEnvironment();
    return Stage::make(maker.take());
}

Recipe sphereRecipe(const Row& row, double radius) {
    Probe probe;
    probe.stage = sphereInFurnace(radius, Row::number(row.albedo));
    probe.effort = row.expected > 0 ? std::clamp(0.02 / row.expected, 1.0, 10.0) : 1; // rare light
    const dvec3 down(0, 0, -1);
    const auto chord = [=](Tracers& tracers, Sampler& sampler, double impact) {
        return seen(tracers, {impact * radius, 0, radius + 1}, down, sampler);
    };
    const auto within = [=](Tracers& tracers, Sampler& sampler) {
        const dvec3 out = anyDirection(sampler);
        const double distance = radius * std::cbrt(sampler.next1());
        return seen(tracers, distance * out, anyDirection(sampler), sampler);
    };
    if (const auto impact = Row::numberAfter(row.quantity, "impact parameter ")) {
        probe.sample = [=](Tracers& t, Sampler& s) { return chord(t, s, *impact); };
        return {"one ray through the sphere, as a pixel sees it", probe};
    }
    if (row.quantityHas("centre")) {
        probe.sample = [](Tracers& t, Sampler& s) { return seen(t, dvec3(0), anyDirection(s), s); };
        return {"rays from the centre in all directions", probe};
    }
    if (row.quantityHas("volume-mean")) {
        probe.sample = within;
        return {"rays from all points within in all directions", probe};
    }
    if (row.quantityHas("absorbed")) {
        // A sphere's disc, seen from afar: as diffuse light falls on it.
        probe.sample = [=](Tracers& t, Sampler& s) { return chord(t, s, std::sqrt(s.next1())); };
        probe.value = [](double radiance) { return 1 - radiance; };
        return {"1 less the mean radiance over the sphere's disc", probe};
    }
    probe.sample = within; // sphere-escape: what reaches the sky unscattered from within
    return {"rays from all points within in all directions, absorption alone", probe};
}

/// Of scatterings beyond the `most`th in endless matter: the fluence after n of them is albedo^n times the (n+1)-fold
/// convolution of e^-r/(4πr²), whose Fourier transform is A(k) = atan(k)/k.
double fluenceOfHigherOrders(double albedo, double r, int most) {
    double sum = 0;
    constexpr double kLast = 4, kStep = 1e-4; // A(4)^32 < 1e-15
    for (int i = 0; i < int(kLast / kStep); ++i) {
        const double k = (i + 0.5) * kStep, a = std::atan(k) / k;
        sum += std::pow(albedo * a, most + 1) * a / (1 - albedo * a) * k * std::sin(k * r) * kStep;
    }
    return sum / (2 * kPi * kPi * r);
}

Recipe fluenceRecipe(double albedo, double r) {
    constexpr int kMost = 30;
    constexpr double kLongPaths = 0.9; // from this albedo on
    const bool cut = albedo >= kLongPaths;
    SceneMaker maker;
    maker.addMedium(matter(MediumKind::Everywhere, albedo, 0));
    maker.addPointLight(dvec3(0), 1 / (4 * kPi)); // power 1
    Probe probe;
    probe.stage = Stage::make(maker.take());
    if (cut) probe.settings[0].maxScatterings = kMost;
    if (cut) probe.effort = 3; // thirty scatterings each
    // The radiance grows as 1/sin towards the source: angles are drawn evenly.
    probe.sample = [r](Tracers& tracers, Sampler& sampler) {
        const dvec2 u = sampler.next2();
        const double angle = kPi * u.x;
        const dvec3 around = tracing::directionAround(std::cos(angle), u.y);
        const double radiance =
            seen(tracers, {r, 0, 0}, glm::normalize(dvec3(-around.z, around.x, around.y)), sampler);
        return radiance * 0.5 * kPi * std::sin(angle);
    };
    const double rest =
        std::exp(-r) / (4 * kPi * r * r) + (cut ? fluenceOfHigherOrders(albedo, r, kMost) : 0);
    probe.value = [rest](double mean) { return 4 * kPi * mean + rest; };
    std::string how = "4π times the mean radiance at r, plus e^-r/(4πr²): a lamp without extent is "
                      "not seen directly";
    if (cut) how += "; scatterings beyond the 30th, of paths that hardly end, in closed form";
    return {how, probe};
}

Recipe airlightRecipe(const Row& row) {
    const bool vacuum = row.name == "airlight-vacuum-limit";
    constexpr double kThin = 1e-8, kBias = 1e-7; // per metre; kThin times the way, and rounding
    const double sigma = vacuum ? kThin : *Row::numberAfter(row.geometry, "sigma_t=sigma_s=");
    const double length = vacuum ? 8 : *Row::numberAfter(row.geometry, "view ray length ");
    dvec3 lamp(1, -3, 0);
    if (!vacuum) {
        const double distance = *Row::numberAfter(row.geometry, "light at distance "),
                     angle = *Row::numberAfter(row.geometry, "angle ") * kPi / 180;
        lamp = distance * dvec3(std::sin(angle), -std::cos(angle), 0);
    }
    SceneMaker maker;
    Medium air;
    air.scattering = vec3(float(sigma));
    maker.addMedium(air);
    maker.addPointLight(lamp, 1);
    maker.addBlackPlane(-length);
    Probe probe;
    probe.stage = Stage::make(maker.take());
    probe.settings[0].maxScatterings = 1;
    probe.sample = [](Tracers& t, Sampler& s) { return seen(t, dvec3(0), {0, -1, 0}, s); };
    if (vacuum) {
        probe.value = [](double radiance) { return radiance / kThin; };
        probe.bias = kBias;
    }
    return {"term LVE of one ray that ends on a black wall", probe};
}

/// Every single path of the simple tracer brings 1: the value is the one furthest from it.
Recipe whiteFurnaceRecipe() {
    SceneMaker maker;
    Medium smoke = matter(MediumKind::Grid, 1, 0.8), haze = matter(MediumKind::Sphere, 1, -0.5);
    smoke.density = lumpyGrid(2, 30, 5);
    haze.size = dvec3(3, 2, 1);
    maker.addMedium(smoke);
    maker.addMedium(haze, dvec3(0.3, 0, 0));
    Material white;
    white.metallic = 0;
    white.specular = 0;
    white.doubleSided = true;
    maker.addPrimitive(PrimitiveShape::Box, dvec3(0.5, 0.7, 0.4), white,
                       lookAlong({0.3, 0.5, 0.8}, {0.2, -0.1, 0.3}));
    maker.addWhiteEnvironment();
    const auto stage = Stage::make(maker.take());
    const reference::SimplePathTracer tracer(stage->traced, {});
    double furthest = 1;
    for (uint32_t i = 0; i < 20000; ++i) {
        Sampler sampler(3, 0, i);
        const dvec3 from = 2.0 * anyDirection(sampler),
                    to = 0.5 * anyDirection(sampler) * sampler.next1();
        TermLight light;
        tracer.trace({{from, glm::normalize(to - from)}, 0}, sampler, light);
        for (int c = 0; c < 3; ++c)
            if (std::abs(light.sum()[c] - 1) > std::abs(furthest - 1)) furthest = light.sum()[c];
    }
    return {
        "the simple tracer's 60 000 paths through an uneven grid (g 0.8), a sphere (g -0.5) and "
        "round a white box: the one that brings home the value furthest from 1",
        Computed{furthest, 1e-5}};
}

Recipe isothermalRecipe() {
    SceneMaker maker;
    Medium fire = matter(MediumKind::Everywhere, 0.4, 0.5);
    fire.emission = fire.absorption;
    maker.addMedium(fire);
    Probe probe;
    probe.stage = Stage::make(maker.take());
    probe.sample = [](Tracers& t, Sampler& s) { return seen(t, dvec3(0), anyDirection(s), s); };
    return {"endless glowing matter of albedo 0.4, g 0.5", probe};
}

} // namespace

std::optional<Recipe> bodyRecipe(const Row& row) {
    if (row.name == "sphere-furnace" || row.name == "sphere-escape")
        return sphereRecipe(row, *Row::numberAfter(row.tau, "R="));
    if (row.name == "white-furnace") return whiteFurnaceRecipe();
    if (row.name == "isothermal") return isothermalRecipe();
    return std::nullopt;
}

std::optional<Recipe> pointSourceRecipe(const Row& row) {
    if (row.name == "infinite-point" || row.name == "infinite-point-MC") {
        // Far from the source few paths of a camera find it: farFluenceRecipe has these.
        const double albedo = Row::number(row.albedo), r = *Row::numberAfter(row.tau, "r=");
        if (r < kFar || albedo == 1) return fluenceRecipe(albedo, r);
        return std::nullopt;
    }
    if (row.name == "airlight" || row.name == "airlight-vacuum-limit") return airlightRecipe(row);
    return std::nullopt;
}

} // namespace tyndall::validation
