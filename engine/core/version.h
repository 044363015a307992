#pragma once
// Change tracking by version numbers: whoever changes a thing takes the next number; whoever caches
// what was made from it compares. Nothing is hashed, nothing is notified.

#include <atomic>
#include <cstdint>

namespace tyndall {

/// 0 is "never"; every change anywhere in the process takes a number larger than all before.
using Version = uint64_t;

inline Version nextVersion() {
    static std::atomic<Version> last{0};
    return last.fetch_add(1, std::memory_order_relaxed) + 1;
}

} // namespace tyndall
