#pragma once
// Chrome trace events ("Trace Event Format"), to be opened in chrome://tracing or ui.perfetto.dev.

#include <string>
#include <string_view>
#include <vector>

#include "core/cpu_profiler.h"

namespace tyndall {

/// Spans on named tracks.
class Trace {
public:
    /// Tracks appear in the order in which they are added.
    uint32_t addTrack(std::string_view name);
    /// One span; `detail` is shown when it is selected ("skipped: no medium in the scene").
    void addSpan(uint32_t track, std::string_view name, double startMicroseconds,
                 double durationMicroseconds, std::string_view detail = {});
    /// All spans of a profiler, one track a thread: "CPU", "CPU 2" …
    void addProfile(const CpuProfiler& profiler);
    [[nodiscard]] std::string toJson() const;

private:
    struct Span {
        uint32_t track;
        std::string name;
        double start, duration;
        std::string detail;
    };
    std::vector<std::string> tracks_;
    std::vector<Span> spans_;
};

} // namespace tyndall
