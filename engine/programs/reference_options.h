#pragma once
// The command line of `tyndall reference`.

#include <cstdint>
#include <string>

#include "core/result.h"
#include "reference/render.h"

namespace CLI {
class App;
}

namespace tyndall {

struct ReferenceOptions {
    std::string scene, output, size = "1280x720", terms = "all", camera, integrator = "volume",
                               transmittance = "ratio", report, cache;
    int64_t spp = 0;
    double seconds = 0, targetError = 0, checkpointSeconds = 30, clamp = 0.1;
    int maxDepth = 0, threads = 0;
    uint64_t seed = 0;
    bool resume = false, half = false, keep = false;
};

void addReferenceOptions(CLI::App& command, ReferenceOptions& options);

/// What is wrong with them, as one sentence; else `settings` says what to render.
Result<void> checkReferenceOptions(const ReferenceOptions& options,
                                   reference::RenderSettings& settings);

} // namespace tyndall
