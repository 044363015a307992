#include "app/capture_run.h"

#include <fmt/format.h>

#include "app/program.h"
#include "core/image_metrics.h"
#include "core/log.h"

namespace tyndall {

Outcome CaptureRun::run(JobControl& job) {
    if (Outcome opened = RenderSession::open(options_.render, job, &profiler_, session_);
        !opened.ok())
        return opened;
    if (options_.timeStep != CaptureOptions{}.timeStep)
        log::info(fmt::format(
            "note: --time-step {}: nothing in a scene is played yet, so it has no effect",
            options_.timeStep));
    RecordedFrames frames;
    frames.converge = options_.converge;
    frames.separateTerms = options_.hasAov("terms");
    frames.statistics = !options_.report.empty();
    frames.timeStep = options_.timeStep;
    recorder_ = std::make_unique<FrameRecorder>(*session_, frames);
    if (Outcome rendered = renderFrames(job); !rendered.ok()) return rendered;
    report_ = recorder_->report();
    report_.glObjectsLeaked = session_->closeRendererAndCountLeaks();
    report_.glErrors = session_->context().debugLog().count(gl::Severity::High);
    if (Outcome written = writeReports(); !written.ok()) return written;
    return checkThresholds();
}

Outcome CaptureRun::renderFrames(JobControl& job) {
    JobPhase phase(job, "rendering");
    const int limit = options_.frameLimit();
    for (int index = 0; index < limit; ++index) {
        if (Outcome done = renderFrame(); !done.ok()) return done;
        if (job.cancelled())
            return failed(fmt::format("interrupted after {} of {} frames; '{}' was not written",
                                      index + 1, limit, options_.outputOfFrame(index)));
        const bool last =
            index + 1 == limit || (options_.converge && recorder_->result().converged);
        if (options_.writesSequence() || last)
            if (Outcome written = writeFrame(index); !written.ok()) return written;
        if (last) break;
        phase.update(double(index + 1) / limit);
    }
    const FrameResult& result = recorder_->result();
    if (options_.converge && !result.converged && options_.frames == 0)
        log::warning(fmt::format(
            "not converged after {} frames: the error of the average is estimated at relmse {:.2g}",
            limit, result.estimatedError));
    return {};
}

Outcome CaptureRun::renderFrame() {
    const bool first = recorder_->count() == 0;
    if (const Result<void> done = recorder_->renderNext(); !done.ok())
        return failed(done.message()); // the command line and the scene were checked before
    if (!first) return {};
    log::info(recorder_->result().plan.why);
    for (const std::string& note : session_->renderer().notes()) log::info("note: " + note);
    return {};
}

Outcome CaptureRun::writeFrame(int index) {
    const CpuZone zone(&profiler_, "output.write");
    const std::string path = options_.outputOfFrame(index);
    Image beauty = recorder_->beauty();
    warnOfInvalid(beauty);
    Outcome written;
    if (options_.wantsExr())
        written = writeExrFrame(path, std::move(beauty));
    else
        written = outcomeOf(
            writePng(path, beauty.width, beauty.height, 3, session_->renderer().readDisplay()),
            ExitStatus::Failed);
    if (written.ok()) log::info("wrote " + path);
    return written;
}

/// A picture that is not finite says so once, with who made it so.
void CaptureRun::warnOfInvalid(const Image& beauty) {
    const uint64_t values = countValues(beauty).nonFinite;
    if (values == 0) return;
    std::string who;
    for (const InvalidTerms& invalid : session_->renderer().readInvalidTerms())
        who += fmt::format(
            "{} {} of {} from frame {} on", who.empty() ? ":" : ",", termNames(invalid.terms),
            invalid.owner == kDirectPasses
                ? "the direct passes"
                : "'" + session_->renderer().techniques()[size_t(invalid.owner)].name + "'",
            invalid.firstFrame);
    if (who.empty()) who = ", though all terms are: an effect on the finished picture made them so";
    log::warningOnce("capture.nonfinite",
                     fmt::format("{} values of the picture are not finite{}", values, who));
}

Outcome CaptureRun::writeExrFrame(const std::string& path, Image beauty) {
    std::vector<ImageLayer> layers;
    layers.push_back({"", std::move(beauty)});
    for (const std::string& aov : options_.aovs) {
        if (aov == "terms") {
            for (TermImage& term : recorder_->terms())
                layers.push_back({term.name, std::move(term.image)});
            continue;
        }
        Result<Image> image = session_->renderer().readAov(aov);
        if (!image.ok()) return wrongInput("--aov: " + image.message());
        layers.push_back({aov, std::move(*image)});
    }
    return outcomeOf(
        writeExr(path, layers, metadata(), options_.half ? ExrDepth::Half : ExrDepth::Float),
        ExitStatus::Failed);
}

/// What a .png of the same frame would be exposed at.
double CaptureRun::displayedEv100() const {
    const Result<std::string> compensation =
        session_->renderer().settings().get("post.exposureCompensation");
    return double(session_->scene().ev100) - std::stod(compensation.value());
}

ImageMetadata CaptureRun::metadata() const {
    std::string settings;
    for (const std::string& assignment : session_->renderer().settings().differences())
        settings += (settings.empty() ? "" : " ") + assignment;
    const FramePlan& plan = recorder_->result().plan;
    return {{"tyndall.scene", options_.render.scene},
            {"tyndall.size", options_.render.size},
            {"tyndall.version", programVersion()},
            {"tyndall.time", fmt::format("{}", options_.render.time)},
            {"tyndall.seed", std::to_string(options_.render.seed)},
            {"tyndall.settings", settings},
            {"tyndall.ev100", fmt::format("{:g}", displayedEv100())},
            {"tyndall.technique", plan.technique},
            {"tyndall.terms", termNames(plan.rendered)},
            {"tyndall.frames", std::to_string(recorder_->count())},
            {"tyndall.backend", std::string(session_->context().backendName())}};
}

Outcome CaptureRun::writeReports() {
    report_.peakResidentBytes = peakResidentBytes();
    if (!options_.report.empty())
        if (Result<void> written = writeFileAtomically(options_.report, report_.toJson());
            !written.ok())
            return failed(written.message());
    if (options_.trace.empty()) return {};
    Trace trace;
    trace.addProfile(profiler_);
    report_.addPassesTo(trace);
    return outcomeOf(writeFileAtomically(options_.trace, trace.toJson()), ExitStatus::Failed);
}

Outcome CaptureRun::checkThresholds() const {
    if (options_.failOnNonFinite && report_.nonFinite > 0)
        return failed(fmt::format("--fail-on-nonfinite: {} values of the picture are not finite",
                                  report_.nonFinite));
    if (options_.maxMs > 0 && report_.medianMs() > options_.maxMs)
        return failed(fmt::format("--max-ms {}: the median frame took {:.1f} ms", options_.maxMs,
                                  report_.medianMs()));
    return {};
}

} // namespace tyndall
