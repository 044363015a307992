#include "core/cpu_profiler.h"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <limits>
#include <string>
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

uint64_t availableMemoryBytes() {
    uint64_t available = std::numeric_limits<uint64_t>::max();
    std::ifstream machine("/proc/meminfo");
    for (std::string key, rest; machine >> key && std::getline(machine, rest);)
        if (key == "MemAvailable:") available = std::stoull(rest) * 1024;
    const auto number = [](const char* file) {
        uint64_t value = 0;
        std::ifstream(file) >> value; // "max" is no number: no limit
        return value;
    };
    const uint64_t limit = number("/sys/fs/cgroup/memory.max"),
                   used = number("/sys/fs/cgroup/memory.current");
    if (limit > 0) available = std::min(available, limit > used ? limit - used : 0);
    return available;
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
