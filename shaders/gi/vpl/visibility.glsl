// What virtual point lights see. A light's map names, for each direction, the triangle that it sees first; where that leaves a doubt, all triangles are asked.
#ifndef TYNDALL_GI_VPL_VISIBILITY
#define TYNDALL_GI_VPL_VISIBILITY
#include "gi/shared/visibility.glsl"
#include "gi/vpl/lights.glsl"
#include "gi/vpl/map_texel.glsl"

layout(std430) readonly buffer VplMaps { uint vplMaps[]; };

uint vplTriangleAt(uint light, ivec2 texel) { return vplMaps[vplMapStart(light) + vplTexelAt(texel)]; }

/// Does the light see the point? `direction`: unit, from the light. The four texels around the direction are looked at: what has an outline within
/// one of them is seen by another. A triangle there that lies between settles it, and so does it if the point lies behind none.
bool vplSees(uint light, vec3 position, vec3 direction, float distance) {
    if (vpl.mapSide == 0u || distance < uintBitsToFloat(vplMaps[vplNearestAt(light)])) return true;
    float side = float(vpl.mapSide);
    vec2 at = clamp((octahedralEncode(direction) * 0.5 + 0.5) * side, vec2(0.0), vec2(side - 0.5));
    ivec2 texel = ivec2(at);
    ivec2 beside = ivec2(lessThan(fract(at), vec2(0.5))) * -2 + 1;
    vec3 from = vplLights[light].position.xyz;
    float rounding = kTracedRounding * (distance + length(position));
    uint said = triangleSays(vplTriangleAt(light, texel), from, position, rounding);
    said |= triangleSays(vplTriangleAt(light, texel + ivec2(beside.x, 0)), from, position, rounding) |
            triangleSays(vplTriangleAt(light, texel + ivec2(0, beside.y)), from, position, rounding) |
            triangleSays(vplTriangleAt(light, texel + beside), from, position, rounding); // no loop: llvmpipe counts its rounds
    return said == 0u || (said == kDoubtful && !triangleBetween(from, position));
}

#endif
