#include "gl/gpu_timer.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "gl/context.h"

namespace tyndall::gl {

GpuTimer::GpuTimer(int framesInFlight) : framesInFlight_(size_t(framesInFlight)) {
    CHECK(framesInFlight > 0, fmt::format("{} frames in flight", framesInFlight));
    available_ = currentCapabilities().limits.timestampBits > 0;
    flushes_ = currentCapabilities().needs(Workaround::FlushTimestamps);
}

GpuTimer::GpuTimer(GpuTimer&& other) noexcept { *this = std::move(other); }

GpuTimer& GpuTimer::operator=(GpuTimer&& other) noexcept {
    if (this == &other) return *this;
    framesInFlight_ = std::exchange(other.framesInFlight_, 0);
    available_ = std::exchange(other.available_, false);
    flushes_ = std::exchange(other.flushes_, false);
    recording_ = std::exchange(other.recording_, false);
    timing_ = std::exchange(other.timing_, false);
    current_ = std::exchange(other.current_, {});
    waiting_ = std::exchange(other.waiting_, {});
    free_ = std::exchange(other.free_, {});
    untimed_ = std::exchange(other.untimed_, 0);
    return *this;
}

Object GpuTimer::takeQuery() {
    if (!free_.empty()) {
        Object query = std::move(free_.back());
        free_.pop_back();
        return query;
    }
    GLuint id = 0;
    glCreateQueries(GL_TIMESTAMP, 1, &id);
    Object query(ObjectKind::Query, id);
    query.label("timestamp");
    return query;
}

/// A query that gets the time at which the GPU has done the commands before.
Object GpuTimer::stamp() {
    Object query = takeQuery();
    glQueryCounter(query.id(), GL_TIMESTAMP);
    if (flushes_) glFlush();
    return query;
}

void GpuTimer::beginFrame(uint64_t frame) {
    CHECK(framesInFlight_ > 0, "the timer is empty");
    CHECK(!recording_, "the frame before has not ended");
    recording_ = true;
    timing_ = available_ && waiting_.size() < framesInFlight_;
    if (available_ && !timing_) ++untimed_;
    current_ = {frame, {}};
}

size_t GpuTimer::begin(std::string_view name) {
    CHECK(recording_, fmt::format("span '{}' begins outside a frame", name));
    Span span{std::string(name), {}, {}};
    if (timing_) span.begin = stamp();
    current_.spans.push_back(std::move(span));
    return current_.spans.size() - 1;
}

void GpuTimer::end(size_t span) {
    CHECK(recording_ && span < current_.spans.size(),
          fmt::format("span {} ends, of {}", span, current_.spans.size()));
    if (!timing_) return;
    CHECK(!current_.spans[span].end,
          fmt::format("span '{}' ends twice", current_.spans[span].name));
    current_.spans[span].end = stamp();
}

void GpuTimer::endFrame() {
    CHECK(recording_, "endFrame() without beginFrame()");
    recording_ = false;
    if (!timing_) return;
    for (const Span& span : current_.spans)
        CHECK(span.end, fmt::format("span '{}' has not ended", span.name));
    waiting_.push_back(std::move(current_));
    current_ = {};
}

bool GpuTimer::complete(const Frame& frame) {
    return std::ranges::all_of(frame.spans, [](const Span& span) {
        for (const Object* query : {&span.end, &span.begin}) {
            GLuint available = GL_FALSE;
            glGetQueryObjectuiv(query->id(), GL_QUERY_RESULT_AVAILABLE, &available);
            if (!available) return false;
        }
        return true;
    });
}

FrameTimes GpuTimer::read(Frame& frame) {
    FrameTimes times{frame.number, {}};
    for (Span& span : frame.spans) {
        GLuint64 begin = 0, end = 0; // nanoseconds
        glGetQueryObjectui64v(span.begin.id(), GL_QUERY_RESULT, &begin);
        glGetQueryObjectui64v(span.end.id(), GL_QUERY_RESULT, &end);
        times.spans.push_back(
            {std::move(span.name), end > begin ? double(end - begin) * 1e-6 : 0.0});
        free_.push_back(std::move(span.begin));
        free_.push_back(std::move(span.end));
    }
    return times;
}

std::vector<FrameTimes> GpuTimer::collect() {
    std::vector<FrameTimes> result;
    while (!waiting_.empty() && complete(waiting_.front())) {
        result.push_back(read(waiting_.front()));
        waiting_.pop_front();
    }
    return result;
}

std::vector<FrameTimes> GpuTimer::collectAll() {
    std::vector<FrameTimes> result;
    for (Frame& frame : waiting_) result.push_back(read(frame)); // reading a result waits for it
    waiting_.clear();
    return result;
}

} // namespace tyndall::gl
