#include "core/cpu_profiler.h"

#include <algorithm>
#include <chrono>
#include <sys/resource.h>
#include <thread>

namespace tyndall {
namespace {
const auto kProcessStart = std::chrono::steady_clock::now(); // set while the program is loaded
}

double processMicroseconds() {
    return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() -
                                                     kProcessStart)
        .count();
}

uint64_t peakResidentBytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return uint64_t(usage.ru_maxrss) * 1024; // Linux counts in KiB
}

void CpuProfiler::record(std::string_view name, double startMicroseconds,
                         double durationMicroseconds) {
    const uint64_t thread = std::hash<std::thread::id>()(std::this_thread::get_id());
    const std::lock_guard lock(mutex_);
    const auto known = std::find(threads_.begin(), threads_.end(), thread);
    const auto index = uint32_t(known - threads_.begin());
    if (known == threads_.end()) threads_.push_back(thread);
    spans_.push_back({std::string(name), startMicroseconds, durationMicroseconds, index});
}

std::vector<CpuSpan> CpuProfiler::spans() const {
    const std::lock_guard lock(mutex_);
    return spans_;
}

} // namespace tyndall
