// The clamped geometry term of a virtual light.
#ifndef TYNDALL_GI_VPL_CLAMPING
#define TYNDALL_GI_VPL_CLAMPING

/// min(G, b) / (D_x D_y), 1/m², with G = D_x D_y / d² and b = 1/clampSquared. `cosines`: D_x D_y. Finite for coincident points, and without clamping.
float clampedInverseSquare(float squared, float cosines, float clampSquared) {
    return 1.0 / max(max(squared, cosines * clampSquared), 1e-30);
}

/// Part of a medium's light that clamping removes where light is even: F(x) = 1 - e⁻ˣ - (2 - e⁻ˣ(x² + 2x + 2))/x², x = σ·clamp;
/// a series where the terms cancel.
vec3 clampLoss(vec3 x) {
    vec3 series = x * (2.0 / 3.0 - x * (1.0 / 4.0 - x * (1.0 / 15.0 - x * (1.0 / 72.0 - x / 420.0))));
    vec3 closed = 1.0 - exp(-x) - (2.0 - exp(-x) * (x * x + 2.0 * x + 2.0)) / max(x * x, vec3(1e-12));
    return mix(closed, series, lessThan(x, vec3(0.5)));
}

#endif
