// From one marched ray for 2×2 or 4×4 pixels to every pixel. Of the four nearest rays those count that end at about the same
// distance and pass through about the same optical depth, because what media send changes with both. A pixel that no ray fits
// is marched again on its own (thin posts, silhouettes).
#define MARCH_PHASE_GROUPS PHASE_GROUPS
#include "media/march.glsl"
#include "media/nearest_rays.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std140) uniform Params { MarchParams params; };
uniform sampler2D depth;
uniform sampler2D coarseTransmittance;
layout(rgba32f) uniform writeonly image2D transmittance;
#if IN_SCATTER
uniform sampler2D coarseInScatter;
layout(rgba32f) uniform writeonly image2D inScatter;
#endif
#if EMISSION
uniform sampler2D coarseEmission;
layout(rgba32f) uniform writeonly image2D emission;
#endif

float distanceAt(ivec2 pixel) {
    return rayDistanceFromDepth(vec2(pixel) + 0.5, texelFetch(depth, pixel, 0).r);
}

// Known when compiling: what is not wanted costs nothing.
const uint kWanted = (IN_SCATTER > 0 ? kMarchInScatter : 0u) | (EMISSION == 1 ? kMarchEmission : 0u);

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(transmittance)))) return;
    Ray ray = cameraRay(vec2(pixel) + 0.5);
    float distance = distanceAt(pixel);
    vec3 through = exp(-opticalDepthAlong(ray.origin, ray.direction, distance));
    float total = 0.0;
    float best = 0.0;
    vec3 opacity = vec3(0.0);
    vec3 inScatterSum = vec3(0.0);
    vec3 emissionSum = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        NearRay near = nearRay(i, pixel, params, textureSize(coarseTransmittance, 0), textureSize(depth, 0));
        vec3 rayThrough = texelFetch(coarseTransmittance, near.coarse, 0).rgb;
        float like = likeness(distance, through, distanceAt(near.pixel), rayThrough, params);
        float weight = rayWeight(like, near.share);
        best = max(best, like);
        total += weight;
        opacity += weight * (1.0 - rayThrough);
#if IN_SCATTER
        inScatterSum += weight * texelFetch(coarseInScatter, near.coarse, 0).rgb;
#endif
#if EMISSION
        emissionSum += weight * texelFetch(coarseEmission, near.coarse, 0).rgb;
#endif
    }
    inScatterSum = scaledByOpacity(inScatterSum / total, opacity / total, 1.0 - through);
    emissionSum /= total;
    if ((params.flags & kMarchRefine) != 0u && best < params.refineWeight) {
        MarchResult march = marchMedia(ray, distance, kWanted, params.lightCount, uvec2(pixel));
        through = exp(-march.opticalDepth);
        inScatterSum = march.inScatter;
        emissionSum = march.emission;
    }
    imageStore(transmittance, pixel, vec4(through, 1.0));
#if IN_SCATTER
    imageStore(inScatter, pixel, vec4(inScatterSum, 1.0));
#endif
#if EMISSION
    imageStore(emission, pixel, vec4(emissionSum, 1.0));
#endif
}
