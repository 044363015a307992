// Light of virtual point lights that media scatter along a ray. Each segment of the ray gathers, at one point, the walks of one class; the
// next segment those of the next class (Engelhardt, Novák and Dachsbacher 2010, section 4.2).
#define MARCH_PHASE_GROUPS PHASE_GROUPS
#include "common/random.glsl"
#include "media/march.glsl"
#include "gi/vpl/lights.glsl"

/// Light of one virtual light that a segment's media scatter along `direction` reversed: nits, per unit of the segment's transmittance.
vec3 lightInMedium(uint light, vec3 position, vec3 direction, Segment s, float clampSquared) {
    vec3 way = vplLights[light].position.xyz - position;
    float squared = dot(way, way);
    float distance = sqrt(squared);
    vec3 towards = distance > 0.0 ? way / distance : direction;
    vec3 intensity = vplIntensity(light, -towards);
    if (!(maximumOf(intensity) > 0.0) || !vplSees(light, position, -towards, distance, vec3(0.0))) return vec3(0.0);
    bool onSurface = vplLights[light].position.w < 0.0;
    float cosines = onSurface ? dot(vplLights[light].normal.xyz, -towards) : 1.0;
    float perArea = 1.0 / max(max(squared, cosines * clampSquared), 1e-30);
    vec3 depth = opticalDepthAlong(position, towards, distance);
    return scatteredLight(s, dot(towards, direction), depth) * intensity * perArea;
}

vec3 walksInMedium(uint number, vec3 position, vec3 direction, Segment s, float clampSquared) {
    vec3 sum = vec3(0.0);
    for (uint walk = number % vpl.classes; walk < vpl.walkCount; walk += vpl.classes)
        for (uint light = vplWalks[walk]; light < vplWalks[walk + 1u]; ++light)
            sum += lightInMedium(light, position, direction, s, clampSquared);
    return sum * float(vpl.classes);
}

/// A segment without length at a point: scattering coefficients in place of their integrals.
Segment pointSegment(Ray ray, float at) {
    float size = max(1e-4 * sqrt(vpl.clampSquared), 1e-6 * (at + 1.0));
    Segment s = marchSegment(Ray(ray.origin + ray.direction * (at - 0.5 * size), ray.direction), 0.0, size);
    float scale = 1.0 / s.size;
    for (int g = 0; g < MARCH_PHASE_GROUPS; ++g) s.scattering[g] *= scale;
    s.depth = vec3(0.0);
    return s;
}

/// A direction of travel from the mixture of phase functions that scatter the segment's light. `weight`: of the function over the density.
vec3 phaseDirection(Segment s, vec3 direction, vec3 u, out float weight) {
    uint chosen = 0u;
#if MARCH_PHASE_GROUPS > 1
    float total = 0.0;
    for (uint g = 0u; g < min(mediaHeader.phaseGroupCount, uint(MARCH_PHASE_GROUPS)); ++g) total += meanOf(s.scattering[g]);
    float target = u.z * total;
    for (uint g = 0u; g < min(mediaHeader.phaseGroupCount, uint(MARCH_PHASE_GROUPS)); ++g) {
        chosen = g;
        if (target < meanOf(s.scattering[g])) break;
        target -= meanOf(s.scattering[g]);
    }
#endif
    float cosine = samplePhaseFunction(uint(mediaHeader.phases[chosen].x), mediaHeader.phases[chosen].y, u.x, weight);
    float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    float angle = 2.0 * kPi * u.y;
    return normalize(frameAround(direction) * vec3(sine * cos(angle), sine * sin(angle), cosine));
}

/// What the bound takes away from the light that a segment scatters at `position`: one vertex near by that gathers in turn, all lights
/// straight and one class of walks (validation: compensation algebra; transport.md 5.1 g, h). The distance is drawn by 1 - t²/d², the part that is
/// missing, so that this weighs nothing; what is then gathered has the bound relaxed.
vec3 compensation(uint number, vec3 position, vec3 direction, Segment s, uvec2 pixel, uint dimension) {
    float reach = sqrt(vpl.clampSquared);
    vec3 u = vec3(pixelNoise2(pixel, dimension), pixelNoise(pixel, dimension + 1u));
    float v = fract(u.z * 61.0 + u.x * 17.0);
    // Light that goes on along -`direction` came along a direction that the phase function relates to it: travel backwards from the point.
    float weight;
    vec3 back = phaseDirection(s, direction, u, weight);
    float t = reach * 2.0 * sin(asin(v) / 3.0);
    Segment there = pointSegment(Ray(position, back), t);
    if (!there.scatters) return vec3(0.0);
    vec3 through = exp(-opticalDepthAlong(position, back, t));
    vec3 at = position + back * t;
    vec3 light = walksInMedium(number, at, back, there, vpl.clampSquared / (vpl.relaxed * vpl.relaxed));
    Segment placed = there;
    placed.start = t;
    placed.size = max(1e-5 * t, 1e-20);
    light += segmentInScatter(Ray(position, back), placed, vpl.lightsOfScene, u, number);
    vec3 scattering = vec3(0.0);
    for (int g = 0; g < MARCH_PHASE_GROUPS; ++g) scattering += s.scattering[g];
    return scattering * (2.0 / 3.0 * reach * weight) * through * light;
}

/// Nits that reach the ray's origin from up to `distance` metres.
vec3 lightScatteredAlong(Ray ray, float distance, uvec2 pixel) {
    vec3 sum = vec3(0.0);
    float t;
    float end;
    if (mediaExtent(ray, distance, t, end)) {
        vec3 before = vec3(0.0);
        float opaque = -log(max(mediaHeader.minTransmittance, 1e-30));
        uint number = uint(pixelNoise(pixel, 21u) * float(vpl.classes));
        float noise = pixelNoise(pixel, 22u);
        for (int i = 0; i < 16384 && t < end && minimumOf(before) < opaque; ++i) {
            Segment s = marchSegment(ray, t, end);
            t = s.start + s.size;
            if (s.scatters) {
                ++number;
                GatherPoint point = gatherBySegment(s, fract(noise + 0.618034 * float(i)));
                vec3 position = ray.origin + ray.direction * (s.start + s.size * point.fraction);
                vec3 light = walksInMedium(number, position, ray.direction, s, vpl.clampSquared);
#if COMPENSATION == 2
                light += compensation(number + vpl.classes / 2u, position, ray.direction, s, pixel, uint(23 + 2 * i));
#endif
                sum += exp(-before) * point.weight * light;
            }
            before = min(before + s.depth, vec3(kOpaque));
        }
    }
    return sum;
}
