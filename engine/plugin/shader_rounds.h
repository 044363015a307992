#pragma once
// How many rounds of loops shaders take. A driver may end all loops of an invocation after so many (llvmpipe: 65,535, LP_MAX_TGSI_LOOP_ITERATIONS): light that
// was still to come is missing then, and what is computed from a loop that was cut short need not be a number. Passes that may take more do their work in turns.
// Counts are of invocations side by side, which wait for each other: each loop takes the rounds of the longest of theirs, and one even where none enters it.

#include "plugin/frame_resources.h"

namespace tyndall {

/// That one invocation may take, with a margin for what is not counted one by one.
constexpr double kMostShaderRounds = 60000;

/// opticalDepthAlong() in shaders/media/optical_depth.glsl, grids in steps: of a loop over media, bricks in it and steps in those.
inline double opticalDepthRounds(const MediaResources& media) {
    return 1 + 3 * double(media.count) +
           double(media.bricksOnRay) * (2 + double(media.stepsInBrick));
}

/// segmentInScatter() in shaders/media/march.glsl for a segment at a point: of each light the texels of its shadow and the way to it.
inline double straightLightRounds(const MediaResources& media) {
    constexpr double kShadow = 20;
    const bool marched =
        (media.kinds & gpu::kMediaGrids) != 0 && (media.kinds & gpu::kMediaLightVolumes) == 0;
    return double(media.lightsAtOnce) *
           (kShadow + (marched ? opticalDepthRounds(media) : 3 * double(media.count)));
}

/// All of nextSegment() along a ray (shaders/media/march_loop.glsl), grids in steps.
inline double marchRounds(const MediaResources& media) {
    return double(media.stepsOnRay) * (6 + 4 * double(media.count));
}

} // namespace tyndall
