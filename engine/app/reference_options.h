#pragma once
// What a run of the reference path tracer is asked for.

#include <cstdint>
#include <string>

#include "app/options.h"
#include "app/reference_tracer.h"

namespace tyndall {

struct ReferenceOptions : ViewOptions {
    std::string output, integrator = "volume", transmittance = "ratio", report, cache;
    ReferenceGoals goals;
    double checkpointSeconds = 30, clamp = 0.1; // clamp: metres
    int maxDepth = 0, threads = 0;
    bool resume = false, half = false, keep = false;
};

/// What is wrong with them, as one sentence; else `settings` says what to render. Without a goal, `options` gets 64 samples a pixel.
Result<void> understandReference(ReferenceOptions& options, reference::RenderSettings& settings);

} // namespace tyndall
