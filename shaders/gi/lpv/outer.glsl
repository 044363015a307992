// The next coarser lattice, for passes of a finer one inside it.
#ifndef TYNDALL_GI_LPV_OUTER
#define TYNDALL_GI_LPV_OUTER
#include "gi/lpv/sides.glsl" // of the coarser lattice

layout(std140) uniform Outer { LpvGrid outer; };
layout(std430) readonly buffer LpvOuterFlux { float outerFlux[]; };

/// The cell of the coarser lattice around `position` (render space) and on its side of surfaces; -1 outside of it.
int outerCell(vec3 position) {
    vec3 place = latticePosition(outer, position);
    if (any(lessThan(place, vec3(0.0))) || any(greaterThanEqual(place, vec3(outer.size.xyz)))) return -1;
    return int(cellIndex(outer, cellOnSide(outer, place)));
}

/// Power that the coarser lattice sends there in direction j through a square of the finer one's cells, `edge` metres long.
vec3 outerFluxThrough(int cell, float edge, uint j) {
    if (cell < 0) return vec3(0.0);
    uint cells = cellCount(outer);
    uint from = uint(cell);
    vec3 sent = vec3(outerFlux[(3u * j) * cells + from], outerFlux[(3u * j + 1u) * cells + from], outerFlux[(3u * j + 2u) * cells + from]);
    float size = edge / outer.lowest.w;
    return sent * (size * size);
}

#endif
