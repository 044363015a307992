// A square around a surfel's disk.
#include "common/view.glsl"
#include "lighting/brdf.glsl"
#include "shared/surfels.h"

layout(std430) readonly buffer LitSurfels { LitSurfel lit[]; };

out vec2 onDisk; // 1: the disk's edge
out vec3 position;
flat out uint surfelNumber;

void main() {
    surfelNumber = uint(gl_VertexID) / 6u;
    uint corner = uint(gl_VertexID) % 6u;
    LitSurfel s = lit[surfelNumber];
    onDisk = 2.0 * vec2(corner == 1u || corner >= 4u, corner == 2u || corner == 3u || corner == 5u) - 1.0;
    mat3 frame = frameAround(s.normal.xyz);
    position = s.position.xyz + sqrt(s.position.w / kBrdfPi) * (frame[0] * onDisk.x + frame[1] * onDisk.y);
    gl_Position = view.clipFromRender * vec4(position, 1.0);
}
