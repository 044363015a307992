#pragma once
// Where the time of a program went: named spans on the clock of the process.

#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {

/// Microseconds since the process was loaded.
double processMicroseconds();
/// The largest resident memory so far, bytes.
uint64_t peakResidentBytes();
/// Memory that this process can still take before the system ends it: what the machine has free, and what its control group
/// allows. The largest number where neither can be told.
uint64_t availableMemoryBytes();

struct CpuSpan {
    std::string name;
    double startMicroseconds = 0, durationMicroseconds = 0;
    uint32_t thread = 0; // 0 is the first thread that recorded
};

/// Collects spans from any thread.
class CpuProfiler {
public:
    void record(std::string_view name, double startMicroseconds, double durationMicroseconds);
    /// In order of their ends.
    [[nodiscard]] std::vector<CpuSpan> spans() const;

private:
    mutable std::mutex mutex_;
    std::vector<CpuSpan> spans_;
    std::vector<uint64_t> threads_; // hashes of thread ids, in order of appearance
};

/// Records the time from its construction to its destruction. `profiler` may be null.
class CpuZone {
public:
    CpuZone(CpuProfiler* profiler, std::string name)
        : profiler_(profiler), name_(std::move(name)), start_(processMicroseconds()) {}
    ~CpuZone() {
        if (profiler_) profiler_->record(name_, start_, processMicroseconds() - start_);
    }
    CpuZone(const CpuZone&) = delete;
    CpuZone& operator=(const CpuZone&) = delete;

private:
    CpuProfiler* profiler_;
    std::string name_;
    double start_;
};

} // namespace tyndall
