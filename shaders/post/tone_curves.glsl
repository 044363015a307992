// Tone curves: from exposed linear sRGB (1 is display white) to display-referred linear sRGB in [0,1].
#ifndef TYNDALL_TONE_CURVES
#define TYNDALL_TONE_CURVES
#include "shared/post.h"

// Stephen Hill's fit of the ACES reference rendering and output transforms (BakingLab, 2016).
vec3 toneAces(vec3 c) {
    const mat3 inputMatrix = mat3(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777);
    const mat3 outputMatrix = mat3(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602);
    vec3 v = inputMatrix * c;
    vec3 a = v * (v + 0.0245786) - 0.000090537;
    vec3 b = v * (0.983729 * v + 0.4329510) + 0.238081;
    return clamp(outputMatrix * (a / b), 0.0, 1.0);
}

// AgX (Troy Sobotka), base look, by Benjamin Wrensch's polynomial for its contrast curve; gamut compression in Rec. 2020
// with the matrices that Filament and Blender use.
vec3 toneAgx(vec3 c) {
    const mat3 rec2020FromSrgb = mat3(0.6274, 0.0691, 0.0164, 0.3293, 0.9195, 0.0880, 0.0433, 0.0113, 0.8956);
    const mat3 srgbFromRec2020 = mat3(1.6605, -0.1246, -0.0182, -0.5876, 1.1329, -0.1006, -0.0728, -0.0083, 1.1187);
    const mat3 inset = mat3(0.856627153, 0.137318973, 0.111898213, 0.095121241, 0.761241991, 0.076799419,
                            0.048251606, 0.101439036, 0.811302368);
    const mat3 outset = mat3(1.127100582, -0.141329763, -0.141329763, -0.110606643, 1.157823702, -0.110606643,
                             -0.016493939, -0.016493939, 1.251936407);
    const float minimumEv = -12.47393, maximumEv = 4.026069;
    vec3 v = inset * (rec2020FromSrgb * c);
    v = clamp((log2(max(v, 1e-10)) - minimumEv) / (maximumEv - minimumEv), 0.0, 1.0);
    vec3 v2 = v * v, v4 = v2 * v2;
    v = 15.5 * v4 * v2 - 40.14 * v4 * v + 31.96 * v4 - 6.868 * v2 * v + 0.4298 * v2 + 0.1191 * v - 0.00232;
    v = pow(max(outset * v, 0.0), vec3(2.2));
    return clamp(srgbFromRec2020 * v, 0.0, 1.0);
}

// Khronos PBR Neutral: true to base colours below the shoulder (specification of 2024).
vec3 toneNeutral(vec3 c) {
    const float start = 0.8 - 0.04, desaturation = 0.15;
    float least = min(c.r, min(c.g, c.b));
    c -= least < 0.08 ? least - 6.25 * least * least : 0.04;
    float peak = max(c.r, max(c.g, c.b));
    if (peak < start) return c;
    float room = 1.0 - start;
    float newPeak = 1.0 - room * room / (peak + room - start);
    c *= newPeak / peak;
    return mix(c, vec3(newPeak), 1.0 - 1.0 / (desaturation * (peak - newPeak) + 1.0));
}

vec3 toneCurve(uint curve, vec3 c) {
    if (curve == kToneAces) return toneAces(c);
    if (curve == kToneAgx) return toneAgx(c);
    if (curve == kToneNeutral) return toneNeutral(c);
    return clamp(c, 0.0, 1.0);
}

vec3 srgbFromLinear(vec3 c) {
    return mix(12.92 * c, 1.055 * pow(max(c, 0.0), vec3(1.0 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308)));
}

#endif
