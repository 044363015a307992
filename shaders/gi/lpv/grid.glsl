// Cells of a lattice: positions and numbers.
#ifndef TYNDALL_GI_LPV_GRID
#define TYNDALL_GI_LPV_GRID
#include "common/math.glsl"
#include "shared/lpv.h"

uint cellCount(LpvGrid grid) { return uint(grid.size.x * grid.size.y * grid.size.z); }
uint cellIndex(LpvGrid grid, ivec3 at) { return uint(at.x + grid.size.x * (at.y + grid.size.y * at.z)); }

/// A point of render space in cells from the lattice's corner.
vec3 latticePosition(LpvGrid grid, vec3 position) { return (position - grid.lowest.xyz) / grid.lowest.w; }

#endif
