// The reference's lights: closed forms of what they send, and densities that are what they say.

#include <cmath>
#include <gtest/gtest.h>

#include "chi_square.h"
#include "tracing/environment_source.h"
#include "tracing/light_source.h"
#include "validation/scenes.h"

namespace tyndall::validation {
namespace {

using tracing::EnvironmentSource;
using tracing::LampSample;
using tracing::LightSource;
using tracing::Sampler;

Light lightOf(LightType type, float intensity, float radius) {
    Light light;
    light.type = type;
    light.intensity = intensity;
    light.radius = radius;
    return light;
}

/// On a surface facing `normal` at `from`, by samples; checks that each is met again by a ray along it, with the same density.
double irradiance(const LightSource& light, const dvec3& from, const dvec3& normal) {
    double sum = 0;
    constexpr uint32_t kSamples = 40000;
    for (uint32_t i = 0; i < kSamples; ++i) {
        Sampler sampler(4, 0, i);
        const LampSample sample = light.sample(from, sampler.next2());
        if (!(sample.density > 0)) continue;
        sum += sample.radiance.y * std::max(0.0, glm::dot(sample.direction, normal)) /
               sample.density / kSamples;
        if (light.delta() || i % 16 != 0) continue;
        const LampSample met = light.meet({from, sample.direction});
        // A ray to the very edge may miss by a rounding.
        if (!(met.density > 0)) continue;
        EXPECT_NEAR(met.density, sample.density, 1e-6 * sample.density);
        EXPECT_NEAR(met.radiance.y, sample.radiance.y, 1e-6 * sample.radiance.y);
    }
    return sum;
}

TEST(ReferenceLightSource, ABallOfLightHasTheIrradianceOfAPointAtItsCentre) {
    // Lambert's ball that is wholly above the horizon: I/d²·cosine, whatever its radius.
    for (const float radius : {0.0f, 0.2f, 1.5f}) {
        const LightSource light(lightOf(LightType::Point, 7, radius),
                                lookAlong({0, 0, -1}, {0, 0, 3}));
        EXPECT_NEAR(irradiance(light, dvec3(0), {0, 0, 1}), 7.0 / 9, 7.0 / 9 * 2e-3) << radius;
        const dvec3 aslant(0.6, 0, 0.8);
        EXPECT_NEAR(irradiance(light, dvec3(0), aslant), 0.8 * 7.0 / 9, 7.0 / 9 * 2e-3) << radius;
    }
}

TEST(ReferenceLightSource, ARectangleHasTheIrradianceOfItsFormFactor) {
    Light rect = lightOf(LightType::Rect, 1, 0);
    rect.size = {2, 3};
    rect.radiance = vec3(5);
    const LightSource light(rect, lookAlong({0, 0, -1}, {0, 0, 2}));
    // Four quarters seen from below the shared corner (Siegel and Howell, configuration C-11): a = 1/2, b = 1.5/2.
    const double a = 0.5, b = 0.75, x = std::sqrt(1 + a * a), y = std::sqrt(1 + b * b);
    const double quarter = (a / x * std::atan(b / x) + b / y * std::atan(a / y)) / (2 * kPi);
    EXPECT_NEAR(irradiance(light, dvec3(0), {0, 0, 1}), 5 * kPi * 4 * quarter, 0.02);
    EXPECT_EQ(irradiance(light, {0, 0, 4}, {0, 0, -1}), 0) << "it shines from one side";
}

TEST(ReferenceLightSource, ASunHasItsLuxWhateverItsDisc) {
    for (const float radius : {0.0f, 0.00465f, 0.6f}) {
        const LightSource light(lightOf(LightType::Directional, 3, radius), lookAlong({0, 0, -1}));
        EXPECT_NEAR(irradiance(light, dvec3(0), {0, 0, 1}), 3, 6e-3) << radius;
    }
}

TEST(ReferenceLightSource, ASpotFadesByItsConeAndItsRange) {
    Light spot = lightOf(LightType::Spot, 4, 0);
    spot.innerConeAngle = 0.3f;
    spot.outerConeAngle = 0.7f;
    spot.range = 10;
    const LightSource light(spot, lookAlong({0, 0, -1}));
    const auto at = [&](double angle, double distance) {
        const dvec3 from(distance * std::sin(angle), 0, -distance * std::cos(angle));
        return light.sample(from, dvec2(0.5)).radiance.y;
    };
    const double window = 1 - std::pow(0.2, 4); // KHR_lights_punctual at 2 of 10 metres
    EXPECT_NEAR(at(0, 2), window, 1e-6);
    EXPECT_NEAR(at(0.29, 2), window, 1e-6);
    const double part = (std::cos(0.5) - std::cos(0.7)) / (std::cos(0.3) - std::cos(0.7));
    EXPECT_NEAR(at(0.5, 2), window * part * part, 1e-6);
    EXPECT_EQ(at(0.71, 2), 0);
    EXPECT_EQ(at(0, 10.01), 0);
}

Environment uneven() {
    Environment environment;
    auto image = std::make_shared<Image>(12, 6, 3);
    for (size_t i = 0; i < image->pixels.size(); ++i)
        image->pixels[i] = i / 3 == 17 ? 40.0f : 0.1f * float((i / 3 * 7) % 11);
    environment.image = image;
    environment.intensity = 2;
    environment.rotation = 0.6f;
    return environment;
}

TEST(ReferenceEnvironment, DirectionsAreDrawnAsTheDensitySaysAndItAddsUpToOne) {
    const EnvironmentSource source(uneven());
    constexpr uint32_t kDrawn = 60000;
    ChiSquare test(12, 24);
    double total = 0;
    for (uint32_t i = 0; i < kDrawn; ++i) {
        Sampler sampler(5, 0, i);
        const auto sample = source.sample({sampler.random(), sampler.random()});
        test.count(sample.direction);
        ASSERT_GT(sample.density, 0);
        const dvec3 any = tracing::directionAround(1 - 2 * sampler.random(), sampler.random());
        total += source.density(any) * 4 * kPi / kDrawn;
        EXPECT_EQ(tracing::maximumOf(source.radiance(any)) > 0 && !(source.density(any) > 0), false)
            << "light that is never sampled";
    }
    EXPECT_NEAR(total, 1, 0.03);
    // The density has steps that 24 midpoints a bin see to some 10⁻³: they add a little to χ².
    EXPECT_LT(std::abs(test.excess([&](const dvec3& d) { return source.density(d); }, kDrawn)), 8);
}

TEST(ReferenceEnvironment, RotationTurnsTheImageAboutTheVertical) {
    Environment environment = uneven();
    const EnvironmentSource turned(environment);
    environment.rotation = 0;
    const EnvironmentSource straight(environment);
    const double angle = double(0.6f);
    for (uint32_t i = 0; i < 100; ++i) {
        Sampler sampler(6, 0, i);
        const dvec3 d = tracing::directionAround(1 - 2 * sampler.random(), sampler.random());
        const dvec3 there(std::cos(angle) * d.x + std::sin(angle) * d.z, d.y,
                          -std::sin(angle) * d.x + std::cos(angle) * d.z); // right-handed about +Y
        EXPECT_NEAR(turned.radiance(there).y, straight.radiance(d).y, 1e-9);
    }
}

TEST(ReferenceEnvironment, TheImageHasItsMiddleAtMinusZAndItsRightAtPlusX) {
    Environment environment;
    auto image = std::make_shared<Image>(8, 4, 3);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 8; ++x) image->at(x, y)[1] = float(x + 10 * y);
    environment.image = image;
    const EnvironmentSource source(environment);
    // At u = 0.5 and 0.75, v = 0.5: between the texels on both sides.
    EXPECT_NEAR(source.radiance({0, 0, -1}).y, 3.5 + 15, 1e-9);
    EXPECT_NEAR(source.radiance({1, 0, 0}).y, 5.5 + 15, 1e-9);
}

} // namespace
} // namespace tyndall::validation
