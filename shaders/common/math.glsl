// Scalar helpers that stay accurate where the textbook form cancels or divides by zero.
#ifndef TYNDALL_COMMON_MATH
#define TYNDALL_COMMON_MATH

const float kPi = 3.14159265358979;

// A distance that stands for "no end". Small enough that products with coefficients stay finite.
const float kInfiniteDistance = 1e30;

/// (1 - exp(-x)) / x for x >= 0; 1 at 0. Within 5e-7 of the exact value for every x.
/// The series takes over where 1 - exp(-x) would cancel.
float oneMinusExpOverX(float x) {
    if (x < 0.25)
        return 1.0 - x * (1.0 / 2.0 - x * (1.0 / 6.0 - x * (1.0 / 24.0 - x * (1.0 / 120.0 - x * (1.0 / 720.0 - x / 5040.0)))));
    return (1.0 - exp(-x)) / x;
}
vec3 oneMinusExpOverX(vec3 x) {
    return vec3(oneMinusExpOverX(x.r), oneMinusExpOverX(x.g), oneMinusExpOverX(x.b));
}

/// 1 - exp(-x) for x >= 0 without cancellation.
float oneMinusExp(float x) {
    x = min(x, 64.0); // 1 to single precision from there on
    return x * oneMinusExpOverX(x);
}

/// -log(1 - z) / z for z < 1, of either sign; 1 at 0.
float minusLogOneMinusOverZ(float z) {
    if (abs(z) < 0.05)
        return 1.0 + z * (1.0 / 2.0 + z * (1.0 / 3.0 + z * (1.0 / 4.0 + z * (1.0 / 5.0 + z / 6.0))));
    return -log(max(1.0 - z, 1e-38)) / z;
}

/// Where in [0,1] a truncated exponential of optical depth `tau` puts the random number `u`: exp(-tau·s)
/// normalised on [0,1]. Uniform at tau 0; no division by zero, no logarithm of zero.
float truncatedExponential(float tau, float u) {
    float z = u * oneMinusExp(tau);
    if (tau < 1e-3) return u * (1.0 - 0.5 * (1.0 - u) * tau);
    return min(z * minusLogOneMinusOverZ(z) / tau, 1.0);
}

float maximumOf(vec3 v) { return max(v.x, max(v.y, v.z)); }
float minimumOf(vec3 v) { return min(v.x, min(v.y, v.z)); }
float meanOf(vec3 v) { return (v.x + v.y + v.z) * (1.0 / 3.0); }

/// Finite and not NaN, by comparison: min, max and clamp are undefined for NaN.
bool isFiniteNumber(float x) { return x >= -3.4e38 && x <= 3.4e38; }
bool isFiniteNumber(vec3 v) { return isFiniteNumber(v.x) && isFiniteNumber(v.y) && isFiniteNumber(v.z); }

#endif
