// Light of virtual point lights that media scatter to the eye: one ray for each pixel, or for squares of them.
// COMPENSATION: kVplClamped, kVplClosedForm or kVplTraced.
#include "gi/vpl/scattered_light.glsl"
#include "media/nearest_rays.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std140) uniform Params { MarchParams params; };
uniform sampler2D depth;
layout(rgba32f) writeonly uniform image2D inScatter;

void main() {
    ivec2 ray = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(ray, imageSize(inScatter)))) return;
    ivec2 pixel = marchedPixel(ray, params, textureSize(depth, 0));
    vec2 centre = vec2(pixel) + 0.5;
    float distance = rayDistanceFromDepth(centre, texelFetch(depth, pixel, 0).r);
    imageStore(inScatter, ray, vec4(lightScatteredAlong(cameraRay(centre), distance, uvec2(ray)), 1.0));
}
