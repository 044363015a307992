// The same surfels without the tessellator: an invocation for each patch, its points ring by ring.
#include "gi/surfels/patch.glsl"

layout(local_size_x = 64) in;
layout(std430) writeonly buffer Surfels { Surfel surfels[]; };

void main() {
    if (gl_GlobalInvocationID.x >= set.patchCount) return;
    uint number = set.firstPatch + gl_GlobalInvocationID.x;
    uint level = patches[number].level;
    uint next = patches[number].firstSurfel;
    for (uint ring = 0u; 2u * ring <= level; ++ring) {
        uint steps = level - 2u * ring;
        float low = 2.0 * float(ring) / (3.0 * float(level)); // barycentric coordinate of the ring's edges
        float high = 1.0 - 2.0 * low;
        for (uint edge = 0u; edge < (steps == 0u ? 1u : 3u); ++edge)
            for (uint i = 0u; i < max(steps, 1u); ++i) {
                float along = mix(high, low, steps == 0u ? 0.0 : float(i) / float(steps));
                vec3 place = vec3(low);
                place[edge] = along;
                place[(edge + 1u) % 3u] = low + high - along;
                surfels[next++] = surfelOf(number, place);
            }
    }
}
