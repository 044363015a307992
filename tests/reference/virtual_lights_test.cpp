// Light as it leaves its sources, the walks that it goes on, and what virtual point lights are clamped to.

#include <cmath>

#include <glm/ext/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "tracing/light_walk.h"
#include "reference/render.h"
#include "validation/scenes.h"

namespace tyndall::validation {
namespace {

struct Mean {
    dvec3 value{0};
    double error = 0; // standard, of the largest channel
};

/// Of the power of rays that a scene's lights send out.
Mean emittedPower(const Scene& scene, const Bounds& content = {}) {
    auto traced = tracing::TracerScene::build(scene, dvec3(0), 1);
    if (!traced.ok()) throw std::runtime_error(traced.message());
    const tracing::LightEmission emission(*traced, content);
    constexpr uint32_t kRays = 20000;
    dvec3 sum(0);
    double squares = 0;
    for (uint32_t i = 0; i < kRays; ++i) {
        tracing::Sampler sampler(7, 0, i);
        const dvec3 power = emission.sample(sampler).power;
        sum += power / double(kRays);
        squares += glm::dot(power, power) / double(kRays);
    }
    const double variance = std::max(squares - glm::dot(sum, sum), 0.0);
    return {sum, std::sqrt(variance / double(kRays))};
}

constexpr dvec3 kBlack(2, 1, 3); // metres: a box for light from infinity to fall on

void addBlackBox(SceneMaker& maker) {
    maker.addPrimitive(PrimitiveShape::Box, kBlack, matt({0, 0, 0}));
}

/// m², of the black box along a direction.
double shadow(const dvec3& direction) {
    const dvec3 along = glm::abs(glm::normalize(direction));
    return along.x * kBlack.y * kBlack.z + along.y * kBlack.z * kBlack.x +
           along.z * kBlack.x * kBlack.y;
}

/// Watts of a sun of `lux` whose disc has a radius of `angle`: ∫ L shadow dω, L = lux / ∫ cos dω.
double wattsOfSun(double lux, const dvec3& direction, double angle) {
    constexpr int kSteps = 200;
    const dvec3 axis = glm::normalize(direction);
    const dvec3 x = glm::normalize(glm::cross(axis, dvec3(1, 0, 0))), y = glm::cross(axis, x);
    double mean = 0; // of the shadow, over the disc
    for (int i = 0; i < kSteps; ++i)
        for (int k = 0; k < kSteps; ++k) {
            const double c = 1 - (1 - std::cos(angle)) * (i + 0.5) / kSteps,
                         s = std::sqrt(1 - c * c), turn = 2 * kPi * k / kSteps;
            mean += shadow(c * axis + s * (std::cos(turn) * x + std::sin(turn) * y)) /
                    (kSteps * kSteps);
        }
    return lux * mean * 2 / (1 + std::cos(angle));
}

TEST(LightEmission, PowerIsItsClosedForm) {
    const dvec3 down(0, -1, 0.2);
    struct Case {
        const char* name;
        double watts;
        Light light;
    };
    std::vector<Case> cases;
    Light light;
    light.color = {1, 1, 1};
    light.type = LightType::Point;
    light.intensity = 5;
    cases.push_back({"a point", 4 * kPi * 5, light});
    light.radius = 0.3f;
    cases.push_back({"a ball", 4 * kPi * 5, light});
    light.radius = 0;
    light.type = LightType::Spot;
    light.innerConeAngle = 0.3f;
    light.outerConeAngle = 0.8f;
    // ∫ (clamp((c - c₁)/(c₀ - c₁), 0, 1))² 2π dc: a third of the penumbra, and all inside.
    const double inner = std::cos(double(0.3f)), outer = std::cos(double(0.8f));
    cases.push_back({"a spot", 5 * 2 * kPi * ((1 - inner) + (inner - outer) / 3), light});
    light.type = LightType::Rect;
    light.size = {1.5f, 0.5f};
    light.radiance = {4, 4, 4};
    cases.push_back({"a rectangle", kPi * 4 * 0.75, light});
    light.type = LightType::Directional;
    cases.push_back({"a sun", 5 * shadow(down), light});
    light.radius = 0.2f;
    cases.push_back({"a sun with a disc", wattsOfSun(5, down, double(0.2f)), light});
    // Four standard errors; rounding where every ray has the same power, and there is no spread.
    for (const Case& one : cases) {
        SceneMaker maker;
        addBlackBox(maker);
        maker.addLight(one.light, lookAlong(down, {0, 3, 0}));
        const Mean power = emittedPower(maker.take());
        EXPECT_NEAR(power.value.x, one.watts, 4 * power.error + 1e-6 * one.watts) << one.name;
    }
    SceneMaker sky;
    addBlackBox(sky);
    sky.addWhiteEnvironment();
    const Mean power = emittedPower(sky.take());
    // A convex body's mean shadow is a quarter of its surface (Cauchy).
    EXPECT_NEAR(power.value.x, 4 * kPi * 22 / 4, 4 * power.error);

    Material glowing = matt({0, 0, 0});
    glowing.emissive = {2, 1, 0};
    SceneMaker box;
    box.addPrimitive(PrimitiveShape::Box, {1, 2, 3}, glowing);
    const Mean glow = emittedPower(box.take());
    const double sides = glowing.doubleSided ? 2 : 1;
    EXPECT_NEAR(glow.value.x, sides * 2 * kPi * 22, 4 * glow.error + 1e-6);
    EXPECT_NEAR(glow.value.y, sides * kPi * 22, 4 * glow.error + 1e-6);
}

TEST(LightEmission, SamplingTowardsContentChangesNoPower) {
    const dvec3 down(0.3, -1, 0.2);
    Light sun;
    sun.color = {1, 1, 1};
    sun.type = LightType::Directional;
    sun.intensity = 5;
    // In a corner, with one and with two boxes around it that are not all; from the side flat; all there is; beyond it.
    const dvec3 corner(-1, -0.5, -1.5);
    const Bounds contents[] = {{corner, corner + dvec3(0.3)},
                               {corner, corner + dvec3(0.06, 0.02, 0.03)},
                               {dvec3(-0.2, 0.1, -0.2), dvec3(0.2, 0.1, 0.2)},
                               {-0.5 * kBlack, 0.5 * kBlack},
                               {dvec3(-9), dvec3(9)}};
    for (const Bounds& content : contents) {
        SceneMaker day;
        addBlackBox(day);
        day.addLight(sun, lookAlong(down, {0, 3, 0}));
        const Mean power = emittedPower(day.take(), content);
        EXPECT_NEAR(power.value.x, 5 * shadow(down), 4 * power.error + 1e-5);
        SceneMaker sky;
        addBlackBox(sky);
        sky.addWhiteEnvironment();
        const Mean white = emittedPower(sky.take(), content);
        EXPECT_NEAR(white.value.x, 4 * kPi * 22 / 4, 4 * white.error);
        EXPECT_LT(white.error, 0.05 * white.value.x) << "too coarse to tell anything";
    }
}

/// Of the power that comes to vertices in `where` after it has been scattered outside of it. A walk is one sample.
Mean scatteredInto(const tracing::TracerScene& scene, const Bounds& where,
                   const Bounds& content) {
    const tracing::LightEmission emission(scene, content);
    tracing::LightWalker walker(scene, emission, {});
    std::vector<tracing::WalkVertex> walk;
    constexpr uint32_t kWalks = 1600000;
    dvec3 sum(0);
    double squares = 0;
    for (uint32_t i = 0; i < kWalks; ++i) {
        tracing::Sampler sampler(11, 0, i);
        walker.trace(sampler, walk);
        dvec3 into(0);
        for (const tracing::WalkVertex& vertex : walk)
            if (vertex.scatterings > 1 && where.contains(vertex.position)) into += vertex.power;
        sum += into / double(kWalks);
        squares += into.x * into.x / double(kWalks);
    }
    return {sum, std::sqrt(std::max(squares - sum.x * sum.x, 0.0) / double(kWalks))};
}

TEST(LightWalker, AimingAtTheContentChangesNoLight) {
    // A lamp over shining ground, seen from a box and a puff far away; fog between them that scatters forward.
    const dvec3 there(12, 4, 0);
    const Bounds around{there - dvec3(1), there + dvec3(1)};
    SceneMaker maker;
    Material ground = matt({0.6f, 0.5f, 0.4f});
    ground.roughness = 0.3f;
    ground.specular = 1;
    maker.addPrimitive(PrimitiveShape::Box, {60, 0.2, 60}, ground);
    maker.addPrimitive(PrimitiveShape::Box, {0.8, 0.8, 0.8}, matt({0.5f, 0.5f, 0.5f}),
                       glm::translate(dmat4(1), there));
    for (const bool wide : {true, false}) {
        Medium fog;
        fog.kind = MediumKind::Sphere;
        fog.size = dvec3(wide ? 50 : 0.9);
        fog.scattering = vec3(wide ? 0.02f : 1.0f);
        fog.anisotropy = wide ? 0.7f : 0.0f;
        maker.addMedium(fog, glm::translate(dmat4(1), wide ? dvec3(0) : there));
    }
    maker.addPointLight({0, 2, 0}, 10, 0);
    const Scene scene = maker.take();
    auto traced = tracing::TracerScene::build(scene, dvec3(0), 1);
    ASSERT_TRUE(traced.ok()) << traced.message();
    const Mean plain = scatteredInto(*traced, around, {}),
               directed = scatteredInto(*traced, around, around);
    const double error = std::hypot(plain.error, directed.error);
    printf("%.5f W, directed %+.2f standard errors; errors %.2f %%, %.2f %%\n", plain.value.x,
           (directed.value.x - plain.value.x) / error, 100 * plain.error / plain.value.x,
           100 * directed.error / directed.value.x);
    EXPECT_LE(std::abs(directed.value.x - plain.value.x), 3 * error);
    EXPECT_LT(error, 0.05 * plain.value.x) << "too coarse to tell anything";
    EXPECT_LT(directed.error, 0.7 * plain.error) << "not sampled towards it at all";
}

TEST(InstantRadiosity, TheMeanIsTheSameForEveryBound) {
    SceneMaker maker;
    addLampOverABlock(maker, true);
    const int camera = maker.addCamera({0.3, 0.7, 4}, {0, 0, 0});
    const Scene scene = maker.take();
    reference::RenderSettings settings;
    settings.width = settings.height = 6;
    settings.path.terms = kIndirectOnSurfaces | kIndirectInMedia;
    const auto render = [&](reference::Integrator integrator, double clamp, bool compensate,
                            uint32_t samples) {
        settings.integrator = integrator;
        settings.clampDistance = clamp;
        settings.compensate = compensate;
        settings.seed += 1;
        auto started = reference::ReferenceRender::start(scene, camera, settings);
        if (!started.ok()) throw std::runtime_error(started.message());
        started->addSamples(samples);
        Mean mean;
        const Image beauty = started->film().beauty(), variance = started->film().variance();
        const double n = double(beauty.pixels.size());
        double sum = 0;
        for (size_t i = 0; i < beauty.pixels.size(); ++i) {
            mean.value.x += double(beauty.pixels[i]) / n;
            sum += 3 * double(variance.pixels[i]) / (n * n); // channels go up and down together
        }
        mean.error = std::sqrt(sum);
        return mean;
    };
    const Mean truth = render(reference::Integrator::Volume, 0, true, 4096);
    for (const double clamp : {0.003, 0.03, 0.3, 3.0, 30.0}) {
        const Mean mean = render(reference::Integrator::InstantRadiosity, clamp, true,
                                 clamp < 0.01  ? 131072
                                 : clamp < 0.1 ? 32768
                                               : 8192);
        const double error = std::hypot(mean.error, truth.error);
        printf("bound at %g m: %.5f, %+.2f standard errors (%.2f %%)\n", clamp, mean.value.x,
               (mean.value.x - truth.value.x) / error, 100 * error / truth.value.x);
        EXPECT_LE(std::abs(mean.value.x - truth.value.x), 3 * error) << clamp;
        EXPECT_LT(error, 0.03 * truth.value.x) << "too coarse to tell anything";
    }
    // And without what makes up for it the bound is seen.
    const double clampedAtOne =
        render(reference::Integrator::InstantRadiosity, 1, false, 4096).value.x;
    EXPECT_LT(clampedAtOne, 0.8 * truth.value.x);
}

} // namespace
} // namespace tyndall::validation
