// From one ray for a square of pixels to every pixel, for light that media scatter. Who includes this defines
//
//     vec4 mediaLight(Ray ray, float distance, uvec2 pixel)
//
// for pixels that no ray near them fits; w: 1, or 0 where another pass is to fill the pixel.
#include "media/nearest_rays.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std140) uniform Params { MarchParams params; };
uniform sampler2D depth;
uniform sampler2D transmittance;
uniform sampler2D coarseInScatter;
layout(rgba32f) writeonly uniform image2D inScatter;

float distanceAt(ivec2 pixel) { return rayDistanceFromDepth(vec2(pixel) + 0.5, texelFetch(depth, pixel, 0).r); }

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(inScatter)))) return;
    float distance = distanceAt(pixel);
    vec3 through = texelFetch(transmittance, pixel, 0).rgb;
    float total = 0.0;
    float best = 0.0;
    vec3 sum = vec3(0.0);
    vec3 opacity = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        NearRay near = nearRay(i, pixel, params, textureSize(coarseInScatter, 0), textureSize(depth, 0));
        vec3 rayThrough = texelFetch(transmittance, near.pixel, 0).rgb;
        float like = likeness(distance, through, distanceAt(near.pixel), rayThrough, params);
        float weight = rayWeight(like, near.share);
        best = max(best, like);
        total += weight;
        sum += weight * texelFetch(coarseInScatter, near.coarse, 0).rgb;
        opacity += weight * (1.0 - rayThrough);
    }
    sum = scaledByOpacity(sum / total, opacity / total, 1.0 - through);
    vec4 light = vec4(sum, 1.0);
    if ((params.flags & kMarchRefine) != 0u && best < params.refineWeight) light = mediaLight(cameraRay(vec2(pixel) + 0.5), distance, uvec2(pixel));
    imageStore(inScatter, pixel, light);
}
