#pragma once
// Which eye rays share a sub-buffer of the interleaved framebuffer: for shaders that include gi/surfels/interleave.glsl.

#include <cstdint>
#include <vector>

namespace tyndall::volumetric_gi {

/// A permutation of 0 … side² − 1, row by row: any lowest ranks together are spread evenly over the tile, which repeats without a seam. Void and cluster (Ulichney 1993,
/// "The Void-and-Cluster Method for Dither Array Generation").
[[nodiscard]] std::vector<uint32_t> blueNoiseRanks(uint32_t side);

/// The buffer `Interleave`: for each of `levels` levels l the rank of each ray of the tile among the 2^l × 2^l of its neighbourhood, and for each neighbourhood the ray of each
/// rank. Ranks follow from blueNoiseRanks().
[[nodiscard]] std::vector<uint32_t> interleaveTables(uint32_t levels);

} // namespace tyndall::volumetric_gi
