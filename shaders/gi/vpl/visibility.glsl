// Visibility of virtual point lights. A light's map has the first triangle in each direction; where that does not decide, all triangles are tested.
#ifndef TYNDALL_GI_VPL_VISIBILITY
#define TYNDALL_GI_VPL_VISIBILITY
#include "gi/shared/visibility.glsl"
#include "gi/vpl/lights.glsl"
#include "gi/vpl/map_texel.glsl"

layout(std430) readonly buffer VplMaps { uint vplMaps[]; };

uint vplTriangleAt(uint light, ivec2 texel) { return vplMaps[vplMapStart(light) + vplTexelAt(texel)]; }

/// Is the point visible from the light? `direction`: unit, from the light. The four texels around the direction are tested, because outlines end within
/// texels. A triangle in one of them that lies between blocks the point; if the point is behind the plane of none, it is visible.
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
