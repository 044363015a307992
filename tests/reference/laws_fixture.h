#pragma once
// Two ways to measure the same light.

#include <gtest/gtest.h>

#include "validation/measure.h"
#include "validation/scenes.h"

namespace tyndall::validation {

using tracing::CameraRays;
using tracing::Ray;
using tracing::Sampler;
using tracing::TermLight;
using reference::VolumePathTracer;
using Tracers = std::vector<VolumePathTracer>;

/// Rays that start at `from` towards points spread over a ball of `radius` round `to`; the chosen channel of what they see.
inline Probe gaze(std::shared_ptr<const Stage> stage, const dvec3& from, const dvec3& to,
                  double radius, int channel = 1, const reference::PathSettings& settings = {}) {
    Probe probe;
    probe.stage = std::move(stage);
    probe.settings = {settings};
    probe.sample = [=](Tracers& tracers, Sampler& sampler) {
        const dvec2 u = sampler.next2();
        const dvec3 at =
            to + radius * std::cbrt(sampler.next1()) * tracing::directionAround(1 - 2 * u.x, u.y);
        TermLight light;
        tracers[0].trace({{from, glm::normalize(at - from)}, 0}, sampler, light);
        return light.sum()[channel];
    };
    return probe;
}

/// Relative error 10⁻³ or `segments`, whichever is cheaper; the two share no random numbers. `slack`: relative, for what the two
/// may honestly differ by.
inline void expectSameLight(const Probe& a, const Probe& b, uint64_t seed, const std::string& what,
                            double segments = 4e5, double slack = 0) {
    Effort effort;
    effort.segments = segments;
    const Estimate first = measure(a, effort, tracing::mixBits(2 * seed)),
                   second = measure(b, effort, tracing::mixBits(2 * seed + 1));
    const double error = std::hypot(first.error, second.error, slack * first.value);
    const double t = (first.value - second.value) / error;
    std::printf("%s: %.6g ± %.1g and %.6g ± %.1g, t %+.2f\n", what.c_str(), first.value,
                first.error, second.value, second.error, t);
    EXPECT_GT(first.value, 0) << what;
    EXPECT_LE(std::abs(t), kLargestT) << what;
    EXPECT_LT(error, 0.03 * first.value) << what << ": too coarse to tell anything";
    EXPECT_EQ(first.counts.nonFinite + second.counts.nonFinite, 0u) << what;
    EXPECT_EQ(first.counts.negative + second.counts.negative, 0u) << what;
    EXPECT_EQ(first.counts.cutOff + second.counts.cutOff, 0u) << what;
}

} // namespace tyndall::validation
