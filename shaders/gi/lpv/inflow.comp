// Light that enters a lattice from the coarser one around it, as a source of the cells along its border.
#include "gi/lpv/lattice.glsl"
#include "gi/lpv/outer.glsl"

layout(local_size_x = kLpvBlockX, local_size_y = kLpvBlockY, local_size_z = kLpvBlockZ) in;

layout(std430) readonly buffer LpvOwnLinks { uint ownLinks[]; };
layout(std430) buffer LpvSources { vec4 sources[]; };

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (!isInside(at) || (all(greaterThan(at, ivec3(0))) && all(lessThan(at, params.grid.size.xyz - 1)))) return;
    uint cells = cellCount();
    uint self = cellIndex(at);
    uint blocked = ownLinks[kLpvBlocked * cells + self];
    vec4 red = vec4(0.0);
    vec4 green = vec4(0.0);
    vec4 blue = vec4(0.0);
    for (uint j = 0u; j < kLpvDirections; ++j) {
        ivec3 from = at - params.directions[j].offset.xyz;
        if (isInside(from) || (blocked & (1u << (25u - j))) != 0u) continue;
        vec3 sent = outerFluxThrough(outerCell(cellMiddle(from)), params.grid.lowest.w, j);
        vec4 arrival = vec4(params.directions[j].unit.xyz, 1.0);
        red += sent.r * arrival;
        green += sent.g * arrival;
        blue += sent.b * arrival;
    }
    sources[kLpvEntering * cells + self] += red;
    sources[(kLpvEntering + 1u) * cells + self] += green;
    sources[(kLpvEntering + 2u) * cells + self] += blue;
}
