#include "app/capture_report.h"

#include <algorithm>
#include <cmath>

#include "core/json_writer.h"

namespace tyndall {
namespace {

std::optional<double> measured(double milliseconds) {
    return milliseconds < 0 ? std::nullopt : std::optional(milliseconds);
}

void writeOptional(JsonWriter& json, std::string_view key, const std::optional<double>& value) {
    json.key(key);
    if (value)
        json.value(*value);
    else
        json.null();
}

void writeTerms(JsonWriter& json, std::string_view key, TermSet set) {
    json.key(key).compact().beginArray();
    for (uint32_t i = 0; i < kTermCount; ++i)
        if (set & bit(Term(i))) json.value(termName(Term(i)));
    json.endArray();
}

void writePass(JsonWriter& json, const CaptureReport::Pass& pass) {
    json.compact().beginObject().member("name", pass.name).member("status", pass.status);
    if (pass.status == "ran") {
        writeOptional(json, "gpu_ms", pass.gpuMs);
        json.member("cpu_ms", pass.cpuMs);
    } else {
        json.member("reason", pass.reason);
        writeOptional(json, "saved_ms", pass.savedMs);
    }
    json.endObject();
}

} // namespace

void CaptureReport::setPlan(const FramePlan& plan) {
    technique = plan.technique;
    why = plan.why;
    claims = plan.rendered;
    missing = plan.missing;
    for (uint32_t i = 0; i < kTermCount; ++i)
        if (plan.missing & plan.rendered & bit(Term(i)))
            missingIn[std::string(termName(Term(i)))] = mediaNames(plan.missingIn(Term(i)));
}

void CaptureReport::setPasses(const fg::FrameReport& report) {
    passes.clear();
    for (const fg::PassReport& pass : report.passes)
        passes.push_back({std::string(pass.name), fg::statusName(pass.status),
                          std::string(pass.reason), measured(pass.gpuMs), measured(pass.savedMs),
                          pass.cpuMs});
    gpuBytes = report.gpuBytes;
}

void CaptureReport::setStatistics(const std::map<std::string, double>& values) {
    for (const auto& [full, value] : values) {
        const size_t dot = full.find('.');
        const std::string kind = full.substr(0, dot), name = full.substr(dot + 1);
        if (kind == "iterations")
            iterations[name] = uint64_t(std::llround(value));
        else if (kind == "residual")
            residuals[name] = value;
        else
            statistics[kind][name] = value;
    }
}

double CaptureReport::quantileMs(double quantile) const {
    std::vector<double> sorted;
    for (size_t i = frames.size() > 1 ? 1 : 0; i < frames.size(); ++i)
        sorted.push_back(frames[i].durationMicroseconds / 1000);
    if (sorted.empty()) return 0;
    std::sort(sorted.begin(), sorted.end());
    // Linear between the two nearest ranks.
    const double rank = quantile * double(sorted.size() - 1);
    const auto below = size_t(std::floor(rank));
    const size_t above = std::min(below + 1, sorted.size() - 1);
    return sorted[below] + (rank - double(below)) * (sorted[above] - sorted[below]);
}

double CaptureReport::medianMs() const { return quantileMs(0.5); }
double CaptureReport::percentile95Ms() const { return quantileMs(0.95); }

std::string CaptureReport::toJson() const {
    JsonWriter json;
    json.beginObject()
        .member("scene", scene)
        .key("size")
        .compact()
        .beginArray()
        .value(width)
        .value(height)
        .endArray();
    json.member("frames", frames.size())
        .member("backend", backend)
        .key("gl")
        .compact()
        .beginObject();
    json.member("vendor", glVendor)
        .member("renderer", glRenderer)
        .member("version", glVersion)
        .endObject();
    json.member("technique", technique).member("why", why);
    writeTerms(json, "claims", claims);
    writeTerms(json, "missing", missing);
    if (!missingIn.empty()) {
        json.key("missing_in").compact().beginObject();
        for (const auto& [term, media] : missingIn) json.member(term, media);
        json.endObject();
    }
    json.key("passes").beginArray();
    for (const Pass& pass : passes) writePass(json, pass);
    json.endArray();
    json.key("frame_ms")
        .compact()
        .beginObject()
        .member("median", medianMs())
        .member("p95", percentile95Ms())
        .endObject();
    json.member("startup_ms", startupMs)
        .member("gpu_bytes", gpuBytes)
        .member("peak_rss_bytes", peakResidentBytes);
    json.key("counters")
        .compact()
        .beginObject()
        .member("nonfinite", nonFinite)
        .member("negative", negative);
    json.member("gl_errors", glErrors).member("gl_objects_leaked", glObjectsLeaked).endObject();
    json.key("iterations").compact().beginObject();
    for (const auto& [name, count] : iterations) json.member(name, count);
    json.endObject().key("residual").compact().beginObject();
    for (const auto& [name, value] : residuals) json.member(name, value);
    json.endObject();
    for (const auto& [kind, values] : statistics) {
        json.key(kind).compact().beginObject();
        for (const auto& [name, value] : values) json.member(name, value);
        json.endObject();
    }
    return json.endObject().take();
}

void CaptureReport::addPassesTo(Trace& trace) const {
    const uint32_t frameTrack = trace.addTrack("frames");
    for (size_t i = 0; i < frames.size(); ++i)
        trace.addSpan(frameTrack, "frame " + std::to_string(i), frames[i].startMicroseconds,
                      frames[i].durationMicroseconds);
    if (frames.empty()) return;
    const uint32_t gpuTrack = trace.addTrack("GPU passes of the last frame");
    const uint32_t recordTrack = trace.addTrack("CPU recording of the last frame");
    double gpuTime = frames.back().startMicroseconds, cpuTime = gpuTime;
    for (const Pass& pass : passes) {
        const std::string detail =
            pass.reason.empty() ? pass.status : pass.status + ": " + pass.reason;
        const double gpu = 1000 * pass.gpuMs.value_or(0), cpu = 1000 * pass.cpuMs;
        trace.addSpan(gpuTrack, pass.name, gpuTime, pass.status == "ran" ? gpu : 0, detail);
        gpuTime += pass.status == "ran" ? gpu : 0;
        if (pass.status != "ran") continue;
        trace.addSpan(recordTrack, pass.name, cpuTime, cpu);
        cpuTime += cpu;
    }
}

} // namespace tyndall
