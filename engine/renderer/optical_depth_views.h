#pragma once
// How each light's volume of optical depth lies around the grids. No GL here.

#include <span>
#include <vector>

#include "core/math.h"
#include "framegraph/resource_desc.h"
#include "shared/light.h"
#include "shared/optical_depth.h"

namespace tyndall {

struct OpticalDepthLayout {
    std::vector<gpu::OpticalDepthView> views; // one a light
    fg::TextureDesc volume;                   // holds the cubes of all volumes
    uint32_t volumeCount = 0;
};

/// `grids`: render-space box around all grids that matter. The first `mostVolumes` lights whose light can cross it get a cube of
/// `resolution`³ texels; later ones are to march. CHECKs: resolution 2 to 2048.
OpticalDepthLayout layOutOpticalDepth(std::span<const gpu::LightData> lights, const Bounds& grids,
                                      int resolution, int mostVolumes);

} // namespace tyndall
