// One step of the printed scheme, and the sum over all steps. Blockers are the blocked links of the lattice: they absorb.
#include "gi/lpv/printed.glsl"

layout(local_size_x = kLpvBlockX, local_size_y = kLpvBlockY, local_size_z = kLpvBlockZ) in;

layout(std430) writeonly buffer LpvNext { vec4 next[]; };
layout(std430) buffer LpvSum { vec4 sum[]; };

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (!isInside(at)) return;
    uint cells = cellCount();
    uint self = cellIndex(at);
    uint blocked = links[kLpvBlocked * cells + self];
    vec4 result[3] = vec4[3](vec4(0.0), vec4(0.0), vec4(0.0));
    for (uint j = 0u; j < kLpvDirections; ++j) {
        ivec3 from = at - params.directions[j].offset.xyz;
        if ((blocked & (1u << (25u - j))) != 0u || !wrapCell(from)) continue;
        vec3 power = printedFlux(cellIndex(from), cells, j);
        for (uint c = 0u; c < 3u; ++c) result[c] += power[c] * transfer.harmonics[j];
    }
    for (uint c = 0u; c < 3u; ++c) {
        next[c * cells + self] = result[c];
        sum[c * cells + self] += result[c];
    }
}
