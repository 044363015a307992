#pragma once
// Participating media as the scene describes them. Coefficients are per metre of the world, whatever the
// node's scale. Several media may overlap: coefficients add.

#include <memory>
#include <string>

#include "core/math.h"
#include "core/version.h"
#include "media/brick_grid.h"

namespace tyndall {

struct ParticleSet;

enum class MediumKind : int32_t {
    Everywhere = 0, // homogeneous, unbounded
    Box = 1,        // homogeneous; `size` is the full extent, centred at the node
    Sphere = 2,     // homogeneous; `size` holds the diameters (an ellipsoid, where they differ)
    Height = 3,     // exp(-y/scaleHeight) above the node's origin, 1 below, along the node's +Y
    Grid = 4,       // density times a grid's value; the grid is a file's, or of particles
};

enum class PhaseFunction : int32_t { HenyeyGreenstein = 0, Rayleigh = 1, CornetteShanks = 2 };

struct Medium {
    std::string name;
    MediumKind kind = MediumKind::Everywhere;
    dvec3 size{1.0};        // Box, Sphere: node space
    double scaleHeight = 1; // Height: metres of the world, > 0
    vec3 scattering{0};     // per metre, ≥ 0; a grid multiplies all coefficients by its density
    vec3 absorption{0};     // per metre, ≥ 0
    float anisotropy = 0;   // mean cosine parameter g, -1 < g < 1
    PhaseFunction phase = PhaseFunction::HenyeyGreenstein;
    vec3 emission{0};           // nits per metre, times density for a grid
    float temperatureScale = 0; // > 0: blackbody emission from `temperature`, times this
    std::shared_ptr<const BrickGrid> density;     // Grid
    std::shared_ptr<const BrickGrid> temperature; // Grid, kelvin; may be null
    /// What the grids are made of (setParticles in particle_grids.h); null for grids from elsewhere.
    std::shared_ptr<const ParticleSet> particles;

    // As written in the scene file, for saving.
    std::string file, gridName, temperatureGridName;
    Version version = 0;

    [[nodiscard]] vec3 extinction() const { return scattering + absorption; }
};

} // namespace tyndall
