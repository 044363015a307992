// How bright surfels are on average: each watt with the radiance at which it leaves. One workgroup, in a fixed order, so that the same surfels have the same bits.
#include "shared/surfels.h"

layout(local_size_x = 256) in;
layout(std140) uniform Lighting { SurfelLightParams lighting; };
layout(std430) readonly buffer LitSurfels { LitSurfel lit[]; };
layout(std430) buffer Brightness { SurfelBrightness brightness; };

shared vec2 sums[256];

void main() {
    uint thread = gl_LocalInvocationID.x;
    vec2 sum = vec2(0.0);
    for (uint i = thread; i < lighting.surfelCount; i += 256u) {
        float area = lit[i].position.w;
        float radiance = lit[i].normal.w;
        sum += area * radiance * vec2(radiance, 1.0);
    }
    sums[thread] = sum;
    for (uint rest = 128u; rest > 0u; rest >>= 1u) {
        barrier();
        if (thread < rest) sums[thread] += sums[thread + rest];
    }
    if (thread == 0u) brightness = SurfelBrightness(sums[0].x, sums[0].y, 0.0, 0.0);
}
