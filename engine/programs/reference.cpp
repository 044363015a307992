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
#include "programs/output_file.h"
#include "programs/render_options.h"
#include "reference/checkpoint.h"
#include "reference/render.h"

namespace tyndall {
namespace fs = std::filesystem;
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  tyndall reference smoke.scene.json -o truth.exr --size 320x180 --spp 1024\n"
    "  tyndall reference smoke.scene.json -o truth.exr --target-error 1e-4 --time 3600\n"
    "      whichever is reached first\n"
    "  tyndall reference smoke.scene.json -o truth.exr --spp 4096 --resume\n"
    "      goes on where a run that was stopped or killed left off: give the other options as before\n"
    "  tyndall reference smoke.scene.json -o direct.exr --terms LE,LSE,LVE\n"
    "\nThe EXR holds the picture (R G B), each transport term and the variance of the mean. While it works, the picture so\n"
    "far is in OUT.exr and all that is needed to go on in OUT.exr.resume, both at most half a minute old.";

struct ReferenceOptions {
    std::string scene, output, size = "1280x720", terms = "all", camera, integrator = "volume",
                               transmittance = "ratio", report;
    int64_t spp = 0;
    double seconds = 0, targetError = 0, checkpointSeconds = 30;
    int maxDepth = 0, threads = 0;
    uint64_t seed = 0;
    bool resume = false, half = false, keep = false;
};

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
    Outcome checkOptions();
    Outcome startOrResume();
    Outcome render();
    [[nodiscard]] uint32_t nextPass() const;
    [[nodiscard]] double done() const;
    Outcome checkpoint();
    Outcome writePicture();
    Outcome writeReport() const;
    [[nodiscard]] std::string identity() const;
    [[nodiscard]] fs::path resumePath() const { return options_.output + ".resume"; }

    const ReferenceOptions& options_;
    ProgressStyle style_;
    reference::RenderSettings settings_;
    Scene scene_;
    int camera_ = kNone;
    std::unique_ptr<reference::ReferenceRender> render_;
    double setupSeconds_ = 0, begun_ = 0, rendering_ = 0, error_ = INFINITY;
    uint32_t samplesBefore_ = 0;
};

Outcome ReferenceRun::checkOptions() {
    if (!options_.output.ends_with(".exr"))
        return wrongInput(fmt::format(
            "-o {}: the reference writes layers, so its name must end in .exr", options_.output));
    if (Result<void> folder = checkOutputFolder("-o", options_.output); !folder.ok())
        return wrongInput(folder.error().message);
    if (Result<void> size = parseSize(options_.size, settings_.width, settings_.height); !size.ok())
        return wrongInput(size.error().message);
    Result<TermSet> terms = parseTerms(options_.terms);
    if (!terms.ok()) return wrongInput("--terms: " + terms.message());
    settings_.path.terms = *terms;
    if (options_.spp < 0 || options_.spp > (int64_t(1) << 31))
        return wrongInput(
            fmt::format("--spp {}: it takes 1 to 2147483648 samples a pixel", options_.spp));
    const auto negative = [](const char* name, double value) {
        return wrongInput(fmt::format("{} {}: it must be a finite number above 0", name, value));
    };
    if (!(options_.seconds >= 0) || std::isinf(options_.seconds))
        return negative("--time", options_.seconds);
    if (!(options_.targetError >= 0) || std::isinf(options_.targetError))
        return negative("--target-error", options_.targetError);
    if (!(options_.checkpointSeconds >= 0))
        return negative("--checkpoint", options_.checkpointSeconds);
    if (options_.maxDepth < 0)
        return wrongInput(
            fmt::format("--max-depth {}: 0 is unlimited, 1 direct light alone", options_.maxDepth));
    if (options_.threads < 0 || options_.threads > 1024)
        return wrongInput(
            fmt::format("--threads {}: 0 is all cores, and no more than 1024", options_.threads));
    settings_.path.maxScatterings = options_.maxDepth == 0 ? -1 : options_.maxDepth;
    if (options_.integrator != "volume" && options_.integrator != "simple")
        return wrongInput(
            fmt::format("--integrator {}: there are volume and simple", options_.integrator));
    settings_.integrator = options_.integrator == "simple" ? reference::Integrator::Simple
                                                           : reference::Integrator::Volume;
    if (options_.transmittance != "exact" && options_.transmittance != "ratio")
        return wrongInput(
            fmt::format("--transmittance {}: there are exact and ratio", options_.transmittance));
    settings_.path.transmittance = options_.transmittance == "ratio"
                                       ? reference::TransmittanceMode::Ratio
                                       : reference::TransmittanceMode::Exact;
    settings_.seed = options_.seed;
    settings_.threads = options_.threads;
    return {};
}

/// Everything that a sample depends on.
std::string ReferenceRun::identity() const {
    return fmt::format("scene {:016x} seed {} depth {} integrator {} transmittance {} version {}",
                       reference::sceneHash(scene_, camera_), settings_.seed, options_.maxDepth,
                       options_.integrator, options_.transmittance, TYNDALL_VERSION);
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
        const fs::path probe = options_.output + ".probe";
        if (Result<void> written = writeFileAtomically(probe, ""); !written.ok())
            return failed(fmt::format("-o {}: {}", options_.output, written.error().message));
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
    const uint32_t fewest = 2 * reference::kStreams;
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
    layers.push_back({"variance", film.variance()});
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
    return outcomeOf(writeExr(options_.output, layers, metadata,
                              options_.half ? ExrDepth::Half : ExrDepth::Float),
                     ExitStatus::Failed);
}

Outcome ReferenceRun::writeReport() const {
    if (options_.report.empty()) return {};
    const reference::PathCounts& counts = render_->counts();
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
    if (Outcome checked = checkOptions(); !checked.ok()) return checked;
    if (Outcome loaded = loadSceneForCommand(options_.scene, style_, scene_); !loaded.ok())
        return loaded;
    Result<int> camera = findCamera(scene_, options_.camera);
    if (!camera.ok()) return wrongInput(camera.message());
    camera_ = *camera;
    if (Outcome started = startOrResume(); !started.ok()) return started;
    if (Outcome rendered = render(); !rendered.ok()) return rendered;
    if (options_.keep)
        if (Outcome kept = checkpoint(); !kept.ok()) return kept;
    if (Outcome written = writePicture(); !written.ok()) return written;
    std::error_code error;
    if (!options_.keep) fs::remove(resumePath(), error);
    const reference::PathCounts& counts = render_->counts();
    log::info(fmt::format("wrote {}: {} samples a pixel in {}, estimated relmse {:.2g}",
                          options_.output, render_->film().samples(), durationText(rendering_),
                          error_));
    if (counts.nonFinite > 0)
        log::warning(
            fmt::format("{} contributions were not finite and were left out", counts.nonFinite));
    if (counts.negative > 0)
        log::warning(fmt::format("{} contributions were negative", counts.negative));
    if (counts.cutOff > 0)
        log::warning(
            fmt::format("{} paths were cut off after {} scatterings: their light is missing",
                        counts.cutOff, reference::PathSettings::kLongest));
    return writeReport();
}

} // namespace

void addReferenceCommand(CLI::App& program, Run& run) {
    auto options = std::make_shared<ReferenceOptions>();
    CLI::App* command = program.add_subcommand(
        "reference", "Trace a scene's paths: the picture to measure others by");
    command->add_option("SCENE", options->scene, "A scene file, or a .gltf, .glb, .vdb or .nvdb")
        ->required();
    command->add_option("-o,--output", options->output, "The EXR to write")
        ->type_name("OUT.exr")
        ->required();
    command->add_option("--size", options->size, "Width and height in pixels (1280x720)")
        ->type_name("WxH");
    command->add_option("--spp", options->spp, "Samples a pixel (64, where no other goal is given)")
        ->type_name("N");
    command->add_option("--time", options->seconds, "Render for so long")->type_name("SECONDS");
    command
        ->add_option("--target-error", options->targetError,
                     "Render until the estimated relmse is no more")
        ->type_name("RELMSE");
    command
        ->add_option("--terms", options->terms,
                     "Transport terms, comma-separated: LE,LSE,LVE ... (all)")
        ->type_name("LIST");
    command
        ->add_option("--max-depth", options->maxDepth,
                     "Most scatterings of a path; 0: unlimited (0)")
        ->type_name("N");
    command->add_option("--camera", options->camera, "The camera, by node name (the scene's own)")
        ->type_name("NAME");
    command->add_option("--seed", options->seed, "Seed of everything random (0)")->type_name("N");
    command->add_option("--threads", options->threads, "Threads; 0: one a core (0)")
        ->type_name("N");
    command->add_flag("--resume", options->resume,
                      "Go on where the last run of this picture stopped");
    command->add_flag("--keep-checkpoint", options->keep,
                      "Leave OUT.exr.resume when done, for more samples later");
    command->add_option("--checkpoint", options->checkpointSeconds, "Save at least this often (30)")
        ->type_name("SECONDS");
    command
        ->add_option(
            "--integrator", options->integrator,
            "volume, or simple: slow, short, without aiming at lights; lights without extent stay dark")
        ->type_name("NAME");
    command
        ->add_option("--transmittance", options->transmittance,
                     "Of grids: ratio, unbiased estimates, or exact, slower (ratio)")
        ->type_name("NAME");
    command->add_flag("--half", options->half, "Write 16-bit floats");
    command->add_option("--report", options->report, "Write what it took as JSON")
        ->type_name("FILE");
    command->footer(kExamples);
    command->callback([options, &run] {
        run = [options](const GlobalOptions& global) {
            if (options->spp == 0 && options->seconds == 0 && options->targetError == 0)
                options->spp = 64;
            return ReferenceRun(*options, global.progress()).run();
        };
    });
}

} // namespace tyndall
