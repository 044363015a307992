#include "programs/console_job.h"

#include "programs/interrupt.h"

namespace tyndall {

ConsoleJob::ConsoleJob(ProgressStyle style)
    : style_(style), control_([this](const JobProgress& progress) { show(progress); },
                              [] { return interrupted(); }) {}

void ConsoleJob::show(const JobProgress& progress) {
    if (progress.phase == phase_) {
        if (shown_) shown_->update(progress.fraction, progress.sentence);
        return;
    }
    phase_ = progress.phase;
    shown_.reset(); // which clears the terminal's line
    if (!progress.label.empty()) shown_.emplace(progress.label, style_);
}

} // namespace tyndall
