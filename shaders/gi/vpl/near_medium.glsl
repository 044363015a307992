// What the bound on the geometry term takes away from the light of media near by: followed one step, to a point that gathers in turn, all lights
// of the scene straight and one class of walks (validation: compensation algebra; transport.md 5.1 g, h).
#ifndef TYNDALL_GI_VPL_NEAR_MEDIUM
#define TYNDALL_GI_VPL_NEAR_MEDIUM
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
    // What nothing makes up for is held less.
    float perArea = vplInverseSquare(squared, cosines, onSurface ? min(vplClampScale(position) * vpl.mediumClampSquared, clampSquared) : clampSquared);
    vec3 depth = vplOpticalDepth(light, position, towards, distance);
    return scatteredLight(s, dot(towards, direction), depth) * intensity * perArea;
}

/// Of those lights that count towards `terms`. One loop over all lights of the class's walks: invocations side by side gather other classes, and would wait for the longest of their walks each time.
vec3 walksInMedium(uint number, vec3 position, vec3 direction, Segment s, float clampSquared, uint terms) {
    vec3 sum = vec3(0.0);
    uint walk = number % vpl.classes;
    uint light = 0u;
    uint end = 0u; // of the walk's lights, of which there is at least one
    while (light < end || walk < vpl.walkCount) {
        if (light == end) {
            light = vplWalks[walk];
            end = vplWalks[walk + 1u];
            walk += vpl.classes;
        }
        if (vplCounts(light, terms)) sum += lightInMedium(light, position, direction, s, clampSquared);
        ++light;
    }
    return sum * float(vpl.classes);
}

/// The lights that count at a point from which media scatter light on to a receiver for whom `terms` count.
uint vplTermsOneStepOn(uint terms) { return (terms & (1u << kVplLaterOfMedia)) != 0u ? kVplAllTerms : 0u; }

/// A segment without length at a point: scattering coefficients in place of their integrals.
Segment pointSegment(Ray ray, float at, float scale) {
    float size = max(1e-4 * scale, 1e-6 * (at + 1.0));
    uint eyes = marchedMedia; // what counts is what the eye sees scattered, not where its light was scattered before
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

/// 1/b at that point. What is gathered there has the bound relaxed, and misses what that takes away.
float relaxedBound(float reach) { return reach * reach / (vpl.relaxed * vpl.relaxed); }

#endif
