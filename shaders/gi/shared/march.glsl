// Light that media scatter to the eye: one ray for each pixel, or for squares of them. With MARCH_FILLS a third pass, after gi/shared/upsample.glsl, marches
// the pixels that no ray fits. With MARCH_TURNS mediaLight() may look at what it has returned before. Passes: plugin/reduced_march.h. Whoever includes this defines
// mediaLight().
#include "common/view.glsl"
#include "media/nearest_rays.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std140) uniform Params { MarchParams params; };
uniform sampler2D depth;
#ifdef MARCH_FILLS
uniform sampler2D before; // with kMarchFill: the upsampled image; w: 0 where a pixel is open
#endif
#ifdef MARCH_TURNS
layout(rgba32f) uniform image2D inScatter; // from turn to turn light comes to it
#else
layout(rgba32f) writeonly uniform image2D inScatter;
#endif

/// Nits that reach the ray's origin from up to `distance` metres. `pixel`: of the ray; `number`: of the ray among all marched rays.
vec3 mediaLight(Ray ray, float distance, ivec2 pixel, uvec2 number);

void main() {
    ivec2 number = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(number, imageSize(inScatter)))) return;
    ivec2 pixel = marchedPixel(number, params, textureSize(depth, 0));
    vec4 light = vec4(0.0);
#ifdef MARCH_FILLS
    if ((params.flags & kMarchFill) != 0u) {
        pixel = number;
        light = texelFetch(before, number, 0);
    }
#endif
    if (light.w == 0.0) {
        vec2 centre = vec2(pixel) + 0.5;
        float distance = rayDistanceFromDepth(centre, texelFetch(depth, pixel, 0).r);
        light = vec4(mediaLight(cameraRay(centre), distance, pixel, uvec2(number)), 1.0);
    }
    imageStore(inScatter, number, light);
}
