#pragma once
// What a comparison found: metrics by name, thresholds, and both as text and as JSON.

#include <optional>
#include <string>
#include <vector>

#include "app/compare_input.h"
#include "core/tone_curve.h"

namespace tyndall {

/// How the two are shown for the metrics that look at pictures as people do.
struct CompareDisplay {
    double ev100 = 0;
    std::string origin; // where ev100 is from
    ToneCurve curve = kDefaultToneCurve;
};

struct Metric {
    std::string name;
    std::optional<double> value;
    std::string note; // why there is no value, or what to know about it
};

/// The metrics of docs/compare.md in its order, all of them: what cannot be told has no value and says why. The two have one
/// shape and are both linear or both display-referred.
std::vector<Metric> measure(const ComparedImage& image, const ComparedImage& reference,
                            const ComparedPart& part, const CompareDisplay& display);
/// The two as a display shows them. Display-referred ones are taken as they are.
Image shownImage(const ComparedImage& image, const CompareDisplay& display);

enum class Bound { AtMost = 0, AtLeast = 1, AtMostFromOne = 2 };

struct Threshold {
    const char* option;
    const char* metric;
    Bound bound;
    const char* help;
    std::optional<double> limit = {};

    [[nodiscard]] bool metBy(double value) const;
};
/// Every threshold that there is, without limits.
std::vector<Threshold> compareThresholds();

struct CompareReport {
    const ComparedImage& image;
    const ComparedImage& reference;
    ComparedPart part;
    CompareDisplay display;
    std::vector<Metric> metrics;
    std::vector<Threshold> thresholds; // those with a limit
    std::vector<std::string> notes;

    [[nodiscard]] const Metric& metric(std::string_view name) const;
    /// Sentences, joined: invalid values first, then each threshold that is not met. "" where all is well.
    [[nodiscard]] std::string failure() const;
    [[nodiscard]] std::string toText() const;
    [[nodiscard]] std::string toJson() const;
};

} // namespace tyndall
