#pragma once
// Exact line integrals through media, in double precision: what the renderer's results are measured against.
//
// A medium's density is dimensionless: 1 inside the homogeneous shapes, a falling exponential for height fog, the
// grid's value. Optical depth is the coefficient σt (per metre of the world) times the density's line integral (metres).

#include "core/math.h"
#include "media/medium.h"

namespace tyndall {

/// A piece of a ray in the world: origin + t·direction, t from 0 to length (metres; may be infinite).
struct RaySegment {
    dvec3 origin{0};
    dvec3 direction{0, 0, -1}; // unit
    double length = 0;
};

/// ∫₀^L S·e^(-σt) dt per channel for constant source S and extinction σ ≥ 0: S·L at σ = 0, S/σ for σL → ∞.
[[nodiscard]] dvec3 segmentSource(const dvec3& source, const dvec3& extinction, double length);

/// The density at a point of the world; `worldFromMedium` is the node's transform (any invertible affine one).
[[nodiscard]] double mediumDensity(const Medium& medium, const dmat4& worldFromMedium,
                                   const dvec3& position);

/// ∫ density dt over the segment, metres. Closed form for the homogeneous shapes and for height fog; through a grid
/// exact up to rounding, see integrateGrid. CHECKs: unit direction.
[[nodiscard]] double densityLength(const Medium& medium, const dmat4& worldFromMedium,
                                   const RaySegment& segment);

/// Optical depth per channel: extinction × densityLength. 0 where the extinction is 0, however long the segment.
[[nodiscard]] dvec3 opticalDepth(const Medium& medium, const dmat4& worldFromMedium,
                                 const RaySegment& segment);

/// ∫ of the grid's field over the segment: cell by cell, because along a line inside one cell the trilinear field is a
/// cubic, for which Simpson's rule on three samples is exact.
[[nodiscard]] double integrateGrid(const BrickGrid& grid, const dmat4& worldFromIndex,
                                   const RaySegment& segment);

} // namespace tyndall
