// Bias compensation by one traced step: clamped light of media near by, from a point that gathers direct light and one interleaved subset of the walks.
#ifndef TYNDALL_GI_VPL_COMPENSATION
#define TYNDALL_GI_VPL_COMPENSATION
#define MARCH_PHASE_GROUPS PHASE_GROUPS
#include "common/random.glsl"
#include "media/march.glsl"
#include "gi/vpl/optical_depth.glsl"
#include "gi/vpl/visibility.glsl"

/// Light of one virtual light that a segment's media scatter against `direction`: nits, before the segment's own extinction.
vec3 lightInMedium(uint light, vec3 position, vec3 direction, Segment s, float clampSquared) {
    vec3 way = vplLights[light].position.xyz - position;
    float squared = dot(way, way);
    float distance = sqrt(squared);
    vec3 towards = distance > 0.0 ? way / distance : direction;
    vec3 intensity = vplIntensity(light, -towards);
    if (!(maximumOf(intensity) > 0.0) || !vplSees(light, position, -towards, distance)) return vec3(0.0);
    bool onSurface = vplLights[light].position.w < 0.0;
    float cosines = onSurface ? dot(vplLights[light].normal.xyz, -towards) : 1.0;
    // Light that nothing compensates for is clamped less.
    float perArea = vplInverseSquare(squared, cosines, onSurface ? min(vplClampScale(position) * vpl.mediumClampSquared, clampSquared) : clampSquared);
    vec3 depth = vplOpticalDepth(light, position, towards, distance);
    return scatteredLight(s, dot(towards, direction), depth) * intensity * perArea;
}

/// Of the lights that count towards `terms`. One loop over all lights of the subset's walks: neighbouring invocations gather other subsets, and with one loop for each walk they would wait for the longest walk each time.
vec3 walksInMedium(uint number, vec3 position, vec3 direction, Segment s, float clampSquared, uint terms) {
    vec3 sum = vec3(0.0);
    uint walk = number % vpl.subsets;
    uint light = 0u;
    uint end = 0u; // of the walk's lights, of which there is at least one
    while (light < end || walk < vpl.walkCount) {
        if (light == end) {
            light = vplWalks[walk];
            end = vplWalks[walk + 1u];
            walk += vpl.subsets;
        }
        if (vplCounts(light, terms)) sum += lightInMedium(light, position, direction, s, clampSquared);
        ++light;
    }
    return sum * float(vpl.subsets);
}

/// The lights that count at a point whose light media scatter on to a receiver for which `terms` count.
uint vplTermsOneStepOn(uint terms) { return (terms & (1u << kVplLaterOfMedia)) != 0u ? kVplAllTerms : 0u; }

/// A segment without length at a point: scattering coefficients in place of their integrals.
Segment pointSegment(Ray ray, float at, float scale) {
    float size = max(1e-4 * scale, 1e-6 * (at + 1.0));
    uint eyes = marchedMedia; // kinds count where light is scattered to the eye, not where it was scattered before
    marchedMedia = 0xffffffffu;
    Segment s = marchSegment(Ray(ray.origin + ray.direction * (at - 0.5 * size), ray.direction), 0.0, size);
    marchedMedia = eyes;
    for (int g = 0; g < MARCH_PHASE_GROUPS; ++g) s.scattering[g] /= s.size;
    s.depth = vec3(0.0);
    s.start = at;
    s.size = max(1e-5 * at, 1e-20);
    return s;
}

/// A point near `position`, for ∫ (1 - t²/reach²) · transmittance · light that media scatter towards `position`, over t from 0 to reach along
/// `direction`: the distance t is drawn by the first factor. False where no medium is, or behind a wall.
bool drawNearPoint(vec3 position, vec3 direction, float reach, float u, out float t, out Segment there) {
    t = reach * 2.0 * sin(asin(u) / 3.0);
    there = pointSegment(Ray(position, direction), t, reach);
    return there.scatters && !triangleBetween(position, position + direction * t);
}

/// Of light that is scattered at that point: transmittance over density, metres.
vec3 nearPointWeight(vec3 position, vec3 direction, float reach, float t) {
    return 2.0 / 3.0 * reach * exp(-opticalDepthAlong(position, direction, t));
}

/// 1/b at that point, with relaxed clamping; the light that this removes is not compensated for.
float relaxedClampSquared(float reach) { return reach * reach / (vpl.relaxed * vpl.relaxed); }

#endif
