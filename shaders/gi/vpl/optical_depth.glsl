// Optical depth between a virtual light and a point: of grids from the light's own map, by direction and distance;
// of other media in closed form.
#ifndef TYNDALL_GI_VPL_OPTICAL_DEPTH
#define TYNDALL_GI_VPL_OPTICAL_DEPTH
#include "gi/vpl/lights.glsl"
#include "gi/vpl/depth_map.glsl"
#include "media/optical_depth.glsl"

vec3 vplDepthAt(uint column, uint step) {
    if (step == 0u) return vec3(0.0);
    uvec2 halves = vplDepths[column * kVplDepthSteps + step - 1u];
    return vec3(unpackHalf2x16(halves.x), unpackHalf2x16(halves.y).x);
}

/// `direction`: unit, from the light.
vec3 vplGridDepth(uint light, vec3 direction, float distance) {
    float side = float(vpl.depthSide);
    vec2 range = vplDepthRange(vplLights[light].position.xyz, vpl);
    float part;
    uint step = vplDepthStep(clamp((distance - range.x) / (range.y - range.x), 0.0, 1.0), part);
    vec2 at = clamp(vplDepthPlace(vplLights[light].position.xyz, direction, vpl) * side - 0.5, vec2(0.0), vec2(side - 1.0));
    uvec2 low = uvec2(at);
    uvec2 high = min(low + 1u, uvec2(vpl.depthSide - 1u));
    vec2 f = at - vec2(low);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        uvec2 texel = uvec2((i & 1) == 0 ? low.x : high.x, (i & 2) == 0 ? low.y : high.y);
        float share = ((i & 1) == 0 ? 1.0 - f.x : f.x) * ((i & 2) == 0 ? 1.0 - f.y : f.y);
        uint column = (light * vpl.depthSide + texel.y) * vpl.depthSide + texel.x;
        sum += share * mix(vplDepthAt(column, step), vplDepthAt(column, step + 1u), part);
    }
    return sum;
}

/// `towards`: unit, from the point to the light.
vec3 vplOpticalDepth(uint light, vec3 position, vec3 towards, float distance) {
    if (!kHasGrids || vpl.depthSide == 0u) return opticalDepthAlong(position, towards, distance);
    return analyticOpticalDepth(position, towards, 0.0, distance) + vplGridDepth(light, -towards, distance);
}

#endif
