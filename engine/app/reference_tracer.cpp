#include "app/reference_tracer.h"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "core/check.h"

namespace tyndall {
namespace {

double now() {
    using Clock = std::chrono::steady_clock;
    return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

} // namespace

Result<std::unique_ptr<ReferenceTracer>>
ReferenceTracer::start(const Scene& scene, int cameraNode,
                       const reference::RenderSettings& settings) {
    const double begun = now();
    auto render = reference::ReferenceRender::start(scene, cameraNode, settings);
    if (!render.ok()) return render.error();
    return std::unique_ptr<ReferenceTracer>(new ReferenceTracer(std::move(*render), now() - begun));
}

void ReferenceTracer::resume() {
    samplesBefore_ = film().samples();
    if (samplesBefore_ > 0) error_ = film().estimatedRelmse();
}

/// 0 to 1 and more: how far towards the nearest of the goals.
double ReferenceTracer::fractionDone(const ReferenceGoals& goals) const {
    double fraction = 0;
    if (goals.spp > 0) fraction = std::max(fraction, double(film().samples()) / double(goals.spp));
    if (goals.seconds > 0) fraction = std::max(fraction, renderSeconds_ / goals.seconds);
    if (goals.targetError > 0 && error_ > 0)
        fraction = std::max(fraction, goals.targetError / error_);
    if (goals.targetError > 0 && error_ == 0) fraction = 1; // a black picture, or one without noise
    return fraction;
}

bool ReferenceTracer::reached(const ReferenceGoals& goals) const {
    // An error can be told once every stream has a sample or two.
    const uint32_t fewest = 2 * tracing::kStreams;
    const uint32_t have = film().samples();
    if (have == 0) return false;
    if (goals.spp > 0 && have >= uint64_t(goals.spp)) return true;
    if (goals.seconds > 0 && renderSeconds_ >= goals.seconds) return true;
    return goals.targetError > 0 && have >= fewest && error_ <= goals.targetError;
}

/// Samples of the next pass: about two seconds' worth, never past the goals.
uint32_t ReferenceTracer::nextPass(const ReferenceGoals& goals) const {
    constexpr double kPassSeconds = 2;
    const uint32_t have = film().samples(), taken = samplesTaken();
    double samples = taken == 0 ? 1 : kPassSeconds * taken / std::max(renderSeconds_, 1e-3);
    samples =
        std::min(samples, 4.0 * std::max(1u, taken)); // the first passes say little of the speed
    if (goals.spp > 0) samples = std::min(samples, double(goals.spp) - have);
    if (goals.seconds > 0 && taken > 0)
        samples = std::min(samples, (goals.seconds - renderSeconds_) * taken /
                                        std::max(renderSeconds_, 1e-3));
    return uint32_t(std::max(1.0, samples));
}

Outcome ReferenceTracer::trace(const ReferenceGoals& goals, JobControl& job,
                               const std::function<Outcome()>& afterPass) {
    CHECK(goals.any());
    JobPhase phase(job, "rendering");
    const double begun = now() - renderSeconds_; // as if it had never paused
    while (!reached(goals)) {
        if (!render_.addSamples(nextPass(goals), [&job] { return job.cancelled(); }))
            return failed("interrupted");
        renderSeconds_ = now() - begun;
        error_ = film().estimatedRelmse();
        phase.update(
            fractionDone(goals),
            fmt::format("rendering: {} samples a pixel, relmse {:.2g}", film().samples(), error_));
        if (!afterPass || reached(goals)) continue;
        if (Outcome done = afterPass(); !done.ok()) return done;
    }
    return {};
}

} // namespace tyndall
