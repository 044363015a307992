#pragma once
// A capture as a job: frames are rendered headless and written, with a report and a trace of what it took.

#include <memory>
#include <string>

#include "app/capture_options.h"
#include "app/frame_recorder.h"

namespace tyndall {

class CaptureRun {
public:
    /// The options were checked (checkCaptureOptions()).
    explicit CaptureRun(CaptureOptions options) : options_(std::move(options)) {}

    /// All of it, on this thread. Cancelled, it ends between two frames; pictures that are written are whole.
    Outcome run(JobControl& job);
    /// After a run, whether or not the thresholds were met.
    [[nodiscard]] const CaptureReport& report() const { return report_; }

private:
    Outcome renderFrames(JobControl& job);
    Outcome renderFrame();
    Outcome writeFrame(int index);
    void warnOfInvalid(const Image& beauty);
    Outcome writeExrFrame(const std::string& path, Image beauty);
    [[nodiscard]] double displayedEv100() const;
    [[nodiscard]] ImageMetadata metadata() const;
    Outcome writeReports();
    [[nodiscard]] Outcome checkThresholds() const;

    CaptureOptions options_;
    CpuProfiler profiler_;
    std::unique_ptr<RenderSession> session_;
    std::unique_ptr<FrameRecorder> recorder_;
    CaptureReport report_;
};

} // namespace tyndall
