// Phase functions: per steradian, integrating to 1 over the sphere. The cosine is between the directions of
// propagation before and after: the forward peak is at +1.
#ifndef TYNDALL_COMMON_PHASE_FUNCTION
#define TYNDALL_COMMON_PHASE_FUNCTION
#include "common/math.glsl"
#include "shared/medium.h"

/// Henyey-Greenstein. The denominator (1-g)² + 2g(1-cos) has no cancellation at a sharp peak of either sign.
float henyeyGreenstein(float g, float cosTheta) {
    float s = abs(g);
    float c = g < 0.0 ? -cosTheta : cosTheta;
    float d = (1.0 - s) * (1.0 - s) + 2.0 * s * max(1.0 - c, 0.0);
    return (1.0 - s) * (1.0 + s) / (4.0 * kPi * d * sqrt(d));
}

float rayleigh(float cosTheta) {
    return 3.0 / (16.0 * kPi) * (1.0 + cosTheta * cosTheta);
}

/// Cornette-Shanks (1992): Henyey-Greenstein times (1 + cos²), renormalised; Rayleigh's function at g = 0.
float cornetteShanks(float g, float cosTheta) {
    return henyeyGreenstein(g, cosTheta) * 1.5 * (1.0 + cosTheta * cosTheta) / (2.0 + g * g);
}

float phaseFunction(uint kind, float g, float cosTheta) {
    if (kind == kPhaseRayleigh) return rayleigh(cosTheta);
    if (kind == kPhaseCornetteShanks) return cornetteShanks(g, cosTheta);
    return henyeyGreenstein(g, cosTheta);
}

/// Mean cosine of the angle of scattering (Cornette and Shanks 1992, equation 9).
float phaseMeanCosine(uint kind, float g) {
    if (kind == kPhaseRayleigh) return 0.0;
    return kind == kPhaseCornetteShanks ? 3.0 * g * (4.0 + g * g) / (5.0 * (2.0 + g * g)) : g;
}

/// The cosine of a scattered direction, by inversion, without cancellation at any g (u in [0,1)). `weight`: of the function over the density drawn with: 1 but for
/// Cornette and Shanks, whose cosines are drawn from Henyey and Greenstein's.
float samplePhaseFunction(uint kind, float g, float u, out float weight) {
    weight = 1.0;
    if (kind == kPhaseRayleigh) { // cos³ + 3 cos = 8u - 4
        float h = 4.0 * u - 2.0;
        float root = sign(h) * pow(abs(h) + sqrt(h * h + 1.0), 1.0 / 3.0);
        return h == 0.0 ? 0.0 : clamp(root - 1.0 / root, -1.0, 1.0);
    }
    float a = abs(g);
    float v = g < 0.0 ? 1.0 - u : u;
    float d = 1.0 - a + 2.0 * a * v;
    float cosine = clamp(1.0 - 2.0 * (1.0 - a) * (1.0 - a) * (1.0 - v) * (1.0 + a * v) / (d * d), -1.0, 1.0);
    if (g < 0.0) cosine = -cosine;
    if (kind == kPhaseCornetteShanks) weight = cornetteShanks(g, cosine) / henyeyGreenstein(g, cosine);
    return cosine;
}

#endif
