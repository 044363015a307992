// A quad around the rays that a shell around a surfel can touch, in one sub-buffer of a level.
#include "gi/surfels/splat.glsl"

layout(std430) readonly buffer SplatList { uint splatList[]; };

flat out uint surfelNumber;
flat out uint subBuffer;
flat out vec2 shell; // inner and outer radius, metres

void main() {
    surfelNumber = splatList[splat.level * splat.surfelCount + uint(gl_VertexID) / 6u];
    uint corner = uint(gl_VertexID) % 6u;
    SplatQuad quad;
    splatQuad(surfelNumber, splat.level, quad);
    shell = quad.shell;
    subBuffer = quad.subBuffer;
    ivec2 at = quad.first;
    if (corner == 1u || corner >= 4u) at.x = quad.end.x;
    if (corner == 2u || corner == 3u || corner == 5u) at.y = quad.end.y;
    at += subBufferCorner(splat.level, subBuffer, splat.size);
    gl_Position = vec4(vec2(at) / vec2(splat.textureSize) * 2.0 - 1.0, 0.0, 1.0);
}
