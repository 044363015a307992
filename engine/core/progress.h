#pragma once
// Progress of long work for a person: a line on a terminal that is rewritten, a line now and then in a log.

#include <functional>
#include <string>
#include <string_view>

namespace tyndall {

/// "rendering: 40 %, 12 s left". `fraction` 0..1; no estimate before it can be one.
std::string progressText(std::string_view label, double fraction, double elapsedSeconds);
/// "3 s", "2 min 10 s", "1 h 5 min".
std::string durationText(double seconds);

enum class ProgressStyle { Quiet = 0, Lines = 1, Terminal = 2 };
/// Terminal where stderr is one, else Lines.
ProgressStyle detectProgressStyle();

/// One piece of work. The terminal's line is cleared at the end.
class Progress {
public:
    using Clock = std::function<double()>; // seconds
    using Write = std::function<void(std::string_view)>;
    Progress(std::string label, ProgressStyle style);
    /// With a clock and an output of one's own.
    Progress(std::string label, ProgressStyle style, Clock clock, Write write);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// 0..1. `detail` says what is being done and replaces the label. Cheap: writes at most ten times a second to a terminal,
    /// every ten seconds otherwise.
    void update(double fraction, std::string_view detail = {});

private:
    std::string label_;
    ProgressStyle style_;
    Clock clock_;
    Write write_;
    double start_, lastWritten_;
    bool lineOpen_ = false;
};

} // namespace tyndall
