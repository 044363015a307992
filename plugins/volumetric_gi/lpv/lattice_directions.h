#pragma once
// The 26 directions from a cell of a cubic lattice to its neighbours, with the quadrature weights of the
// corrected scheme and the transfer functions of the printed one.

#include <array>

#include "core/math.h"

namespace tyndall::volumetric_gi {

inline constexpr int kLatticeDirections = 26;
inline constexpr int kLengthClasses = 3; // neighbours across a face, an edge, a corner

struct LatticeDirection {
    ivec3 offset{0};     // -1, 0 or 1 along each axis
    int lengthClass = 0; // 0: across a face, 1: an edge, 2: a corner
    double length = 0;   // of `offset`, in cells: sqrt(1 + lengthClass)
    dvec3 unit{0};
    double weight = 0; // of this direction in a mean over the sphere; the 26 sum up to 1
};
/// x runs fastest, from -1 to 1; the weights make means over the 26 directions exact for polynomials up to degree 7 (Lebedev 1976,
/// "Quadratures on a sphere"), solved from the moments of the sphere.
[[nodiscard]] const std::array<LatticeDirection, kLatticeDirections>& latticeDirections();

/// Billeter, Sintorn and Assarsson 2012, section 3: transfer functions in two bands of spherical harmonics (1, y, z, x), and the share of
/// scattered light that each direction gets.
struct TransferFunction {
    double solidAngle =
        0; // of the neighbour's cell, seen from the centre through the cells between: the 26 share the sphere
    std::array<double, 4>
        harmonics{}; // Γ_j = V_j / sqrt(Ω_j), V_j the projection of the solid angle: <Γ_j|1> = sqrt(Ω_j)
    double printedShare =
        0; // γ_j = <Γ_j|1> / Σ <Γ_l|1>: Σ γ_j <Γ_j|1> is not 1, so power is lost
};
[[nodiscard]] const std::array<TransferFunction, kLatticeDirections>& transferFunctions();

} // namespace tyndall::volumetric_gi
