#pragma once
// How many rounds of loops shaders take. A driver may end all loops of an invocation after so many (llvmpipe: 65,535, LP_MAX_TGSI_LOOP_ITERATIONS): light that
// was still to come is missing then, and what is computed from a loop that was cut short need not be a number. Passes that may take more do their work in turns.
// Counts are of invocations side by side, which wait for each other: each loop takes the rounds of the longest of theirs, and one even where none enters it.

#include <algorithm>
#include <cmath>

#include "plugin/frame_resources.h"

namespace tyndall {

/// That one invocation may take, with a margin for what is not counted one by one.
constexpr double kMostShaderRounds = 60000;

/// Cells of a grid, of which each brick has as many along an edge, and the bricks' own borders.
constexpr double kCellsOfBrick = 9;

/// How the rays of a pass go through grids.
enum class GridWay { Steps, Cells };

/// What the passes of the engine's own march do in this frame.
inline GridWay gridWay(const MediaResources& media) {
    return (media.kinds & gpu::kMediaExactGrids) != 0 ? GridWay::Cells : GridWay::Steps;
}

/// opticalDepthAlong() in shaders/media/optical_depth.glsl: of a loop over media, bricks in it and steps or cells in those.
inline double opticalDepthRounds(const MediaResources& media, GridWay way = GridWay::Steps) {
    const double inBrick = way == GridWay::Cells ? kCellsOfBrick : double(media.stepsInBrick);
    return 1 + 3 * double(media.count) + double(media.bricksOnRay) * (2 + inBrick);
}

/// segmentInScatter() in shaders/media/march.glsl for a segment at a point: of each light the texels of its shadow and the way to it.
inline double straightLightRounds(const MediaResources& media, GridWay way = GridWay::Steps) {
    constexpr double kShadow = 20;
    const bool marched = (media.kinds & gpu::kMediaGrids) != 0 &&
                         (way == GridWay::Cells || (media.kinds & gpu::kMediaLightVolumes) == 0);
    return double(media.lightsAtOnce) *
           (kShadow + (marched ? opticalDepthRounds(media, way) : 3 * double(media.count)));
}

/// Of a ray, at most.
inline double segmentsOnRay(const MediaResources& media, GridWay way = GridWay::Steps) {
    return double(media.stepsOnRay) +
           (way == GridWay::Cells ? kCellsOfBrick * double(media.bricksOnRay) : 0);
}

/// nextSegment() along all of a ray (shaders/media/march_loop.glsl).
inline double marchRounds(const MediaResources& media, GridWay way = GridWay::Steps) {
    return segmentsOnRay(media, way) * (6 + 4 * double(media.count));
}

/// At how many segments of a ray a turn of marchMedia() (shaders/media/march.glsl) gathers light; at least 1.
inline double segmentsATurn(const MediaResources& media) {
    constexpr double kLeast = 20000; // left to the lights, however long marches may be at worst
    const GridWay way = gridWay(media);
    const double left = std::max(kMostShaderRounds - marchRounds(media, way), kLeast);
    return std::max(std::floor(left / std::max(straightLightRounds(media, way), 1.0)), 1.0);
}

} // namespace tyndall
