#include "app/compare_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/display_metrics.h"
#include "core/json_writer.h"

namespace tyndall {
namespace {

constexpr const char* kChannelSuffixes[] = {"_r", "_g", "_b"};

Metric valueOf(std::string name, double value, std::string note = {}) {
    if (std::isnan(value)) return {std::move(name), {}, "there are values that are not finite"};
    return {std::move(name), value, std::move(note)};
}

void addLinear(std::vector<Metric>& metrics, const ComparedImage& image,
               const ComparedImage& reference) {
    if (image.displayReferred) {
        for (const char* name : {"rmse", "relmse", "relmse_trimmed", "mrse", "smape", "p999",
                                 "energy", "energy_r", "energy_g", "energy_b"})
            metrics.push_back({name, {}, "a PNG is not linear light: compare .exr files"});
        return;
    }
    const ImageMetrics m = compareImages(image.image, reference.image).value(); // shapes agree
    for (Metric metric :
         {valueOf("rmse", m.rmse), valueOf("relmse", m.relmse),
          valueOf("relmse_trimmed", m.relmseTrimmed), valueOf("mrse", m.mrse),
          valueOf("smape", m.smape), valueOf("p999", m.p999), valueOf("energy", m.energy)})
        metrics.push_back(std::move(metric));
    if (image.image.channels < 3) return;
    for (size_t c = 0; c < 3; ++c)
        metrics.push_back(
            valueOf(std::string("energy") + kChannelSuffixes[c], m.energyPerChannel[c]));
}

void addDisplayed(std::vector<Metric>& metrics, const ComparedImage& image,
                  const ComparedImage& reference, const ComparedPart& part,
                  const CompareDisplay& display) {
    std::string why;
    if (!part.isLight())
        why = part.text() + " is not light, so it has no look";
    else if (image.counts.nonFinite + reference.counts.nonFinite > 0)
        why = "there are values that are not finite";
    if (!why.empty()) {
        for (const char* name : {"psnr", "ssim", "flip"}) metrics.push_back({name, {}, why});
        return;
    }
    const Image shown = shownImage(image, display), wanted = shownImage(reference, display);
    metrics.push_back(valueOf("psnr", psnr(shown, wanted), "dB"));
    if (std::min(shown.width, shown.height) < kSsimWindow)
        metrics.push_back({"ssim", {}, fmt::format("its windows are {0}x{0} pixels", kSsimWindow)});
    else
        metrics.push_back(valueOf("ssim", ssim(shown, wanted)));
    metrics.push_back(valueOf("flip", flip(shown, wanted)));
}

Metric floorOf(const ComparedImage& reference) {
    if (!reference.variance) return {"reference_floor", {}, reference.whyNoVariance};
    const Result<double> floor = referenceFloor(reference.image, *reference.variance);
    if (!floor.ok())
        return {"reference_floor",
                {},
                fmt::format("layer 'variance' of '{}': {}", reference.file, floor.message())};
    return valueOf("reference_floor", *floor, "what relmse owes to the reference's own noise");
}

/// The sentence about values that light cannot have, or "".
std::string invalidValues(const ComparedImage& image) {
    const ValueCounts& counts = image.counts;
    if (counts.nonFinite + counts.negative == 0) return {};
    return fmt::format(
        "'{}': {} values are not finite and {} are negative, the first is {}; light is finite and at least 0",
        image.file, counts.nonFinite, counts.negative, image.firstInvalid);
}

const char* boundText(Bound bound) {
    switch (bound) {
    case Bound::AtMost: return "at most";
    case Bound::AtLeast: return "at least";
    case Bound::AtMostFromOne: return "1 to within";
    }
    return "";
}

void writeCounts(JsonWriter& json, const char* key, const ValueCounts& counts) {
    json.key(key).compact().beginObject();
    json.member("nonfinite", counts.nonFinite).member("negative", counts.negative).endObject();
}

} // namespace

Image shownImage(const ComparedImage& image, const CompareDisplay& display) {
    return image.displayReferred ? image.image
                                 : displayImage(image.image, display.ev100, display.curve);
}

std::vector<Metric> measure(const ComparedImage& image, const ComparedImage& reference,
                            const ComparedPart& part, const CompareDisplay& display) {
    std::vector<Metric> metrics;
    addLinear(metrics, image, reference);
    addDisplayed(metrics, image, reference, part, display);
    metrics.push_back(floorOf(reference));
    return metrics;
}

bool Threshold::metBy(double value) const {
    switch (bound) { // written so that what is no number meets nothing
    case Bound::AtMost: return value <= *limit;
    case Bound::AtLeast: return value >= *limit;
    case Bound::AtMostFromOne: return std::abs(value - 1) <= *limit;
    }
    return false;
}

std::vector<Threshold> compareThresholds() {
    return {
        {"--max-rmse", "rmse", Bound::AtMost, "Fail when the root mean square error is larger"},
        {"--max-relmse", "relmse", Bound::AtMost, "Fail when the relative squared error is larger"},
        {"--max-relmse-trimmed", "relmse_trimmed", Bound::AtMost,
         "The same without the worst 0.1 % of pixels"},
        {"--max-mrse", "mrse", Bound::AtMost,
         "Fail when the mean relative squared error is larger"},
        {"--max-smape", "smape", Bound::AtMost, "Fail when the symmetric relative error is larger"},
        {"--max-p999", "p999", Bound::AtMost,
         "Fail when the 99.9th percentile of relative errors is larger"},
        {"--max-energy-error", "energy", Bound::AtMostFromOne,
         "Fail when mean(A)/mean(B) is farther from 1"},
        {"--min-psnr", "psnr", Bound::AtLeast, "Fail when PSNR is lower, in dB"},
        {"--min-ssim", "ssim", Bound::AtLeast, "Fail when SSIM is lower"},
        {"--max-flip", "flip", Bound::AtMost, "Fail when FLIP is larger"},
    };
}

const Metric& CompareReport::metric(std::string_view name) const {
    const auto found = std::find_if(metrics.begin(), metrics.end(),
                                    [&](const Metric& metric) { return metric.name == name; });
    CHECK(found != metrics.end(), "an unknown metric");
    return *found;
}

std::string CompareReport::failure() const {
    std::string text = invalidValues(image);
    const auto add = [&](const std::string& sentence) {
        if (!sentence.empty()) text += (text.empty() ? "" : "; ") + sentence;
    };
    add(invalidValues(reference));
    for (const Threshold& threshold : thresholds) {
        const Metric& m = metric(threshold.metric);
        if (!m.value)
            add(fmt::format("{} {:g}: {} could not be told: {}", threshold.option, *threshold.limit,
                            m.name, m.note));
        else if (!threshold.metBy(*m.value))
            add(fmt::format("{} {:g}: {} of '{}' against '{}' is {:.6g} and should be {} {:g}",
                            threshold.option, *threshold.limit, m.name, image.file, reference.file,
                            *m.value, boundText(threshold.bound), *threshold.limit));
    }
    return text;
}

std::string CompareReport::toText() const {
    std::string text = fmt::format("{} against {}: {} in {}x{} pixels", image.file, reference.file,
                                   part.text(), image.image.width, image.image.height);
    if (part.isLight() && !image.displayReferred)
        text += fmt::format("; shown at EV100 {:g} ({}), tone curve {}", display.ev100,
                            display.origin, kToneCurveNames[size_t(display.curve)]);
    text += '\n';
    const auto row = [&](std::string_view name, const std::string& value, std::string_view note) {
        text += note.empty() ? fmt::format("  {:<16} {}\n", name, value)
                             : fmt::format("  {:<16} {:<12} {}\n", name, value, note);
    };
    const ValueCounts &a = image.counts, &b = reference.counts;
    row("nonfinite", std::to_string(a.nonFinite + b.nonFinite),
        fmt::format("{} + {}", a.nonFinite, b.nonFinite));
    row("negative", std::to_string(a.negative + b.negative),
        fmt::format("{} + {}", a.negative, b.negative));
    std::string without; // names of metrics without a value for one reason, told in one line
    for (size_t i = 0; i < metrics.size(); ++i) {
        const Metric& m = metrics[i];
        if (m.value) {
            row(m.name, fmt::format("{:.6g}", *m.value), m.note);
            continue;
        }
        without += (without.empty() ? "" : ", ") + m.name;
        if (i + 1 < metrics.size() && !metrics[i + 1].value && metrics[i + 1].note == m.note)
            continue;
        text += fmt::format("  no {}: {}\n", without, m.note);
        without.clear();
    }
    for (const std::string& note : notes) text += "note: " + note + "\n";
    return text;
}

std::string CompareReport::toJson() const {
    JsonWriter json;
    json.beginObject().member("image", image.file).member("reference", reference.file);
    json.key("size").compact().beginArray();
    json.value(image.image.width).value(image.image.height).endArray();
    json.member("compared", part.text());
    if (part.isLight() && !image.displayReferred)
        json.member("ev100", display.ev100)
            .member("tone_curve", kToneCurveNames[size_t(display.curve)]);
    json.key("counts").beginObject();
    writeCounts(json, "image", image.counts);
    writeCounts(json, "reference", reference.counts);
    json.endObject();
    json.key("metrics").beginObject();
    for (const Metric& m : metrics) {
        json.key(m.name);
        if (m.value)
            json.value(*m.value);
        else
            json.null();
    }
    json.endObject();
    json.key("without_value").beginObject();
    for (const Metric& m : metrics) {
        if (!m.value) json.member(m.name, m.note);
        if (m.value && std::isinf(*m.value)) json.member(m.name, "infinite");
    }
    json.endObject();
    json.key("thresholds").beginArray();
    for (const Threshold& threshold : thresholds) {
        const std::optional<double> value = metric(threshold.metric).value;
        json.compact().beginObject();
        json.member("option", threshold.option).member("limit", *threshold.limit);
        json.member("metric", threshold.metric);
        json.member("met", value.has_value() && threshold.metBy(*value)).endObject();
    }
    json.endArray();
    json.key("notes").beginArray();
    for (const std::string& note : notes) json.value(note);
    json.endArray();
    json.member("passed", failure().empty()).endObject();
    return json.take();
}

} // namespace tyndall
