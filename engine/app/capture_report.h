#pragma once
// What was rendered, by whom, and what it took. Plain data, filled while the renderer lives and written after it is gone, since what it
// leaks belongs into it.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/trace.h"
#include "framegraph/gl/executor.h"
#include "transport/plan.h"

namespace tyndall {

struct CaptureReport {
    struct Pass {
        std::string name, status, reason;
        std::optional<double> gpuMs, savedMs; // empty: not measured
        double cpuMs = 0;
    };
    /// One rendered frame on the clock of the process.
    struct Frame {
        double startMicroseconds = 0, durationMicroseconds = 0;
    };

    std::string scene, backend, glVendor, glRenderer, glVersion;
    int width = 0, height = 0;
    std::string technique, why;
    TermSet claims = 0, missing = 0;
    /// Terms that are missing in some of the scene's kinds of media alone → those kinds.
    std::map<std::string, std::string> missingIn;
    std::vector<Pass> passes;
    std::vector<Frame> frames;
    double startupMs = 0;
    uint64_t gpuBytes = 0, peakResidentBytes = 0;
    uint64_t nonFinite = 0, negative = 0, glErrors = 0;
    int64_t glObjectsLeaked = 0;
    std::map<std::string, uint64_t> iterations;
    std::map<std::string, double> residuals;
    std::map<std::string, std::map<std::string, double>> statistics; // others, by kind

    void setPlan(const FramePlan& plan);
    void setPasses(const fg::FrameReport& report);
    /// By name, of which the part before the first dot is the kind (plugin::Statistic).
    void setStatistics(const std::map<std::string, double>& values);
    /// Milliseconds of the frames; the first, which compiles shaders and fills buffers, only counts where it is alone.
    [[nodiscard]] double medianMs() const;
    [[nodiscard]] double percentile95Ms() const;
    [[nodiscard]] std::string toJson() const;
    /// The passes of the last frame end to end, since the driver tells how long they took but not when.
    void addPassesTo(Trace& trace) const;

private:
    [[nodiscard]] double quantileMs(double quantile) const;
};

} // namespace tyndall
