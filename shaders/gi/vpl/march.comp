// Light of virtual point lights that media scatter to the eye: one ray for each pixel, or for squares of them; or for pixels that upsampling left open.
// COMPENSATION: kVplClamped, kVplClosedForm or kVplTraced.
#include "gi/vpl/scattered_light.glsl"
#include "media/nearest_rays.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std140) uniform Params { MarchParams params; };
uniform sampler2D depth;
uniform sampler2D gathered; // with kMarchFill: what is there already; w: 0 where nothing is
layout(std430) readonly buffer VplNear { vec4 vplNear[]; }; // nits that neither gathering nor its step near by brings, by square
layout(rgba32f) writeonly uniform image2D inScatter;

/// Of the square that a pixel lies in.
vec3 nearLightOf(ivec2 pixel, ivec2 size) {
    if (vpl.nearLight == 0u) return vec3(0.0);
    ivec2 square = pixel / int(params.factor);
    int across = (size.x + int(params.factor) - 1) / int(params.factor);
    return vplNear[square.y * across + square.x].rgb;
}

void main() {
    ivec2 ray = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(ray, imageSize(inScatter)))) return;
    bool fills = (params.flags & kMarchFill) != 0u;
    vec4 light = fills ? texelFetch(gathered, ray, 0) : vec4(0.0);
    if (light.w == 0.0) {
        ivec2 pixel = fills ? ray : marchedPixel(ray, params, textureSize(depth, 0));
        vec2 centre = vec2(pixel) + 0.5;
        float distance = rayDistanceFromDepth(centre, texelFetch(depth, pixel, 0).r);
        light = vec4(lightScatteredAlong(cameraRay(centre), distance, uvec2(ray)) + nearLightOf(pixel, textureSize(depth, 0)), 1.0);
    }
    imageStore(inScatter, ray, light);
}
