#include "app/reference_run.h"

#include <chrono>
#include <unistd.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/load_scene.h"
#include "app/program.h"
#include "core/cpu_profiler.h"
#include "core/log.h"
#include "core/progress.h"
#include "reference/checkpoint.h"
#include "reference/picture_cache.h"

namespace tyndall {
namespace fs = std::filesystem;

std::string ReferenceReport::toJson() const {
    const nlohmann::ordered_json json = {{"scene", scene},
                                         {"size", {width, height}},
                                         {"samples_per_pixel", samples},
                                         {"setup_seconds", setupSeconds},
                                         {"render_seconds", renderSeconds},
                                         {"samples_per_second", samplesPerSecond},
                                         {"estimated_relmse", estimatedRelmse},
                                         {"triangles", triangles},
                                         {"peak_rss_bytes", peakResidentBytes},
                                         {"counters",
                                          {{"paths", counts.paths},
                                           {"segments", counts.segments},
                                           {"shadow_rays", counts.shadowRays},
                                           {"cut_off", counts.cutOff},
                                           {"nonfinite", counts.nonFinite},
                                           {"negative", counts.negative}}}};
    return json.dump(2) + "\n";
}

Outcome ReferenceRun::run(JobControl& job) {
    if (Outcome loaded = loadAndCheck(job); !loaded.ok()) return loaded;
    bool taken = false;
    if (Outcome looked = takeFromCache(taken); !looked.ok() || taken) return looked;
    if (Outcome started = startOrResume(); !started.ok()) return started;
    if (Outcome rendered = render(job); !rendered.ok()) return rendered;
    if (options_.keep)
        if (Outcome kept = checkpoint(); !kept.ok()) return kept;
    if (Outcome written = writePicture(); !written.ok()) return written;
    std::error_code error;
    if (!options_.keep) fs::remove(resumePath(), error);
    sayWhatBecame();
    if (Outcome copied = copyOut(); !copied.ok()) return copied;
    return writeReport();
}

Outcome ReferenceRun::loadAndCheck(JobControl& job) {
    if (Result<void> checked = understandReference(options_, settings_); !checked.ok())
        return wrongInput(checked.message());
    if (Outcome loaded = loadScene(options_, job, scene_); !loaded.ok()) return loaded;
    const Result<int> camera = findCamera(scene_, options_.camera);
    if (!camera.ok()) return wrongInput(camera.message());
    camera_ = *camera;
    output_ = options_.output;
    return {};
}

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
    const ReferenceGoals& goals = options_.goals;
    const bool enough = (goals.spp > 0 && kept->samples >= uint64_t(goals.spp)) ||
                        (goals.targetError > 0 && kept->estimatedRelmse <= goals.targetError);
    if (!enough) return {};
    taken = true;
    log::info(fmt::format("{} is there already: {} samples a pixel, estimated relmse {:.2g}",
                          output_, kept->samples, kept->estimatedRelmse));
    return copyOut();
}

/// A picture in the cache goes to -o as well.
Outcome ReferenceRun::copyOut() const {
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
        options_.integrator, options_.clamp, options_.transmittance, programVersion(),
        reference::kReferenceVersion);
}

Outcome ReferenceRun::startOrResume() {
    auto started = ReferenceTracer::start(scene_, camera_, settings_);
    if (!started.ok()) return failed(started.message());
    tracer_ = std::move(*started);
    for (const std::string& note : tracer_->render().notes()) log::info("note: " + note);
    if (!options_.resume) return probeOutput();
    std::error_code error;
    if (!fs::exists(resumePath(), error)) {
        log::info(fmt::format("there is no {} to go on from: starting at the beginning",
                              resumePath().string()));
        return {};
    }
    if (Result<void> read = reference::readCheckpoint(resumePath(), identity(), tracer_->film());
        !read.ok())
        return wrongInput("--resume: " + read.message());
    tracer_->resume();
    log::info(fmt::format("going on after {} samples a pixel", tracer_->film().samples()));
    return {};
}

/// Beside the picture. Where its name is so long that nothing fits behind it, a part of it and a hash of the whole.
fs::path ReferenceRun::resumePath() const {
    constexpr size_t kLongest = 255 - sizeof ".resume" + 1;
    const fs::path picture(output_);
    const std::string name = picture.filename().string();
    if (name.size() <= kLongest) return output_ + ".resume";
    return picture.parent_path() / fmt::format("{}-{:016x}.resume", name.substr(0, kLongest - 17),
                                               std::hash<std::string>()(name));
}

/// Better now than after an hour: can files be written there?
Outcome ReferenceRun::probeOutput() const {
    const fs::path probe =
        fs::path(output_).parent_path() / fmt::format(".tyndall-{}.probe", ::getpid());
    if (Result<void> written = writeFileAtomically(probe, ""); !written.ok())
        return failed(fmt::format("-o {}: {}", output_, written.message()));
    std::error_code error;
    fs::remove(probe, error);
    return {};
}

Outcome ReferenceRun::render(JobControl& job) {
    using Clock = std::chrono::steady_clock;
    Clock::time_point saved = Clock::now();
    const std::chrono::duration<double> interval(options_.checkpointSeconds);
    Outcome traced = tracer_->trace(options_.goals, job, [&]() -> Outcome {
        if (Clock::now() - saved < interval) return {};
        if (Outcome written = checkpoint(); !written.ok()) return written;
        saved = Clock::now();
        return {};
    });
    if (!traced.ok() && job.cancelled())
        return failed(
            fmt::format("interrupted; {}", fs::exists(resumePath())
                                               ? "'--resume' goes on from " + resumePath().string()
                                               : "nothing was written"));
    return traced;
}

Outcome ReferenceRun::checkpoint() {
    if (Result<void> written =
            reference::writeCheckpoint(resumePath(), identity(), tracer_->film());
        !written.ok())
        return failed(written.message());
    return writePicture();
}

Outcome ReferenceRun::writePicture() {
    const reference::Film& film = tracer_->film();
    std::vector<ImageLayer> layers;
    layers.push_back({"", film.beauty()});
    for (uint32_t i = 0; i < kTermCount; ++i)
        if (film.terms() & bit(Term(i)))
            layers.push_back({std::string(termName(Term(i))), film.term(Term(i))});
    layers.push_back({"variance", film.variance(), true});
    const ImageMetadata metadata = {
        {"tyndall.scene", options_.scene},
        {"tyndall.size", options_.size},
        {"tyndall.version", programVersion()},
        {"tyndall.time", fmt::format("{}", options_.time)},
        {"tyndall.seed", std::to_string(settings_.seed)},
        {"tyndall.samples", std::to_string(film.samples())},
        {"tyndall.terms", termNames(film.terms())},
        {"tyndall.maxDepth", std::to_string(options_.maxDepth)},
        {"tyndall.integrator", options_.integrator},
        {"tyndall.ev100", fmt::format("{}", scene_.ev100)},
        {"tyndall.identity", identity()},
        {"tyndall.estimatedRelmse", fmt::format("{:.6g}", tracer_->error())}};
    return outcomeOf(
        writeExr(output_, layers, metadata, options_.half ? ExrDepth::Half : ExrDepth::Float),
        ExitStatus::Failed);
}

void ReferenceRun::sayWhatBecame() const {
    const tracing::PathCounts& counts = tracer_->render().counts();
    log::info(fmt::format("wrote {}: {} samples a pixel in {}, estimated relmse {:.2g}", output_,
                          tracer_->film().samples(), durationText(tracer_->renderSeconds()),
                          tracer_->error()));
    if (counts.nonFinite > 0)
        log::warning(
            fmt::format("{} contributions were not finite and were left out", counts.nonFinite));
    if (counts.negative > 0)
        log::warning(fmt::format("{} contributions were negative", counts.negative));
    if (counts.cutOff > 0)
        log::warning(
            fmt::format("{} paths were cut off after {} scatterings: their light is missing",
                        counts.cutOff, reference::PathSettings::kLongest));
}

Outcome ReferenceRun::writeReport() {
    const uint64_t pixels = uint64_t(settings_.width) * uint64_t(settings_.height);
    const double taken = double(tracer_->samplesTaken() * pixels),
                 seconds = tracer_->renderSeconds();
    report_ = {options_.scene,
               settings_.width,
               settings_.height,
               tracer_->film().samples(),
               tracer_->setupSeconds(),
               seconds,
               seconds > 0 ? taken / seconds : 0,
               tracer_->error(),
               tracer_->render().scene().surfaces->triangleCount(),
               peakResidentBytes(),
               tracer_->render().counts()};
    if (options_.report.empty()) return {};
    return outcomeOf(writeFileAtomically(options_.report, report_.toJson()), ExitStatus::Failed);
}

} // namespace tyndall
