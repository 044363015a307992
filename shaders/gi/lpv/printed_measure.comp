// Energy balance of a step of the printed scheme: sums over workgroups, in the order of measure.comp. Power that is neither absorbed nor blocked nor
// escaped nor stored after the step is what the scheme loses (or adds).
#include "gi/lpv/printed.glsl" // LpvRadiance: before the step
#define LEDGER 1
#include "gi/lpv/workgroup_sums.glsl"

layout(local_size_x = kLpvBlockX, local_size_y = kLpvBlockY, local_size_z = kLpvBlockZ) in;

layout(std430) readonly buffer LpvNext { vec4 next[]; }; // after the step

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    float values[kSums];
    for (uint i = 0u; i < kSums; ++i) values[i] = 0.0;
    if (isInside(at)) {
        uint cells = cellCount();
        uint self = cellIndex(at);
        vec3 depth = medium[kLpvTrueDepth * cells + self].rgb * transfer.meanLength;
        vec3 albedo = medium[kLpvTrueAlbedo * cells + self].rgb;
        for (uint c = 0u; c < 3u; ++c) {
            float before = kLpvOne * radianceOf(self, cells, c).x;
            float after = kLpvOne * next[c * cells + self].x;
            values[0] += abs(after - before);
            values[1] += after;
            values[2] += before;
            values[4] += depth[c] * (1.0 - albedo[c]) * before;
        }
        uint blocked = links[kLpvBlocked * cells + self];
        for (uint j = 0u; j < kLpvDirections; ++j) {
            ivec3 to = at + params.directions[j].offset.xyz;
            bool atSurface = (blocked & (1u << j)) != 0u;
            if (!atSurface && wrapCell(to)) continue;
            float power = dot(printedFlux(self, cells, j), vec3(kLpvOne * transfer.harmonics[j].x));
            values[atSurface ? 6 : 5] += power;
        }
    }
    leaveSums(values);
}
