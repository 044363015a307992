#include "core/progress.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <unistd.h>

#include <fmt/format.h>

namespace tyndall {
namespace {

constexpr double kTerminalInterval = 0.1, kLineInterval = 10.0; // seconds
constexpr double kSecondsBeforeEstimate = 0.5;
constexpr double kFractionBeforeEstimate = 0.02;

double steadySeconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

void writeToStderr(std::string_view text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
}

} // namespace

std::string durationText(double seconds) {
    const auto whole = int64_t(std::ceil(seconds));
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
    return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

std::string progressText(std::string_view label, double fraction, double elapsedSeconds) {
    fraction = std::clamp(fraction, 0.0, 1.0);
    std::string text = fmt::format("{}: {} %", label, int(std::floor(fraction * 100)));
    if (fraction >= kFractionBeforeEstimate && fraction < 1 &&
        elapsedSeconds >= kSecondsBeforeEstimate)
        text += ", " + durationText(elapsedSeconds * (1 - fraction) / fraction) + " left";
    return text;
}

ProgressStyle detectProgressStyle() {
    return ::isatty(STDERR_FILENO) ? ProgressStyle::Terminal : ProgressStyle::Lines;
}

Progress::Progress(std::string label, ProgressStyle style)
    : Progress(std::move(label), style, steadySeconds, writeToStderr) {}

Progress::Progress(std::string label, ProgressStyle style, Clock clock, Write write)
    : label_(std::move(label)), style_(style), clock_(std::move(clock)), write_(std::move(write)),
      start_(clock_()),
      // The first update shows at once on a terminal; short work says nothing in a log.
      lastWritten_(style == ProgressStyle::Terminal ? start_ - kTerminalInterval : start_) {}

Progress::~Progress() {
    if (lineOpen_) write_("\r\x1b[K");
}

void Progress::update(double fraction, std::string_view detail) {
    if (style_ == ProgressStyle::Quiet) return;
    const double now = clock_();
    if (now - lastWritten_ <
        (style_ == ProgressStyle::Terminal ? kTerminalInterval : kLineInterval))
        return;
    lastWritten_ = now;
    const std::string text =
        progressText(detail.empty() ? std::string_view(label_) : detail, fraction, now - start_);
    lineOpen_ = style_ == ProgressStyle::Terminal;
    write_(lineOpen_ ? "\r\x1b[K" + text : text + "\n");
}

} // namespace tyndall
