#pragma once
// Visibility maps of virtual point lights, by rays: an octahedron of directions with the number of the first triangle in each.

#include <vector>

#include "volumetric_gi/vpl/vpl_walks.h"

namespace tyndall::volumetric_gi {

/// Numbers of triangles (SurfaceScene::triangles), kNoTriangle where no surface is: `side`² for each light of the set, and behind them, as the bits of a
/// float, metres up to which the light sees no surface, as far as rays show. `jitter`: number of a pattern of positions within texels; 0: their centres.
std::vector<uint32_t> makeVisibilityMaps(const tracing::SurfaceScene& surfaces, const VplSet& set,
                                         uint32_t side, uint32_t jitter);

} // namespace tyndall::volumetric_gi
