#pragma once
// A job as a program without a window runs it: progress on stderr, Ctrl-C ends it.

#include <optional>

#include "app/job.h"
#include "core/progress.h"

namespace tyndall {

class ConsoleJob {
public:
    explicit ConsoleJob(ProgressStyle style);
    [[nodiscard]] JobControl& control() { return control_; }

private:
    void show(const JobProgress& progress);

    ProgressStyle style_;
    uint32_t phase_ = 0;
    std::optional<Progress> shown_; // of that phase
    JobControl control_;
};

} // namespace tyndall
