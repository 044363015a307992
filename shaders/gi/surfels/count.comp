// How much is splatted, for the report: one workgroup.
#include "shared/surfels.h"

layout(local_size_x = 256) in;
layout(std140) uniform Splat { SurfelSplatParams splat; };
layout(std430) readonly buffer LitSurfels { LitSurfel lit[]; };
layout(std430) readonly buffer Draws { uvec4 draws[]; };
layout(std430) buffer Counts { float counts[]; };
uniform sampler2DArray levels;

shared uvec2 sums[256]; // lit surfels, pairs of a surfel and a ray

void main() {
    uint thread = gl_LocalInvocationID.x;
    uvec2 sum = uvec2(0u);
    for (uint i = thread; i < splat.surfelCount; i += 256u) sum.x += uint(lit[i].position.w * lit[i].normal.w > 0.0);
    ivec2 size = splat.textureSize;
    for (uint level = 0u; level < splat.levels; ++level)
        for (uint i = thread; i < uint(size.x * size.y); i += 256u) sum.y += uint(texelFetch(levels, ivec3(int(i) % size.x, int(i) / size.x, int(level)), 0).w);
    sums[thread] = sum;
    for (uint rest = 128u; rest > 0u; rest >>= 1u) {
        barrier();
        if (thread < rest) sums[thread] += sums[thread + rest];
    }
    if (thread != 0u) return;
    uint quads = 0u;
    for (uint level = 0u; level < splat.levels; ++level) quads += draws[level].x / 6u;
    counts[0] = float(sums[0].x);
    counts[1] = float(quads);
    counts[2] = float(sums[0].y);
}
