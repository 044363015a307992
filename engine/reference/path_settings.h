#pragma once
// What an integrator is told.

#include "tracing/path_counts.h"
#include "tracing/tracer_scene.h"

namespace tyndall::reference {

using namespace tracing; // integrators speak in rays, media, lights and walks throughout
using tracing::Sampler;   // not the texture sampler of a scene

struct PathSettings {
    TermSet terms = kAllTerms;
    int maxScatterings = -1;                                    // -1: any number
    TransmittanceMode transmittance = TransmittanceMode::Ratio; // the better one at equal time
    bool nextEventEstimation = true;   // without it lights without extent stay dark
    bool nextEventFromSegments = true; // also from points drawn for it along each piece of a path
    /// No path is longer, whatever it carries; reaching it is counted.
    static constexpr int kLongest = 100000;
};

} // namespace tyndall::reference
