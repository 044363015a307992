// A virtual light's visibility map, in a buffer of maps: an octahedron of mapSide² triangles' numbers, and behind them, as the bits of a float, the
// distance in metres up to which the light sees no surface.
#ifndef TYNDALL_GI_VPL_MAP_TEXEL
#define TYNDALL_GI_VPL_MAP_TEXEL
#include "gi/vpl/params.glsl"

uint vplMapStart(uint light) { return light * (vpl.mapSide * vpl.mapSide + 1u); }
uint vplNearestAt(uint light) { return vplMapStart(light) + vpl.mapSide * vpl.mapSide; }

/// Position within a map. Across an edge of the square an octahedral map continues turned about the edge's centre.
uint vplTexelAt(ivec2 texel) {
    int side = int(vpl.mapSide);
    if (texel.x < 0 || texel.x >= side) texel = ivec2(texel.x < 0 ? -1 - texel.x : 2 * side - 1 - texel.x, side - 1 - texel.y);
    if (texel.y < 0 || texel.y >= side) texel = ivec2(side - 1 - texel.x, texel.y < 0 ? -1 - texel.y : 2 * side - 1 - texel.y);
    return uint(texel.y) * vpl.mapSide + uint(texel.x);
}

#endif
