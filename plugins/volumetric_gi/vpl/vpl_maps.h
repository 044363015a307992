#pragma once
// What virtual point lights see: a map for each, an octahedron of directions with the number of the triangle that is seen first. Rays find it, so
// that it is exact up to the map's resolution.

#include <vector>

#include "volumetric_gi/vpl/vpl_walks.h"

namespace tyndall::volumetric_gi {

/// Numbers of triangles (SurfaceScene::triangles), kNoTriangle where no surface is: `side`² for each light of the set, and behind them, as the bits of a
/// float, metres up to which the light sees no surface, as far as rays tell. `jitter`: number of a pattern of places within texels; 0: their middles.
std::vector<uint32_t> makeVisibilityMaps(const tracing::SurfaceScene& surfaces, const VplSet& set,
                                         uint32_t side, uint32_t jitter);

} // namespace tyndall::volumetric_gi
