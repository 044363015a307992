#pragma once
// What a capture is asked for.

#include <string>
#include <string_view>
#include <vector>

#include "app/options.h"

namespace tyndall {

struct CaptureOptions {
    RenderOptions render;
    std::string output, report, trace;
    std::vector<std::string> aovs;
    int frames = 0;             // 0: not given
    double timeStep = 1.0 / 60; // seconds
    bool converge = false, half = false, failOnNonFinite = false;
    double maxMs = 0; // 0: no threshold

    [[nodiscard]] bool wantsExr() const;
    /// `%04d` in the output: every frame is written.
    [[nodiscard]] bool writesSequence() const;
    [[nodiscard]] std::string outputOfFrame(int frame) const;
    /// How many frames are rendered at most.
    [[nodiscard]] int frameLimit() const;
    [[nodiscard]] bool hasAov(std::string_view name) const;
};

/// What can be said before any work: endings, folders, combinations. Errors name the option.
Result<void> checkCaptureOptions(const CaptureOptions& options);

} // namespace tyndall
