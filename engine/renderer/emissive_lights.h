#pragma once
// Glowing surfaces as lights. The direct passes know lamps, not triangles: a surface that glows evenly and has the shape of
// a rectangle or a ball is the same light in another guise, and becomes one.

#include <string>
#include <vector>

#include "scene/scene.h"

namespace tyndall {

/// A light that stands for a glowing surface.
struct EmissiveLight {
    Light light;
    dmat4 worldFromLight{1.0}; // the light looks along -Z
    int node = kNone;          // of the surface
};

struct EmissiveLights {
    std::vector<EmissiveLight> lights;
    std::vector<std::string>
        notes; // a sentence for each node that glows and lights nothing, and why
};

/// Of all visible nodes: planes (both sides, where the material is double-sided) and balls among the primitives, glowing
/// without a texture. `world` and `visible` as from the scene.
EmissiveLights findEmissiveLights(const Scene& scene, const std::vector<dmat4>& world,
                                  const std::vector<bool>& visible);

} // namespace tyndall
