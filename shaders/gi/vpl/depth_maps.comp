// The grids' optical depth around each virtual light.
#include "common/octahedral.glsl"
#include "media/optical_depth.glsl"
#include "shared/vpl.h"
#include "gi/vpl/depth_map.glsl"

layout(local_size_x = 64) in;

layout(std140) uniform Vpl { VplParams vpl; };
layout(std430) readonly buffer VplLights { VplData vplLights[]; };
layout(std430) writeonly buffer VplDepths { uvec2 vplDepths[]; };

void main() {
    uint texel = gl_GlobalInvocationID.x;
    uint light = gl_GlobalInvocationID.y;
    if (texel >= vpl.depthSide * vpl.depthSide || light >= vpl.lightCount) return;
    vec3 position = vplLights[light].position.xyz;
    vec2 place = (vec2(texel % vpl.depthSide, texel / vpl.depthSide) + 0.5) / float(vpl.depthSide);
    vec3 direction = vplDepthDirection(position, place, vpl);
    vec2 range = vplDepthRange(position, vpl);
    vec3 depth = vec3(0.0);
    uint first = (light * vpl.depthSide * vpl.depthSide + texel) * kVplDepthSteps;
    for (uint step = 0u; step < kVplDepthSteps; ++step) {
        vec2 part = vec2(vplDepthStart(step), vplDepthStart(step + 1u));
        vec2 ends = mix(range.xx, range.yy, part);
        depth += gridOpticalDepth(position, direction, ends.x, ends.y);
        vec3 stored = min(depth, vec3(6e4)); // of half precision
        vplDepths[first + step] = uvec2(packHalf2x16(stored.rg), packHalf2x16(vec2(stored.b, 0.0)));
    }
}
