// Light that glowing media send to a point from close by.
//
// Averaged frames put a glowing medium's light into points drawn from it (engine/renderer/medium_lights.h). Points inside the
// medium are arbitrarily close to some of them, and the mean of 1/d² would settle as slowly as its variance is: infinite. So lights
// that stand for a medium count distances below b = mediaHeader.nearGlow as b (LightData.intensity.w), which leaves out
// ∫ ε (1/d² − 1/b²) dV over the ball of radius b around the point. With dV = d² dω dd the integrand is ε (1 − d²/b²): bounded, and
// had here from a direction and a distance. b is so small that what stands between is not looked for. The split is that of
// bias compensation for virtual point lights (Kollig and Keller 2004, "Illumination in the Presence of Weak Singularities").
#ifndef TYNDALL_MEDIA_NEAR_GLOW
#define TYNDALL_MEDIA_NEAR_GLOW
#include "common/math.glsl"
#include "media/blackbody.glsl"

/// Radiance (nits) that arrives at `position` against `direction` from less than b away. `u` (0..1) chooses the distance; unbiased but
/// for the extinction on the way, which is that at its far end.
vec3 nearGlow(vec3 position, vec3 direction, float u) {
    vec3 from = position + direction * (mediaHeader.nearGlow * u);
    vec3 emission = vec3(0.0);
    vec3 extinction = vec3(0.0);
    for (uint m = 0u; m < mediumCount(); ++m) {
        float density = mediumDensity(m, from);
        if (!(density > 0.0)) continue;
        extinction += density * media[m].extinction.rgb;
        if (media[m].kind == kMediumEverywhere || media[m].kind == kMediumHeight) continue; // without an end: no light
        emission += density * media[m].emission.rgb;
        if (media[m].emission.w > 0.0) emission += density * blackbodyEmission(m, from);
    }
    return emission * exp(-extinction * (mediaHeader.nearGlow * u)) * (mediaHeader.nearGlow * (1.0 - u * u));
}

/// Evenly over all directions.
vec3 directionOnSphere(vec2 u) {
    float z = 1.0 - 2.0 * u.x;
    float r = sqrt(max(0.0, 1.0 - z * z));
    float turn = 2.0 * kPi * u.y;
    return vec3(r * cos(turn), r * sin(turn), z);
}

#endif
