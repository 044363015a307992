// Light of the lattices that media scatter along a ray.
#define MARCH_PHASE_GROUPS PHASE_GROUPS
#include "common/phase_function.glsl"
#include "gi/lpv/lookup.glsl"
#include "media/march_loop.glsl"

/// 4π times the light that a segment's media scatter against `direction`: nits, before the segment's own extinction.
vec3 latticeScattered(Segment s, vec3 position, vec3 direction) {
    LatticeLight light = latticeLight(position, vec3(0.0));
    vec3 all = fluence(light);
    vec3 towardsEye = -fluxAlong(light, direction);
    vec3 scattered = vec3(0.0);
    for (uint g = 0u; g < min(mediaHeader.phaseGroupCount, uint(MARCH_PHASE_GROUPS)); ++g) {
        float cosine = phaseMeanCosine(uint(mediaHeader.phases[g].x), mediaHeader.phases[g].y);
        scattered += s.scattering[g] * max(all + 3.0 * cosine * towardsEye, vec3(0.0));
    }
    return scattered;
}

/// Nits that reach the ray's origin from up to `distance` metres.
vec3 mediaLight(Ray ray, float distance, ivec2 pixel, uvec2 number) {
    marchedMedia = params.media;
    vec3 sum = vec3(0.0);
    March march;
    Segment s;
    if (beginMarch(ray, distance, march))
        while (nextSegment(ray, march, s))
            if (s.scatters)
                sum += exp(-march.before) * oneMinusExpOverX(s.depth) *
                       latticeScattered(s, ray.origin + ray.direction * (s.start + 0.5 * s.size), ray.direction) / (4.0 * kPi);
    return sum;
}
