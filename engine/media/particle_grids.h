#pragma once
// Particles as bricks: the form that marches, light-space passes and the reference use for any grid.
//
// A particle of radius r and density ρ spreads its matter, ρ·(4/3)πr³, as ρ·(105/16)·(1 - d²/r²)³ at the distance d < r from its
// middle, and no farther: a smooth ball whose mean density is ρ. Where particles overlap their densities add.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/result.h"
#include "media/brick_grid.h"
#include "media/particles.h"

namespace tyndall {

struct Medium;

/// The kernel's peak over its mean: its integral over the unit ball is (64/315)π.
inline constexpr double kParticlePeak = 105.0 / 16;
/// Voxels along the radius that a tenth of the particles do not exceed. Between voxels the field is linear, which makes a ball wider: its
/// variance along an axis, r²/11, grows by a sixth of the voxel's square, here by a ninth, as if r were 6 % larger.
inline constexpr double kVoxelsPerRadius = 4;
/// In voxels. With this radius the sum over voxels is the particle's matter to 3 %, wherever it lies between them; below it, matter
/// would come and go. Smaller particles are spread over this radius, with the same matter.
inline constexpr double kLeastParticleRadius = 2;

/// What the grids of one set may use. Voxels become larger until they fit.
struct ParticleGridLimits {
    uint64_t voxels = uint64_t(1) << 24; // in blocks of 8³ that matter reaches: 64 MiB a grid
    uint64_t blocks = uint64_t(1) << 21; // of the whole box, empty ones included
    uint64_t sums = uint64_t(1) << 30;   // pairs of a particle and a voxel: seconds
};

struct ParticleGrids {
    std::shared_ptr<const BrickGrid> density;     // never null; no bricks where there is no matter
    std::shared_ptr<const BrickGrid> temperature; // kelvin; null where the set has none
    std::vector<std::string> notes; // a sentence each: larger voxels, small particles …
};

/// The fields at voxels that are cubes along the axes of the node's space, (1/kVoxelsPerRadius) of the radius that a tenth of the
/// particles do not exceed, or as much larger as `limits` want. Temperature is the mean weighted by density; in the voxels
/// around the matter, which its outermost cells reach, the mean weighted by kernels that reach a voxel's diagonal farther.
/// Sums are in double precision and in an order of their own: the order of the particles changes no bit. A particle that is there
/// twice counts twice. Particles without density have no part in anything. Errors: numbers that are not finite,
/// radius ≤ 0, density or temperature < 0, balls that reach beyond 1e30 m.
Result<ParticleGrids> makeParticleGrids(const ParticleSet& set,
                                        const ParticleGridLimits& limits = {});

/// Lets a medium consist of these particles: at first, and again whenever they move. Returns the notes. Errors as
/// makeParticleGrids; the medium is then as it was.
Result<std::vector<std::string>> setParticles(Medium& medium,
                                              std::shared_ptr<const ParticleSet> particles);

} // namespace tyndall
