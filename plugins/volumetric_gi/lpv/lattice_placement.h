#pragma once
// Where the lattices are: one around the objects of the scene, coarser ones around it out to the landscape.

#include <cstdint>
#include <vector>

#include "core/math.h"
#include "shared/lpv.h"

namespace tyndall::volumetric_gi {

struct LatticeLevel {
    gpu::LpvParams params{};
    uint64_t cells = 0;
    uint64_t key = 0; // of place and size
    bool covered =
        false; // the next finer lattice covers all of this one: there are no look-ups here
    [[nodiscard]] Bounds box() const; // render space
};

struct PlacementRequest {
    Bounds bounds;  // of the scene, render space
    Bounds content; // of its objects, without the landscape around them
    dvec3 eye{0}, forward{0, 0, -1};
    int resolution =
        32; // cells along the longest side of the finest lattice, with one more than its extent at each end
    int most = 4;      // lattices
    double extent = 0; // longest side of the finest lattice, metres; 0: of the content
};

/// The coarsest first. Cells grow by a whole factor of 2 to 4 from one to the next. Along axes that a lattice does not span it follows the eye
/// where the content is longer than it, in whole cells of the next coarser one, so that nothing swims. `bounds` is not empty.
[[nodiscard]] std::vector<LatticeLevel> placeLattices(const PlacementRequest& request);

/// Puts the lattices of look-ups one behind the other in shared textures and links: sets their `place`, returns them as shaders
/// take them, the finest first. `layers`, `links`: texture layers and elements in all; `across`: cells of the largest along x and y.
struct SharedPlaces {
    gpu::LpvLevels levels{};
    ivec2 across{0};
    int layers = 0;
    uint64_t links = 0;
};
[[nodiscard]] SharedPlaces sharePlaces(std::vector<LatticeLevel>& levels);

} // namespace tyndall::volumetric_gi
