// The reference's materials: what is drawn is distributed as it says, and no energy is made.

#include <cmath>
#include <gtest/gtest.h>

#include "chi_square.h"
#include "tracing/bsdf.h"

namespace tyndall::validation {
namespace {

using tracing::Bsdf;
using tracing::BsdfSample;
using tracing::Sampler;
using tracing::Surface;

Surface surfaceOf(double roughness, double metallic, double specular) {
    Surface surface;
    surface.baseColor = {0.9, 0.5, 0.2};
    surface.roughness = roughness;
    surface.metallic = metallic;
    surface.specular = specular;
    return surface;
}

dvec3 eyeAt(double cosine) { return {std::sqrt(1 - cosine * cosine), 0, cosine}; }

TEST(ReferenceBsdf, SamplesAreDistributedAsTheirDensitySays) {
    uint64_t stream = 0;
    for (const double roughness : {0.35, 0.6, 1.0})
        for (const double cosine : {0.25, 0.7, 1.0})
            for (const double metallic : {0.0, 0.5, 1.0}) {
                const Bsdf bsdf(surfaceOf(roughness, metallic, 1), eyeAt(cosine));
                // Directions under the surface count as none: the density of the others need not add up to 1.
                ChiSquare test(16, 16);
                for (uint32_t i = 0; i < 40000; ++i) {
                    Sampler sampler(1, stream, i);
                    const double choice = sampler.random();
                    const BsdfSample sample =
                        bsdf.sample(choice, {sampler.random(), sampler.random()});
                    if (sample.density > 0) {
                        test.count(sample.direction);
                        ASSERT_NEAR(sample.density, bsdf.density(sample.direction),
                                    1e-6 * sample.density);
                        const dvec3 weight = bsdf.evaluate(sample.direction) / sample.density;
                        ASSERT_NEAR(sample.weight.x, weight.x, 1e-6 * weight.x + 1e-12);
                    }
                }
                ++stream;
                const double z =
                    test.excess([&](const dvec3& d) { return bsdf.density(d); }, 40000);
                EXPECT_LT(std::abs(z), 5) << roughness << " " << cosine << " " << metallic;
            }
}

/// The part of light from everywhere that leaves towards the eye, by the surface's own samples.
double albedoOf(const Surface& surface, double cosine) {
    const Bsdf bsdf(surface, eyeAt(cosine));
    constexpr uint32_t kSamples = 40000;
    double sum = 0;
    for (uint32_t i = 0; i < kSamples; ++i) {
        Sampler sampler(2, 0, i);
        const double choice = sampler.next1();
        sum += bsdf.sample(choice, sampler.next2()).weight.y / kSamples;
    }
    return sum;
}

// Metal alone: glTF's mixture of coat and base, which this must be, reflects more than it gets at grazing angles.
TEST(ReferenceBsdf, WhiteMetalSendsBackNoMoreThanItGets) {
    Surface metal = surfaceOf(1, 1, 1);
    metal.baseColor = dvec3(1);
    for (const double roughness : {0.1, 0.35, 0.6, 1.0})
        for (const double cosine : {0.1, 0.5, 1.0}) {
            metal.roughness = roughness;
            EXPECT_LT(albedoOf(metal, cosine), 1.002) << roughness << " " << cosine;
        }
    metal.roughness = 0.1;
    EXPECT_GT(albedoOf(metal, 1), 0.99) << "smooth metal is a mirror";
    // α = 1 seen head-on: D = 1/π, G₁(v) = 1, and ∫ 2c/(1+c)/(4π) dω = 1 - ln 2.
    metal.roughness = 1;
    EXPECT_NEAR(albedoOf(metal, 1), 1 - std::log(2.0), 2e-3);
}

TEST(ReferenceBsdf, LambertReflectsItsColourFromEverywhereAndBothWaysAlike) {
    Surface surface = surfaceOf(1, 0, 0);
    for (const double a : {0.2, 0.9})
        for (const double b : {0.3, 1.0}) {
            const dvec3 v = eyeAt(a), l(0, std::sqrt(1 - b * b), b);
            const dvec3 there = Bsdf(surface, v).evaluate(l) / b;
            EXPECT_NEAR(there.x, 0.9 / kPi, 1e-12);
            surface.specular = 1;
            surface.roughness = 0.4;
            const dvec3 shiny = Bsdf(surface, v).evaluate(l) / b,
                        back = Bsdf(surface, l).evaluate(v) / a;
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(shiny[c], back[c], 1e-12);
            surface.specular = 0;
            surface.roughness = 1;
        }
    EXPECT_EQ(Bsdf(surface, eyeAt(0.5)).evaluate({0, 0.6, -0.8}), dvec3(0));
}

} // namespace
} // namespace tyndall::validation
