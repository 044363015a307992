// The propagation scheme as Billeter, Sintorn and Assarsson 2012 print it (equation 3): radiance in two bands of harmonics (1, y, z, x) of three
// channels in each cell, extinction linear in the optical depth. For comparison: docs/measured/lpv-laws.md has what it loses.
#ifndef TYNDALL_GI_LPV_PRINTED
#define TYNDALL_GI_LPV_PRINTED
#include "gi/lpv/lattice.glsl"

layout(std140) uniform Transfer { LpvTransfer transfer; };
layout(std430) readonly buffer LpvMedium { vec4 medium[]; };
layout(std430) readonly buffer LpvLinks { uint links[]; };
layout(std430) readonly buffer LpvRadiance { vec4 radiance[]; }; // plane c: harmonics of channel c

vec4 radianceOf(uint cell, uint cells, uint c) { return radiance[c * cells + cell]; }

/// Powers of the three channels that a cell sends in direction j, each over <Γ_j|1>: what the neighbour gets is this times Γ_j.
vec3 printedFlux(uint cell, uint cells, uint j) {
    vec4 depth = medium[kLpvTrueDepth * cells + cell] * transfer.meanLength;
    vec4 albedo = medium[kLpvTrueAlbedo * cells + cell];
    vec3 result;
    for (uint c = 0u; c < 3u; ++c) {
        vec4 l = radianceOf(cell, cells, c);
        result[c] = (1.0 - depth[c]) * dot(l, transfer.harmonics[j]) + transfer.share[j / 4u][j % 4u] * depth[c] * albedo[c] * kLpvOne * l.x;
    }
    return result;
}

#endif
