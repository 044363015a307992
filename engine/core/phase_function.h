#pragma once
// Phase functions of cosθ between the directions of propagation before and after (forward peak at +1), per steradian:
// each integrates to 1 over the sphere. g is in (-1,1); ±1 exactly is a CHECK failure.

namespace tyndall {

// --- Henyey–Greenstein 1941: mean cosine g, Legendre moments g^l.
/// In the form that keeps the forward peak (1+g)/(4π(1-g)²) exact.
[[nodiscard]] double henyeyGreenstein(double cosTheta, double g);
/// The same from 1 - cosθ, which two unit vectors give without cancellation as |ω-ω'|²/2: for |g| near 1.
[[nodiscard]] double henyeyGreensteinFromVersine(double oneMinusCos, double g);
/// cosθ distributed as the function; exact inversion without cancellation for every g. u in [0,1].
[[nodiscard]] double sampleHenyeyGreenstein(double u, double g);
[[nodiscard]] float sampleHenyeyGreenstein(float u, float g);
/// The integral over the backward hemisphere.
[[nodiscard]] double henyeyGreensteinBackFraction(double g);

// --- Rayleigh: 3/(16π)·(1+cos²θ). Mean cosine 0, second Legendre moment 1/10.
[[nodiscard]] double rayleigh(double cosTheta);
[[nodiscard]] double sampleRayleigh(double u);

// --- Cornette and Shanks 1992: 3/(8π)·(1-g²)(1+cos²θ)/((2+g²)(1+g²-2g·cosθ)^1.5). Rayleigh at g = 0.
[[nodiscard]] double cornetteShanks(double cosTheta, double g);
/// By inversion of the cumulative distribution (closed form, bracketed Newton steps): to 1e-12 in cosθ.
[[nodiscard]] double sampleCornetteShanks(double u, double g);
/// 3g(4+g²)/(5(2+g²)): not g.
[[nodiscard]] double cornetteShanksMeanCosine(double g);

} // namespace tyndall
