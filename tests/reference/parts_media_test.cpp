// Media along rays: depths against independent integrals, densities that are what they say.

#include <cmath>
#include <gtest/gtest.h>

#include "media/segment_integral.h"
#include "tracing/media_segment.h"
#include "validation/scenes.h"

namespace tyndall::validation {
namespace {

using tracing::MediaField;
using tracing::MediaSegment;
using tracing::Ray;
using tracing::Sampler;

dvec3 anyDirection(Sampler& sampler) {
    return tracing::directionAround(1 - 2 * sampler.random(), sampler.random());
}

dmat4 anyPlace(Sampler& sampler) {
    dmat4 place = lookAlong(anyDirection(sampler), anyDirection(sampler));
    for (int axis = 0; axis < 3; ++axis)
        place[axis] *= (0.4 + sampler.random()) * (sampler.random() < 0.3 ? -1 : 1);
    return place;
}

Medium anyMedium(MediumKind kind, Sampler& sampler) {
    Medium medium;
    medium.kind = kind;
    medium.scattering = {0.4f, 1, 2};
    medium.absorption = {0.3f, 0.1f, 0};
    medium.size = {1 + sampler.random(), 2, 1.5};
    medium.scaleHeight = 0.3 + sampler.random();
    if (kind == MediumKind::Grid) medium.density = lumpyGrid(2, 3, sampler.bits() % 1000);
    return medium;
}

TEST(ReferenceSegment, ExactTransmittanceIsThatOfTheSceneEnginesIntegral) {
    for (const MediumKind kind : {MediumKind::Box, MediumKind::Sphere, MediumKind::Height,
                                  MediumKind::Grid, MediumKind::Everywhere})
        for (uint32_t i = 0; i < 60; ++i) {
            Sampler sampler(21, uint64_t(kind), i);
            const Medium medium = anyMedium(kind, sampler);
            const dmat4 place = anyPlace(sampler);
            SceneMaker maker;
            maker.addMedium(medium, place);
            const MediaField field(maker.scene(), dvec3(0));
            const Ray ray{2.0 * anyDirection(sampler), anyDirection(sampler)};
            const double length = 4 * sampler.random();
            const dvec3 depth = opticalDepth(medium, place, {ray.origin, ray.direction, length});
            const dvec3 through = tracing::transmittance(
                field, ray, length, tracing::TransmittanceMode::Exact, sampler);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(through[c], std::exp(-depth[c]), 1e-6 * std::exp(-depth[c]) + 1e-12)
                    << int(kind) << " " << i;
        }
}

class SegmentDraws : public ::testing::TestWithParam<MediumKind> {};

TEST_P(SegmentDraws, CollisionsAreDrawnAsTheirDensitySaysAndItAddsUp) {
    Sampler sampler(22, uint64_t(GetParam()), 0);
    const Medium medium = anyMedium(GetParam(), sampler);
    SceneMaker maker;
    maker.addMedium(medium, lookAlong({0.3, 0.2, 1}));
    const MediaField field(maker.scene(), dvec3(0));
    MediaSegment segment(field);
    const Ray ray{{0.1, 0.2, 2}, glm::normalize(dvec3(0.05, -0.1, -1))};
    segment.start(ray, 4);
    const auto reach = segment.reach();
    ASSERT_FALSE(reach.empty());
    constexpr int kSteps = 40000, kBins = 20;
    double total = 0, flight = 0, expected[kBins] = {}, drawn[kBins] = {};
    for (int i = 0; i < kSteps; ++i) {
        const double t = reach.begin + (reach.end - reach.begin) * (i + 0.5) / kSteps,
                     dt = (reach.end - reach.begin) / kSteps;
        total += segment.collisionDensity(t) * dt;
        flight += segment.flightDensity(t) * dt;
        expected[i * kBins / kSteps] += segment.collisionDensity(t) * dt;
    }
    // Densities have steps at the pieces' ends: midpoints see them to a step's width.
    EXPECT_NEAR(total, 1, 2e-3);
    EXPECT_NEAR(flight, segment.collisionChance(), 2e-3);
    constexpr int kDraws = 20000;
    for (int i = 0; i < kDraws; ++i) {
        const MediaSegment::Draw draw = segment.drawCollision((i + 0.5) / kDraws);
        ASSERT_GT(draw.density, 0);
        ASSERT_NEAR(draw.density, segment.collisionDensity(draw.distance), 1e-9 * draw.density);
        const double part = (draw.distance - reach.begin) / (reach.end - reach.begin);
        drawn[std::clamp(int(part * kBins), 0, kBins - 1)] += 1.0 / kDraws;
    }
    for (int bin = 0; bin < kBins; ++bin) EXPECT_NEAR(drawn[bin], expected[bin], 1e-3) << bin;
}

TEST_P(SegmentDraws, FlightsCollideAsOftenAsTheTransmittanceSays) {
    Sampler maker0(23, uint64_t(GetParam()), 0);
    Medium medium = anyMedium(GetParam(), maker0);
    SceneMaker maker;
    maker.addMedium(medium, lookAlong({0.3, 0.2, 1}));
    const MediaField field(maker.scene(), dvec3(0));
    const Ray ray{{0.1, 0.2, 2}, glm::normalize(dvec3(0.05, -0.1, -1))};
    MediaSegment segment(field);
    tracing::MediumPoint point;
    dvec3 passed(0);
    constexpr uint32_t kFlights = 40000;
    for (uint32_t i = 0; i < kFlights; ++i) {
        Sampler sampler(24, uint64_t(GetParam()), i);
        tracing::PathWeights weights;
        weights.hero = int(sampler.bits() % 3);
        std::vector<tracing::EmittedLight> emitted;
        segment.start(ray, 4);
        if (!segment.fly(sampler, weights, point, emitted).collided)
            passed += weights.carried() / double(kFlights);
    }
    Sampler unused(0, 0, 0);
    const dvec3 through =
        tracing::transmittance(field, ray, 4, tracing::TransmittanceMode::Exact, unused);
    // Weights are at most 3, values at most 1: a standard error of at most √(3·T/N).
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(passed[c], through[c], 4 * std::sqrt(3 * through[c] / kFlights)) << c;
}

INSTANTIATE_TEST_SUITE_P(Kinds, SegmentDraws,
                         ::testing::Values(MediumKind::Box, MediumKind::Sphere, MediumKind::Height,
                                           MediumKind::Grid));

} // namespace
} // namespace tyndall::validation
