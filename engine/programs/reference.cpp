// `tyndall reference`: the picture as it ought to be, from the CPU path tracer, with how far it may still be off.

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/cpu_profiler.h"
#include "core/log.h"
#include "programs/commands.h"
#include "programs/interrupt.h"
#include "programs/load_scene.h"
#include "programs/reference_options.h"
#include "reference/checkpoint.h"
#include "reference/picture_cache.h"
#include "reference/render.h"

namespace tyndall {
namespace fs = std::filesystem;
namespace {

double now() {
    using Clock = std::chrono::steady_clock;
    return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

class ReferenceRun {
public:
    ReferenceRun(const ReferenceOptions& options, ProgressStyle style)
        : options_(options), style_(style) {}
    Outcome run();

private:
    Outcome takeFromCache(bool& taken);
    Outcome startOrResume();
    Outcome render();
    [[nodiscard]] uint32_t nextPass() const;
    [[nodiscard]] double done() const;
    Outcome checkpoint();
    Outcome writePicture();
    Outcome writeReport() const;
    [[nodiscard]] std::string identity() const;
    Outcome copyOut() const;
    [[nodiscard]] fs::path resumePath() const { return output_ + ".resume"; }

    const ReferenceOptions& options_;
    ProgressStyle style_;
    reference::RenderSettings settings_;
    Scene scene_;
    int camera_ = kNone;
    std::unique_ptr<reference::ReferenceRender> render_;
    double setupSeconds_ = 0, begun_ = 0, rendering_ = 0, error_ = INFINITY;
    uint32_t samplesBefore_ = 0;
    std::string output_, copyTo_;
};

/// With --cache: the picture goes into the folder under its own name. One that is there and good enough is taken as it is.
Outcome ReferenceRun::takeFromCache(bool& taken) {
    taken = false;
    if (options_.cache.empty()) return {};
    std::error_code error;
    fs::create_directories(options_.cache, error);
    const std::string name = reference::pictureName(scene_, options_.scene, camera_, settings_);
    copyTo_ = options_.output;
    output_ = (fs::path(options_.cache) / name).string();
    const auto kept = reference::findPicture(options_.cache, name);
    if (!kept) return {};
    const bool enough = (options_.spp > 0 && kept->samples >= uint64_t(options_.spp)) ||
                        (options_.targetError > 0 && kept->estimatedRelmse <= options_.targetError);
    if (!enough) return {};
    taken = true;
    log::info(fmt::format("{} is there already: {} samples a pixel, estimated relmse {:.2g}",
                          output_, kept->samples, kept->estimatedRelmse));
    return copyOut();
}

/// What becomes of a picture in the cache: its name goes to standard output, for scripts, and it itself to -o.
Outcome ReferenceRun::copyOut() const {
    if (options_.cache.empty()) return {};
    std::printf("%s\n", output_.c_str());
    if (copyTo_.empty()) return {};
    const Result<std::string> content = readFile(output_);
    if (!content.ok()) return failed(content.message());
    return outcomeOf(writeFileAtomically(copyTo_, *content), ExitStatus::Failed);
}

/// Everything that a sample depends on.
std::string ReferenceRun::identity() const {
    return fmt::format(
        "scene {:016x} seed {} depth {} integrator {} clamp {} transmittance {} version {}-{}",
        reference::sceneHash(scene_, camera_), settings_.seed, options_.maxDepth,
        options_.integrator, options_.clamp, options_.transmittance, TYNDALL_VERSION,
        reference::kReferenceVersion);
}

Outcome ReferenceRun::startOrResume() {
    const double begun = now();
    auto started = reference::ReferenceRender::start(scene_, camera_, settings_);
    if (!started.ok()) return failed(started.message());
    render_ = std::make_unique<reference::ReferenceRender>(std::move(*started));
    for (const std::string& note : render_->notes()) log::info("note: " + note);
    setupSeconds_ = now() - begun;
    std::error_code error;
    if (!options_.resume) {
        // Better now than after an hour: can files be written there?
        const fs::path probe = output_ + ".probe";
        if (Result<void> written = writeFileAtomically(probe, ""); !written.ok())
            return failed(fmt::format("-o {}: {}", output_, written.error().message));
        fs::remove(probe, error);
        return {};
    }
    if (!fs::exists(resumePath(), error)) {
        log::info(fmt::format("there is no {} to go on from: starting at the beginning",
                              resumePath().string()));
        return {};
    }
    if (Result<void> read = reference::readCheckpoint(resumePath(), identity(), render_->film());
        !read.ok())
        return wrongInput("--resume: " + read.error().message);
    samplesBefore_ = render_->film().samples();
    log::info(fmt::format("going on after {} samples a pixel", samplesBefore_));
    return {};
}

/// 0 to 1 and more: how far towards the nearest of the goals.
double ReferenceRun::done() const {
    double fraction = 0;
    if (options_.spp > 0)
        fraction = std::max(fraction, double(render_->film().samples()) / double(options_.spp));
    if (options_.seconds > 0) fraction = std::max(fraction, rendering_ / options_.seconds);
    if (options_.targetError > 0 && error_ > 0)
        fraction = std::max(fraction, options_.targetError / error_);
    if (options_.targetError > 0 && error_ == 0)
        fraction = 1; // a black picture, or one without noise
    return fraction;
}

/// Samples of the next pass: about two seconds' worth, never past the goals. How they are divided changes no sample.
uint32_t ReferenceRun::nextPass() const {
    constexpr double kPassSeconds = 2;
    const uint32_t have = render_->film().samples(), taken = have - samplesBefore_;
    double samples = taken == 0 ? 1 : kPassSeconds * taken / std::max(rendering_, 1e-3);
    samples =
        std::min(samples, 4.0 * std::max(1u, taken)); // the first passes say little of the speed
    if (options_.spp > 0) samples = std::min(samples, double(options_.spp) - have);
    if (options_.seconds > 0 && taken > 0)
        samples =
            std::min(samples, (options_.seconds - rendering_) * taken / std::max(rendering_, 1e-3));
    return uint32_t(std::max(1.0, samples));
}

Outcome ReferenceRun::render() {
    Progress progress("rendering", style_);
    begun_ = now();
    double saved = begun_;
    const bool withoutGoal =
        options_.spp == 0 && options_.seconds == 0 && options_.targetError == 0;
    CHECK(!withoutGoal);
    // An error can be told once every stream has a sample or two.
    const uint32_t fewest = 2 * tracing::kStreams;
    const auto goalReached = [&] {
        const uint32_t have = render_->film().samples();
        if (have == 0) return false;
        if (options_.spp > 0 && have >= uint64_t(options_.spp)) return true;
        if (options_.seconds > 0 && rendering_ >= options_.seconds) return true;
        return options_.targetError > 0 && have >= fewest && error_ <= options_.targetError;
    };
    if (render_->film().samples() > 0) error_ = render_->film().estimatedRelmse();
    while (!goalReached()) {
        if (!render_->addSamples(nextPass(), [] { return interrupted(); }))
            return failed(fmt::format("interrupted; {}",
                                      fs::exists(resumePath())
                                          ? "'--resume' goes on from " + resumePath().string()
                                          : "nothing was written"));
        rendering_ = now() - begun_;
        error_ = render_->film().estimatedRelmse();
        progress.update(std::min(1.0, done()),
                        fmt::format("rendering: {} samples a pixel, relmse {:.2g}",
                                    render_->film().samples(), error_));
        if (now() - saved < options_.checkpointSeconds || goalReached()) continue;
        if (Outcome written = checkpoint(); !written.ok()) return written;
        saved = now();
    }
    return {};
}

Outcome ReferenceRun::checkpoint() {
    if (Result<void> written =
            reference::writeCheckpoint(resumePath(), identity(), render_->film());
        !written.ok())
        return failed(written.error().message);
    return writePicture();
}

Outcome ReferenceRun::writePicture() {
    const reference::Film& film = render_->film();
    std::vector<ImageLayer> layers;
    layers.push_back({"", film.beauty()});
    for (uint32_t i = 0; i < kTermCount; ++i)
        if (film.terms() & bit(Term(i)))
            layers.push_back({std::string(termName(Term(i))), film.term(Term(i))});
    layers.push_back({"variance", film.variance(), true});
    const ImageMetadata metadata = {{"tyndall.scene", options_.scene},
                                    {"tyndall.size", options_.size},
                                    {"tyndall.version", TYNDALL_VERSION},
                                    {"tyndall.seed", std::to_string(settings_.seed)},
                                    {"tyndall.samples", std::to_string(film.samples())},
                                    {"tyndall.terms", termNames(film.terms())},
                                    {"tyndall.maxDepth", std::to_string(options_.maxDepth)},
                                    {"tyndall.integrator", options_.integrator},
                                    {"tyndall.ev100", fmt::format("{}", scene_.ev100)},
                                    {"tyndall.identity", identity()},
                                    {"tyndall.estimatedRelmse", fmt::format("{:.6g}", error_)}};
    return outcomeOf(
        writeExr(output_, layers, metadata, options_.half ? ExrDepth::Half : ExrDepth::Float),
        ExitStatus::Failed);
}

Outcome ReferenceRun::writeReport() const {
    if (options_.report.empty()) return {};
    const tracing::PathCounts& counts = render_->counts();
    const uint64_t pixels = uint64_t(settings_.width) * uint64_t(settings_.height);
    const uint64_t taken = uint64_t(render_->film().samples() - samplesBefore_) * pixels;
    const nlohmann::ordered_json report = {
        {"scene", options_.scene},
        {"size", {settings_.width, settings_.height}},
        {"samples_per_pixel", render_->film().samples()},
        {"setup_seconds", setupSeconds_},
        {"render_seconds", rendering_},
        {"samples_per_second", rendering_ > 0 ? double(taken) / rendering_ : 0},
        {"estimated_relmse", error_},
        {"triangles", render_->scene().surfaces->triangleCount()},
        {"peak_rss_bytes", peakResidentBytes()},
        {"counters",
         {{"paths", counts.paths},
          {"segments", counts.segments},
          {"shadow_rays", counts.shadowRays},
          {"cut_off", counts.cutOff},
          {"nonfinite", counts.nonFinite},
          {"negative", counts.negative}}}};
    return outcomeOf(writeFileAtomically(options_.report, report.dump(2) + "\n"),
                     ExitStatus::Failed);
}

Outcome ReferenceRun::run() {
    if (Result<void> checked = checkReferenceOptions(options_, settings_); !checked.ok())
        return wrongInput(checked.error().message);
    if (Outcome loaded = loadSceneForCommand(options_.scene, style_, scene_); !loaded.ok())
        return loaded;
    Result<int> camera = findCamera(scene_, options_.camera);
    if (!camera.ok()) return wrongInput(camera.message());
    camera_ = *camera;
    output_ = options_.output;
    bool taken = false;
    if (Outcome looked = takeFromCache(taken); !looked.ok() || taken) return looked;
    if (Outcome started = startOrResume(); !started.ok()) return started;
    if (Outcome rendered = render(); !rendered.ok()) return rendered;
    if (options_.keep)
        if (Outcome kept = checkpoint(); !kept.ok()) return kept;
    if (Outcome written = writePicture(); !written.ok()) return written;
    std::error_code error;
    if (!options_.keep) fs::remove(resumePath(), error);
    const tracing::PathCounts& counts = render_->counts();
    log::info(fmt::format("wrote {}: {} samples a pixel in {}, estimated relmse {:.2g}", output_,
                          render_->film().samples(), durationText(rendering_), error_));
    if (counts.nonFinite > 0)
        log::warning(
            fmt::format("{} contributions were not finite and were left out", counts.nonFinite));
    if (counts.negative > 0)
        log::warning(fmt::format("{} contributions were negative", counts.negative));
    if (counts.cutOff > 0)
        log::warning(
            fmt::format("{} paths were cut off after {} scatterings: their light is missing",
                        counts.cutOff, reference::PathSettings::kLongest));
    if (Outcome copied = copyOut(); !copied.ok()) return copied;
    return writeReport();
}

} // namespace

void addReferenceCommand(CLI::App& program, Run& run) {
    auto options = std::make_shared<ReferenceOptions>();
    CLI::App* command = program.add_subcommand(
        "reference", "Trace a scene's paths: the picture to measure others by");
    addReferenceOptions(*command, *options);
    command->callback([options, &run] {
        run = [options](const GlobalOptions& global) {
            if (options->spp == 0 && options->seconds == 0 && options->targetError == 0)
                options->spp = 64;
            return ReferenceRun(*options, global.progress()).run();
        };
    });
}

} // namespace tyndall
