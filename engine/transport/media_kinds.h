#pragma once
// Kinds of media: a technique may compute a term in some kinds alone.

#include <cstdint>
#include <string>
#include <string_view>

namespace tyndall {

/// A set of kinds as bits: plain data, crosses the plugin boundary.
using MediaSet = uint32_t;
inline constexpr MediaSet kShapeMedia = 1;    // homogeneous: everywhere, in a box, in a sphere
inline constexpr MediaSet kHeightMedia = 2;   // exponential height fog
inline constexpr MediaSet kGridMedia = 4;     // from files of voxels
inline constexpr MediaSet kParticleMedia = 8; // clouds of particles
inline constexpr uint32_t kMediaKindCount = 4;
inline constexpr MediaSet kAllMedia = 15;

/// "shapes,grids": in order; "" for none.
std::string mediaNames(MediaSet media);
/// One of the names; none of them gives 0.
MediaSet mediaNamed(std::string_view name);

} // namespace tyndall
