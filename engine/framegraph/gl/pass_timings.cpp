#include "framegraph/gl/pass_timings.h"

#include <algorithm>

#include "framegraph/hash.h"

namespace tyndall::fg {

PassTimings::PassTimings(bool enabled) : enabled_(enabled) {
    if (enabled) timer_ = gl::GpuTimer(int(kFramesInFlight));
}

void PassTimings::beginFrame() {
    ++frame_;
    if (!enabled_) return;
    // A frame that the timer leaves out uses the same place again, so that those that wait keep theirs.
    if (frames_[current_].frame != 0 && timer_.framesUntimed() == untimed_)
        current_ = (current_ + 1) % frames_.size();
    untimed_ = timer_.framesUntimed();
    frames_[current_].frame = frame_;
    frames_[current_].keys.clear();
    timer_.beginFrame(frame_);
}

uint64_t PassTimings::keyOf(std::string_view passName) {
    const uint64_t name = hashName(passName);
    Seen& seen = seen_[name];
    if (seen.frame != frame_) seen = {frame_, 0};
    return mixHash(name, seen.count++);
}

void PassTimings::begin(uint64_t key, std::string_view passName) {
    if (!enabled_) return;
    frames_[current_].keys.push_back(key);
    span_ = timer_.begin(passName);
}

void PassTimings::end() {
    if (enabled_) timer_.end(span_);
}

void PassTimings::endFrame() {
    if (!enabled_) return;
    timer_.endFrame();
    keep(timer_.collect());
}

void PassTimings::finish() {
    if (enabled_) keep(timer_.collectAll());
}

void PassTimings::keep(const std::vector<gl::FrameTimes>& arrived) {
    for (const gl::FrameTimes& times : arrived)
        for (const FrameKeys& frame : frames_) {
            if (frame.frame != times.frame) continue;
            for (size_t i = 0; i < std::min(frame.keys.size(), times.spans.size()); ++i)
                lastMs_[frame.keys[i]] = times.spans[i].milliseconds;
        }
}

double PassTimings::lastMs(uint64_t key) const {
    const auto found = lastMs_.find(key);
    return found == lastMs_.end() ? -1.0 : found->second;
}

} // namespace tyndall::fg
