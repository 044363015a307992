// From one marched ray for 2×2 or 4×4 pixels to every pixel. Of the four nearest rays those count that end at about the same
// distance and pass through about the same optical depth, because what media send changes with both. A pixel that no ray fits
// is marched again on its own (thin posts, silhouettes).
#define MARCH_PHASE_GROUPS PHASE_GROUPS
#include "media/march.glsl"

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

/// How well a coarse ray stands for a pixel: 1 for a perfect fit.
float likeness(float distance, vec3 through, float coarseDistance, vec3 coarseThrough) {
    float depthError = abs(distance - coarseDistance) / max(min(distance, coarseDistance), 1e-20);
    float throughError = maximumOf(abs(through - coarseThrough));
    // Where next to nothing is left of what lies behind, the distance does not matter.
    float seen = maximumOf(max(through, coarseThrough));
    return 1.0 / (1.0 + seen * depthError / params.depthTolerance) / (1.0 + throughError / params.transmittanceTolerance);
}

// Known when compiling: what is not wanted costs nothing.
const uint kWanted = (IN_SCATTER > 0 ? kMarchInScatter : 0u) | (EMISSION == 1 ? kMarchEmission : 0u);

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(transmittance)))) return;
    Ray ray = cameraRay(vec2(pixel) + 0.5);
    float distance = distanceAt(pixel);
    vec3 through = exp(-opticalDepthAlong(ray.origin, ray.direction, distance));
    int factor = int(params.factor);
    ivec2 coarseLast = textureSize(coarseTransmittance, 0) - 1;
    vec2 at = (vec2(pixel) - vec2(factor / 2)) / float(factor);
    ivec2 corner = ivec2(floor(at));
    vec2 f = at - vec2(corner);
    float total = 0.0;
    float best = 0.0;
    vec3 inScatterSum = vec3(0.0);
    vec3 emissionSum = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 offset = ivec2(i & 1, i >> 1);
        ivec2 coarse = clamp(corner + offset, ivec2(0), coarseLast);
        ivec2 full = min(coarse * factor + factor / 2, textureSize(depth, 0) - 1);
        float like = likeness(distance, through, distanceAt(full), texelFetch(coarseTransmittance, coarse, 0).rgb);
        vec2 share = mix(1.0 - f, f, vec2(offset));
        // A floor, so that a good fit on the far side still outweighs a bad one near by.
        float weight = like * like * (share.x * share.y + 1e-3);
        best = max(best, like);
        total += weight;
#if IN_SCATTER
        inScatterSum += weight * texelFetch(coarseInScatter, coarse, 0).rgb;
#endif
#if EMISSION
        emissionSum += weight * texelFetch(coarseEmission, coarse, 0).rgb;
#endif
    }
    inScatterSum /= total;
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
