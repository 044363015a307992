#pragma once
// Sampling of distances along a ray in media, in forms that keep their digits where the textbook ones lose them.
// Templates over float and double, both instantiated in sampling.cpp. `u` is in [0,1).

namespace tyndall {

/// (1-e^-x)/x for x ≥ 0: 1 at 0, 1/x for large x.
template <typename Real> [[nodiscard]] Real oneMinusExpOverX(Real x);

template <typename Real> struct DistanceSample {
    Real distance; // along the ray
    Real density;  // probability per unit of distance
};

/// Free flight: density σ·e^(-σt) over [0,∞). σ > 0. Infinite only for σ = 0.
template <typename Real> [[nodiscard]] DistanceSample<Real> sampleExponential(Real u, Real sigma);

/// The same, conditional on [0,length]; tends to the uniform distribution for σ·length → 0. σ ≥ 0, length ≥ 0.
template <typename Real>
[[nodiscard]] DistanceSample<Real> sampleTruncatedExponential(Real u, Real sigma, Real length);
/// Its density at `distance` in [0,length].
template <typename Real>
[[nodiscard]] Real truncatedExponentialDensity(Real distance, Real sigma, Real length);

/// Equiangular sampling (Kulla and Fajardo 2012) of [0,length]: density ∝ 1/(h² + (t-t₀)²), for a point light whose
/// nearest point on the ray's line lies at t₀ = `nearest` (any sign), `height` = h ≥ 0 away from it. Where the interval
/// subtends nearly no angle, or none is left to tell points apart, it is uniform. h is raised to 10⁻⁴ of the length.
template <typename Real>
[[nodiscard]] DistanceSample<Real> sampleEquiangular(Real u, Real nearest, Real height,
                                                     Real length);
/// Its density at `distance` in [0,length].
template <typename Real>
[[nodiscard]] Real equiangularDensity(Real distance, Real nearest, Real height, Real length);

} // namespace tyndall
