#pragma once
// How much of the gathering one invocation of a shader does, so that no driver ends its loops (plugin/shader_rounds.h): from how many walks a point
// gathers, and at how many points of a ray a turn does.

#include "plugin/shader_rounds.h"
#include "shared/vpl.h"
#include "volumetric_gi/shared/traced_scene.h"

namespace tyndall::volumetric_gi {

class VplRounds {
public:
    VplRounds(const MediaResources& media, bool grids, const TracedScene& scene,
              const gpu::VplParams& params);

    /// At least `wanted` subsets: so many that `points` points gather from one of them each.
    [[nodiscard]] uint32_t subsets(int32_t wanted, double points) const;
    /// Of params.samples, with params.subsets and params.compensation; at least 1.
    [[nodiscard]] uint32_t pointsATurn() const;

private:
    const MediaResources& media_;
    const gpu::VplParams& params_;
    double ofLight_; // gathered at one point
    double ofTree_;  // to ask all triangles once
};

} // namespace tyndall::volumetric_gi
