#include "app/job.h"

#include <algorithm>

namespace tyndall {

JobProgress JobControl::progress() const {
    const std::scoped_lock lock(mutex_);
    return progress_;
}

template <typename Change> void JobControl::change(const Change& change) {
    const std::scoped_lock oneAtATime(listening_);
    JobProgress now;
    {
        const std::scoped_lock lock(mutex_);
        change(progress_);
        now = progress_;
    }
    if (listener_) listener_(now);
}

JobPhase::JobPhase(JobControl& control, std::string label) : control_(control) {
    control_.change([&](JobProgress& progress) {
        progress = {progress.phase + 1, std::move(label), 0, {}};
    });
}

JobPhase::~JobPhase() {
    control_.change([](JobProgress& progress) { progress = {progress.phase + 1, {}, 0, {}}; });
}

void JobPhase::update(double fraction, std::string sentence) {
    control_.change([&](JobProgress& progress) {
        progress.fraction = std::clamp(fraction, 0.0, 1.0);
        progress.sentence = std::move(sentence);
    });
}

} // namespace tyndall
