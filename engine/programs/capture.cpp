// `tyndall capture`: the real-time renderer, headless.

#include <cstdio>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/image_metrics.h"
#include "core/log.h"
#include "programs/capture_options.h"
#include "programs/capture_report.h"
#include "programs/commands.h"
#include "programs/interrupt.h"
#include "programs/render_session.h"

namespace tyndall {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  tyndall capture room.gltf -o room.png\n"
    "      a camera and a light are supplied where the file has none\n"
    "  tyndall capture smoke.scene.json -o smoke.exr --size 1920x1080 --aov depth,transmittance,terms\n"
    "  tyndall capture smoke.scene.json -o 'frame-%04d.png' --frames 48 --time-step 0.04\n"
    "  tyndall capture smoke.scene.json -o still.exr --converge --frames 1024 --report still.json\n"
    "  tyndall capture smoke.scene.json -o fast.png --quality low --set media.octaves.count=3 --max-ms 33\n"
    "\nExit status: 0 done; 1 it failed or a threshold was not met; 2 the command line or a file is wrong.";

/// One run of the command: renders, writes, and keeps what the report needs.
class Capture {
public:
    Capture(const CaptureOptions& options, ProgressStyle progress)
        : options_(options), progressStyle_(progress) {}
    Outcome run();

private:
    Outcome renderFrames();
    Outcome renderFrame(int index);
    Outcome writeFrame(int index);
    Outcome writeExrFrame(const std::string& path, Image beauty);
    [[nodiscard]] double displayedEv100() const;
    [[nodiscard]] ImageMetadata metadata() const;
    void count(const Image& image);
    void describe();
    Outcome writeReports();
    [[nodiscard]] Outcome checkThresholds() const;

    const CaptureOptions& options_;
    ProgressStyle progressStyle_;
    CpuProfiler profiler_;
    std::unique_ptr<RenderSession> session_;
    FrameResult result_; // of the last frame
    CaptureReport report_;
};

Outcome Capture::run() {
    if (Outcome opened = RenderSession::open(options_.render, progressStyle_, &profiler_, session_);
        !opened.ok())
        return opened;
    if (Outcome rendered = renderFrames(); !rendered.ok()) return rendered;
    describe();
    report_.glObjectsLeaked = session_->closeRendererAndCountLeaks();
    report_.glErrors = session_->context().debugLog().count(gl::Severity::High);
    if (Outcome written = writeReports(); !written.ok()) return written;
    return checkThresholds();
}

Outcome Capture::renderFrames() {
    Progress progress("rendering", progressStyle_);
    const int limit = options_.frameLimit();
    for (int index = 0; index < limit; ++index) {
        if (Outcome done = renderFrame(index); !done.ok()) return done;
        if (interrupted())
            return failed(fmt::format("interrupted after {} of {} frames; '{}' was not written",
                                      index + 1, limit, options_.output));
        const bool last = index + 1 == limit || (options_.converge && result_.converged);
        if (options_.writesSequence() || last)
            if (Outcome written = writeFrame(index); !written.ok()) return written;
        if (last) break;
        progress.update(double(index + 1) / limit);
    }
    if (options_.converge && !result_.converged && options_.frames == 0)
        log::warning(fmt::format(
            "not converged after {} frames: the error of the average is estimated at relmse {:.2g}",
            limit, result_.estimatedError));
    return {};
}

Outcome Capture::renderFrame(int index) {
    FrameRequest request = session_->request();
    request.frameIndex = uint32_t(index);
    request.converge = options_.converge;
    request.separateTerms = options_.hasAov("terms");
    request.statistics = !options_.report.empty();
    if (!options_.converge)
        request.time += index * options_.timeStep; // a scene that converges stands still
    CaptureReport::Frame& frame = report_.frames.emplace_back();
    frame.startMicroseconds = processMicroseconds();
    Result<FrameResult> result = session_->renderer().renderFrame(request);
    if (!result.ok())
        return failed(result.message()); // the command line and the scene were checked before
    gl::Fence::insert().wait();
    frame.durationMicroseconds = processMicroseconds() - frame.startMicroseconds;
    result_ = std::move(*result);
    if (index == 0) {
        report_.startupMs = processMicroseconds() / 1000;
        log::info(result_.plan.why);
        for (const std::string& note : session_->renderer().notes()) log::info("note: " + note);
    }
    return {};
}

Outcome Capture::writeFrame(int index) {
    const CpuZone zone(&profiler_, "output.write");
    const std::string path = options_.outputOfFrame(index);
    Renderer& renderer = session_->renderer();
    Image beauty = renderer.readBeauty();
    count(beauty);
    Outcome written;
    if (options_.wantsExr())
        written = writeExrFrame(path, std::move(beauty));
    else
        written = outcomeOf(writePng(path, beauty.width, beauty.height, 3, renderer.readDisplay()),
                            ExitStatus::Failed);
    if (written.ok()) log::info("wrote " + path);
    return written;
}

Outcome Capture::writeExrFrame(const std::string& path, Image beauty) {
    Renderer& renderer = session_->renderer();
    std::vector<ImageLayer> layers;
    layers.push_back({"", std::move(beauty)});
    for (const std::string& aov : options_.aovs) {
        if (aov == "terms") {
            for (TermImage& term : renderer.readTerms()) {
                count(term.image);
                layers.push_back({term.name, std::move(term.image)});
            }
            continue;
        }
        Result<Image> image = renderer.readAov(aov);
        if (!image.ok()) return wrongInput("--aov: " + image.message());
        layers.push_back({aov, std::move(*image)});
    }
    return outcomeOf(
        writeExr(path, layers, metadata(), options_.half ? ExrDepth::Half : ExrDepth::Float),
        ExitStatus::Failed);
}

/// What a .png of the same frame would be exposed at.
double Capture::displayedEv100() const {
    const Result<std::string> compensation =
        session_->renderer().settings().get("post.exposureCompensation");
    return double(session_->ev100()) - std::stod(compensation.value());
}

ImageMetadata Capture::metadata() const {
    std::string settings;
    for (const std::string& assignment : session_->renderer().settings().differences())
        settings += (settings.empty() ? "" : " ") + assignment;
    return {{"tyndall.scene", options_.render.scene},
            {"tyndall.size", options_.render.size},
            {"tyndall.version", TYNDALL_VERSION},
            {"tyndall.seed", std::to_string(options_.render.seed)},
            {"tyndall.settings", settings},
            {"tyndall.ev100", fmt::format("{:g}", displayedEv100())},
            {"tyndall.technique", result_.plan.technique},
            {"tyndall.terms", termNames(result_.plan.rendered)},
            {"tyndall.frames", std::to_string(report_.frames.size())},
            {"tyndall.backend", std::string(session_->context().backendName())}};
}

void Capture::count(const Image& image) {
    const ValueCounts counts = countValues(image);
    report_.nonFinite += counts.nonFinite;
    report_.negative += counts.negative;
}

void Capture::describe() {
    const gl::Capabilities& capabilities = session_->context().capabilities();
    report_.scene = options_.render.scene;
    report_.width = session_->request().width;
    report_.height = session_->request().height;
    report_.backend = session_->context().backendName();
    report_.glVendor = capabilities.vendor;
    report_.glRenderer = capabilities.renderer;
    report_.glVersion = capabilities.version;
    report_.setPlan(result_.plan);
    session_->renderer().waitForTimings();
    report_.setPasses(session_->renderer().report());
    report_.setStatistics(session_->renderer().readStatistics());
    if (options_.converge) {
        report_.iterations["converge"] = result_.accumulatedFrames;
        report_.residuals["converge"] = result_.estimatedError;
    }
}

Outcome Capture::writeReports() {
    report_.peakResidentBytes = peakResidentBytes();
    if (!options_.report.empty())
        if (Result<void> written = writeFileAtomically(options_.report, report_.toJson());
            !written.ok())
            return failed(written.message());
    if (!options_.trace.empty()) {
        Trace trace;
        trace.addProfile(profiler_);
        report_.addPassesTo(trace);
        if (Result<void> written = writeFileAtomically(options_.trace, trace.toJson());
            !written.ok())
            return failed(written.message());
    }
    return {};
}

Outcome Capture::checkThresholds() const {
    if (options_.failOnNonFinite && report_.nonFinite > 0)
        return failed(fmt::format("--fail-on-nonfinite: {} values of the picture are not finite",
                                  report_.nonFinite));
    if (options_.maxMs > 0 && report_.medianMs() > options_.maxMs)
        return failed(fmt::format("--max-ms {}: the median frame took {:.1f} ms", options_.maxMs,
                                  report_.medianMs()));
    return {};
}

} // namespace

void addCaptureCommand(CLI::App& program, Run& run) {
    auto options = std::make_shared<CaptureOptions>();
    CLI::App* command = program.add_subcommand("capture", "Render a scene to a picture");
    addCaptureOptions(*command, *options);
    command->footer(kExamples);
    command->callback([options, &run] {
        run = [options](const GlobalOptions& global) {
            if (const Result<void> checked = checkCaptureOptions(*options); !checked.ok())
                return wrongInput(checked.message());
            return Capture(*options, global.progress()).run();
        };
    });
}

} // namespace tyndall
