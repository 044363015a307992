#include "volumetric_gi/vpl/vpl_rounds.h"

#include <algorithm>
#include <cmath>

namespace tyndall::volumetric_gi {
namespace {

/// For lights alone, in one turn; marches and what else is done at a point take some, too.
constexpr double kMostOfLights = 40000;
/// Of walks through the tree of triangles, over its depth; maps leave few doubts, but invocations side by side wait for each other's.
constexpr double kOfDoubt = 1;
/// Behind leaves there is always a doubt.
constexpr double kBehindLeaves = 3;
/// Left to the points of a turn at least, however long marches may be at worst.
constexpr double kLeastOfPoints = 20000;

double treeDepth(const TracedScene& scene) { return std::log2(double(scene.tree().size()) + 1); }

/// That each light gathered takes: its own, one for each medium's optical depth and each phase function, a grid's four texels, and the tree's.
double roundsOfLight(const MediaResources& media, bool grids, const TracedScene& scene) {
    return 1 + double(media.count) + (media.phaseGroups > 1 ? double(media.phaseGroups) : 0) +
           (grids ? 4 : 0) + (scene.hasHoles() ? kBehindLeaves : kOfDoubt) * treeDepth(scene);
}

} // namespace

VplRounds::VplRounds(const MediaResources& media, bool grids, const TracedScene& scene,
                     const gpu::VplParams& params)
    : media_(media), params_(params), ofLight_(roundsOfLight(media, grids, scene)),
      ofTree_(kBehindLeaves * treeDepth(scene)) {}

uint32_t VplRounds::subsets(int32_t wanted, double points) const {
    const double least = ofLight_ * double(params_.lightCount) * points / kMostOfLights;
    return uint32_t(std::clamp(std::max(double(wanted), std::ceil(least)), 1.0,
                               double(std::max(params_.walkCount, 1u))));
}

uint32_t VplRounds::pointsATurn() const {
    // The march to a point's segment, what shortens the bound there, and the loops around it all.
    const double around = 20 + 4 * double(media_.count + media_.phaseGroups);
    const double gathered = ofLight_ * double(params_.lightCount) / double(params_.subsets);
    double ofPoint = around + gathered;
    if (params_.compensation == gpu::kVplTraced)
        ofPoint += around + gathered + ofTree_ + opticalDepthRounds(media_);
    if (params_.compensation != gpu::kVplClamped) ofPoint += straightLightRounds(media_);
    // A ray is marched twice: first to find out how much it scatters.
    const double rounds = std::max(kMostShaderRounds - 2 * marchRounds(media_), kLeastOfPoints);
    return uint32_t(std::clamp(rounds / ofPoint, 1.0, double(params_.samples)));
}

} // namespace tyndall::volumetric_gi
