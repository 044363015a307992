#pragma once
// A reference picture as a job: traced, kept in a file with all its layers, gone on from where it was stopped, or taken from a folder.

#include <filesystem>
#include <memory>
#include <string>

#include "app/reference_options.h"
#include "scene/scene.h"

namespace tyndall {

/// What a run took.
struct ReferenceReport {
    std::string scene;
    int width = 0, height = 0;
    uint32_t samples = 0; // a pixel
    double setupSeconds = 0, renderSeconds = 0;
    double samplesPerSecond = 0; // of all pixels together
    double estimatedRelmse = 0;
    uint64_t triangles = 0, peakResidentBytes = 0;
    tracing::PathCounts counts;

    [[nodiscard]] std::string toJson() const;
};

class ReferenceRun {
public:
    explicit ReferenceRun(ReferenceOptions options) : options_(std::move(options)) {}

    /// All of it, on this thread and those that the options ask for. Cancelled, it ends within a tile; files are whole: the last
    /// picture and checkpoint that were saved, or none.
    Outcome run(JobControl& job);

    /// The picture of a run that was done: in the folder of --cache where there is one, else as -o says.
    [[nodiscard]] const std::string& pictureFile() const { return output_; }
    /// Of a run that traced; one that took its picture from the cache has none.
    [[nodiscard]] const ReferenceReport& report() const { return report_; }

private:
    Outcome loadAndCheck(JobControl& job);
    Outcome takeFromCache(bool& taken);
    Outcome startOrResume();
    Outcome probeOutput() const;
    Outcome render(JobControl& job);
    Outcome checkpoint();
    Outcome writePicture();
    Outcome writeReport();
    void sayWhatBecame() const;
    [[nodiscard]] std::string identity() const;
    Outcome copyOut() const;
    [[nodiscard]] std::filesystem::path resumePath() const;

    ReferenceOptions options_;
    reference::RenderSettings settings_;
    Scene scene_;
    int camera_ = kNone;
    std::unique_ptr<ReferenceTracer> tracer_;
    ReferenceReport report_;
    std::string output_, copyTo_;
};

} // namespace tyndall
