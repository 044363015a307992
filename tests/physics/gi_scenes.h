#pragma once
// Scenes and measurements that the laws of all techniques for indirect light share.

#include <string>
#include <vector>

#include "scene/scene.h"
#include "support/render.h"
#include "transport/terms.h"

namespace tyndall::test {

inline constexpr TermSet kIndirect = kIndirectOnSurfaces | kIndirectInMedia;

/// Mean indirect light of a small picture, on surfaces and in media, by the technique `gi`.
double indirectMean(const std::string& gi, const Scene& scene, std::vector<std::string> settings);

/// A closed room of 4 × 3 × 5 m in fog, with walls of `thickness`, turned by `angle` about the vertical; sun and a lamp are outside.
std::string sealedRoom(double thickness, double angle, bool fromInside);

/// A floor, a wall, a lamp of `light` candela, and what `medium` says (JSON of nodes, each followed by a comma).
std::string corner(double light, const std::string& medium);

} // namespace tyndall::test
