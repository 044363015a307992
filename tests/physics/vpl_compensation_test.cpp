// Bias compensation by paths: all light where nothing is left to virtual lights, nothing where nothing is clamped, and never what a step in
// media has gathered.

#include <cmath>

#include <gtest/gtest.h>

#include "reference/render.h"
#include "validation/scenes.h"
#include "volumetric_gi/vpl/bias_compensation.h"

namespace tyndall::validation {
namespace {

constexpr int kSide = 6;

struct Compensation {
    tracing::TermLight mean;
    double error = 0; // standard, of the sum's mean over channels
    uint64_t nonFinite = 0;
};

Scene lampOverAnAngle(bool fog, int& camera) {
    SceneMaker maker;
    addLampOverABlock(maker, fog);
    maker.addPrimitive(PrimitiveShape::Box, {0.2, 1, 1}, matt({0.5f, 0.6f, 0.7f}));
    camera = maker.addCamera({0.3, 0.7, 4}, {0, 0, 0});
    return maker.take();
}

Compensation missed(const Scene& scene, int camera, bool inMedia,
                   const volumetric_gi::GpuClamps& clamps, uint32_t samples) {
    const tracing::CameraRays rays(scene, camera, kSide, kSide);
    auto traced = tracing::TracerScene::build(scene, rays.origin(), 1);
    if (!traced.ok()) throw std::runtime_error(traced.message());
    const tracing::LightEmission emission(*traced, {});
    tracing::VirtualLightPathSettings settings;
    settings.terms = kIndirectOnSurfaces | kIndirectInMedia;
    settings.clampDistance = 0.5;
    volumetric_gi::BiasCompensation tracer(*traced, emission, settings, clamps);
    Compensation result;
    double squares = 0;
    const double count = double(kSide) * kSide * samples;
    for (uint32_t pixel = 0; pixel < kSide * kSide; ++pixel)
        for (uint32_t i = 0; i < samples; ++i) {
            tracing::Sampler sampler(5, pixel, i);
            const auto ray = rays.through(int(pixel) % kSide, int(pixel) / kSide, sampler.next2());
            tracing::TermLight light;
            if (inMedia)
                tracer.traceInMedia(ray, sampler, light);
            else
                tracer.traceOnSurface(ray, sampler, light);
            for (size_t t = 0; t < light.terms.size(); ++t)
                result.mean.terms[t] += light.terms[t] / count;
            squares += std::pow(tracing::meanOf(light.sum()), 2) / count;
        }
    const double mean = tracing::meanOf(result.mean.sum());
    result.error = std::sqrt((squares - mean * mean) / count);
    result.nonFinite = tracer.counts().nonFinite;
    return result;
}

TEST(Compensation, WithAnEndlessClampDistanceItIsAllLightBetweenSurfaces) {
    int camera = 0;
    const Scene scene = lampOverAnAngle(false, camera);
    reference::RenderSettings settings;
    settings.width = settings.height = kSide;
    settings.path.terms = kIndirectOnSurfaces;
    auto started = reference::ReferenceRender::start(scene, camera, settings);
    ASSERT_TRUE(started.ok()) << started.message();
    started->addSamples(32768);
    double truth = 0, variance = 0;
    const Image beauty = started->film().beauty(), variances = started->film().variance();
    const double n = double(beauty.pixels.size());
    for (size_t i = 0; i < beauty.pixels.size(); ++i) {
        truth += double(beauty.pixels[i]) / n;
        variance += 3 * double(variances.pixels[i]) / (n * n); // channels go together
    }
    const Compensation found = missed(scene, camera, false, {1e6, 1e6, 1e6, 1}, 131072);
    const double mean = tracing::meanOf(found.mean.sum());
    const double error = std::hypot(found.error, std::sqrt(variance));
    printf("all of it: %.5f and %.5f, %+.2f standard errors of %.2f %%\n", mean, truth,
           (mean - truth) / error, 100 * error / truth);
    EXPECT_NEAR(mean, truth, 3 * error); // beyond by chance: one in 370
    EXPECT_LT(error, 0.03 * truth) << "too coarse to tell anything";
    EXPECT_EQ(found.nonFinite, 0u);
}

TEST(Compensation, WithoutClampingThereIsNone) {
    int camera = 0;
    const Scene scene = lampOverAnAngle(true, camera);
    for (const bool inMedia : {false, true})
        EXPECT_EQ(missed(scene, camera, inMedia, {0, 0, 0, 1}, 256).mean.sum(), dvec3(0));
}

TEST(Compensation, WhatAStepInMediaGathersIsNotBroughtAgain) {
    int camera = 0;
    const Scene scene = lampOverAnAngle(true, camera);
    const auto light = [](const Compensation& found, Term term) {
        return tracing::meanOf(found.mean.terms[size_t(term)]);
    };
    // No surface is within reach of media: paths go through two media vertices before they gather.
    const Compensation media = missed(scene, camera, true, {0, 1, 0, 1}, 4096);
    EXPECT_GT(light(media, Term::LXVVE), 0);
    EXPECT_EQ(light(media, Term::LVVE), 0);
    EXPECT_EQ(light(media, Term::LSVE), 0);
    const Compensation surfaces = missed(scene, camera, false, {0, 1, 0, 1}, 4096);
    EXPECT_GT(light(surfaces, Term::LXVSE), 0);
    EXPECT_EQ(light(surfaces, Term::LVSE), 0);
    EXPECT_EQ(light(surfaces, Term::LSSE), 0);
    // Of even light F(x), transport.md 4.1, is lost at the step's end: F(1/4) / F(1) = 0.33.
    EXPECT_LT(tracing::meanOf(missed(scene, camera, true, {0, 1, 0, 4}, 4096).mean.sum()),
              0.5 * tracing::meanOf(media.mean.sum()));
    EXPECT_EQ(media.nonFinite + surfaces.nonFinite, 0u);
}

} // namespace
} // namespace tyndall::validation
