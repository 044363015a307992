#pragma once
// The reference path tracer as a job, in memory: it traces until a goal is reached, and says how far the picture may still be off.

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>

#include "app/job.h"
#include "app/outcome.h"
#include "reference/render.h"

namespace tyndall {

/// When a picture is good enough: at whichever comes first. 0: not a goal.
struct ReferenceGoals {
    int64_t spp = 0;        // samples a pixel, those of a resumed run included
    double seconds = 0;     // of rendering, without set-up
    double targetError = 0; // Film::estimatedRelmse()

    [[nodiscard]] bool any() const { return spp > 0 || seconds > 0 || targetError > 0; }
};

class ReferenceTracer {
public:
    /// The scene must outlive it and stay as it is. Errors: as ReferenceRender::start.
    static Result<std::unique_ptr<ReferenceTracer>>
    start(const Scene& scene, int cameraNode, const reference::RenderSettings& settings);

    /// To be called after film() was filled with the samples of an earlier run.
    void resume();
    /// Traces pass by pass, each of about two seconds, until a goal is reached; CHECKs that there is one. How samples are divided
    /// into passes changes none of them. `afterPass`, where given, runs after each pass but the last; its failure ends the work.
    /// Cancelled, it ends within a tile; the film is then good for nothing.
    Outcome trace(const ReferenceGoals& goals, JobControl& job,
                  const std::function<Outcome()>& afterPass = {});

    [[nodiscard]] reference::Film& film() { return render_.film(); }
    [[nodiscard]] const reference::Film& film() const { return render_.film(); }
    [[nodiscard]] const reference::ReferenceRender& render() const { return render_; }
    /// Estimated relmse of the picture so far; infinite before the first pass.
    [[nodiscard]] double error() const { return error_; }
    [[nodiscard]] double setupSeconds() const { return setupSeconds_; }
    /// Spent in trace().
    [[nodiscard]] double renderSeconds() const { return renderSeconds_; }
    /// Samples a pixel that this process traced.
    [[nodiscard]] uint32_t samplesTaken() const { return film().samples() - samplesBefore_; }

private:
    ReferenceTracer(reference::ReferenceRender render, double setupSeconds)
        : render_(std::move(render)), setupSeconds_(setupSeconds) {}
    [[nodiscard]] uint32_t nextPass(const ReferenceGoals& goals) const;
    [[nodiscard]] bool reached(const ReferenceGoals& goals) const;
    [[nodiscard]] double fractionDone(const ReferenceGoals& goals) const;

    reference::ReferenceRender render_;
    double setupSeconds_ = 0, renderSeconds_ = 0, error_ = INFINITY;
    uint32_t samplesBefore_ = 0;
};

} // namespace tyndall
