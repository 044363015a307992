// Light of the lattices that media scatter along a ray.
#define MARCH_PHASE_GROUPS PHASE_GROUPS
#include "common/phase_function.glsl"
#include "gi/lpv/lookup.glsl"
#include "media/march_segment.glsl"

const int kMostSegments = 16384; // ends a march whose coordinates have lost their meaning

/// Nits that reach the ray's origin from up to `distance` metres.
vec3 lightScatteredAlong(Ray ray, float distance) {
    vec3 sum = vec3(0.0);
    float t;
    float end;
    if (mediaExtent(ray, distance, t, end)) {
        vec3 before = vec3(0.0);
        float opaque = -log(max(mediaHeader.minTransmittance, 1e-30));
        for (int i = 0; i < kMostSegments && t < end && minimumOf(before) < opaque; ++i) {
            Segment s = marchSegment(ray, t, end);
            t = s.start + s.size;
            if (s.scatters) {
                LatticeLight light = latticeLight(ray.origin + ray.direction * (s.start + 0.5 * s.size), vec3(0.0));
                vec3 all = fluence(light);
                vec3 towardsEye = -fluxAlong(light, ray.direction);
                vec3 scattered = vec3(0.0);
                for (uint g = 0u; g < min(mediaHeader.phaseGroupCount, uint(MARCH_PHASE_GROUPS)); ++g) {
                    float cosine = phaseMeanCosine(uint(mediaHeader.phases[g].x), mediaHeader.phases[g].y);
                    scattered += s.scattering[g] * max(all + 3.0 * cosine * towardsEye, vec3(0.0));
                }
                sum += exp(-before) * oneMinusExpOverX(s.depth) * scattered / (4.0 * kPi);
            }
            before = min(before + s.depth, vec3(kOpaque));
        }
    }
    return sum;
}
