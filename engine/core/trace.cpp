#include "core/trace.h"

#include <unistd.h>

#include "core/check.h"
#include "core/json_writer.h"

namespace tyndall {

uint32_t Trace::addTrack(std::string_view name) {
    tracks_.emplace_back(name);
    return uint32_t(tracks_.size() - 1);
}

void Trace::addSpan(uint32_t track, std::string_view name, double startMicroseconds,
                    double durationMicroseconds, std::string_view detail) {
    CHECK(track < tracks_.size());
    spans_.push_back(
        {track, std::string(name), startMicroseconds, durationMicroseconds, std::string(detail)});
}

void Trace::addProfile(const CpuProfiler& profiler) {
    std::vector<uint32_t> tracks;
    for (const CpuSpan& span : profiler.spans()) {
        while (tracks.size() <= span.thread)
            tracks.push_back(
                addTrack(tracks.empty() ? "CPU" : "CPU " + std::to_string(tracks.size() + 1)));
        addSpan(tracks[span.thread], span.name, span.startMicroseconds, span.durationMicroseconds);
    }
}

std::string Trace::toJson() const {
    const int process = ::getpid();
    JsonWriter json;
    json.beginObject().member("displayTimeUnit", "ms").key("traceEvents").beginArray();
    for (size_t track = 0; track < tracks_.size(); ++track) {
        json.compact()
            .beginObject()
            .member("ph", "M")
            .member("name", "thread_name")
            .member("pid", process)
            .member("tid", track);
        json.key("args").beginObject().member("name", tracks_[track]).endObject().endObject();
        json.compact()
            .beginObject()
            .member("ph", "M")
            .member("name", "thread_sort_index")
            .member("pid", process)
            .member("tid", track);
        json.key("args").beginObject().member("sort_index", track).endObject().endObject();
    }
    for (const Span& span : spans_) {
        json.compact()
            .beginObject()
            .member("ph", "X")
            .member("name", span.name)
            .member("cat", tracks_[span.track]);
        json.member("pid", process)
            .member("tid", span.track)
            .member("ts", span.start)
            .member("dur", span.duration);
        if (!span.detail.empty())
            json.key("args").beginObject().member("detail", span.detail).endObject();
        json.endObject();
    }
    return json.endArray().endObject().take();
}

} // namespace tyndall
