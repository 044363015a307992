// The initial light of a lattice: that of the coarser lattice around it. The steps that follow need not carry light across
// the scene.
#include "gi/lpv/lattice.glsl"
#include "gi/lpv/outer.glsl"

layout(local_size_x = kLpvBlockX, local_size_y = kLpvBlockY, local_size_z = kLpvBlockZ) in;

layout(std430) writeonly buffer LpvFlux { float flux[]; };

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (!isInside(at)) return;
    uint cells = cellCount();
    uint self = cellIndex(at);
    int from = outerCell(cellMiddle(at));
    for (uint j = 0u; j < kLpvDirections; ++j) {
        vec3 sent = outerFluxThrough(from, params.grid.lowest.w, j);
        for (uint c = 0u; c < 3u; ++c) flux[(3u * j + c) * cells + self] = sent[c];
    }
}
