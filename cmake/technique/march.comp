// LVVE from LVE: what a segment scatters once, times the part that the media around it scatter back into it and on to the eye.
#define MARCH_PHASE_GROUPS PHASE_GROUPS
#define MARCH_TURNS
#include "gi/shared/march.glsl"
#include "media/march.glsl"
#include "shared/@name@.h"

layout(std140) uniform Technique { @Name@Params technique; };

/// Of all directions the mean part of light that the media stop: 0 in empty space, 1 deep inside of a cloud.
vec3 opacityAround(vec3 position, vec2 turn) {
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < technique.directions; ++i) {
        vec3 direction = directionOnSphere(fract(turn + vec2(float(i) / float(technique.directions), 0.61803399 * float(i))));
        sum += 1.0 - exp(-opticalDepthAlong(position, direction, kInfiniteDistance));
    }
    return sum / float(technique.directions);
}

vec3 albedoOf(Segment s) {
    vec3 scattering = vec3(0.0);
    for (int g = 0; g < MARCH_PHASE_GROUPS; ++g) scattering += s.scattering[g];
    return scattering / max(s.depth, vec3(1e-30));
}

vec3 mediaLight(Ray ray, float distance, ivec2 pixel, uvec2 number) {
    // Where there is much to do it is done in turns, some of the ray's segments in each: what earlier turns found is in the picture.
    vec3 sum = params.firstSegment > 0u ? imageLoad(inScatter, ivec2(number)).rgb : vec3(0.0);
    March march;
    if (!beginMarch(ray, distance, march)) return sum;
    vec3 noise = vec3(pixelNoise(number, 0u), pixelNoise2(number, 1u));
    vec2 turn = pixelNoise2(number, 2u);
    uint environment = uint(pixelNoise(number, 3u) * float(mediaHeader.environmentStride));
    Segment s;
    for (uint i = 0u; i < params.endSegment && nextSegment(ray, march, s); ++i) {
        if (i >= params.firstSegment && s.scatters) {
            vec3 once = segmentInScatter(ray, s, params.lightCount, noise, environment);
            vec3 around = albedoOf(s) * opacityAround(ray.origin + ray.direction * (s.start + 0.5 * s.size), turn);
            sum += exp(-march.before) * once * around;
        }
        // Golden ratio and its generalisation to two dimensions: neighbouring segments differ as much as they can.
        noise = fract(noise + vec3(0.61803399, 0.75487767, 0.56984029));
        turn = fract(turn + vec2(0.75487767, 0.56984029));
        ++environment;
    }
    return sum;
}
