// From one marched ray for 2×2 or 4×4 pixels to every pixel. Of the four nearest rays those count that end at about the same distance and pass through about
// the same optical depth, because what media send changes with both.
#ifndef TYNDALL_MEDIA_SPREAD_RAYS
#define TYNDALL_MEDIA_SPREAD_RAYS
#include "common/math.glsl"
#include "common/view.glsl"
#include "media/nearest_rays.glsl"

layout(std140) uniform Params { MarchParams params; };
uniform sampler2D depth;

/// What gets through to where a marched ray ends: whoever includes this defines it.
vec3 rayThrough(NearRay ray);

/// The rays around a pixel.
struct RaysAround {
    ivec2 coarse[4]; // where they are among the marched ones
    float weight[4];
    float total;  // of the weights
    float best;   // likeness of the one that fits best, 0..1
    vec3 opacity; // mean
    vec3 own;     // of the pixel
};

float distanceAt(ivec2 pixel) { return rayDistanceFromDepth(vec2(pixel) + 0.5, texelFetch(depth, pixel, 0).r); }

/// `distance`: to the pixel's surface; `through`: what gets there. `coarseSize`: of the picture of marched rays.
RaysAround raysAround(ivec2 pixel, float distance, vec3 through, ivec2 coarseSize) {
    RaysAround rays;
    rays.total = 0.0;
    rays.best = 0.0;
    vec3 opacity = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        NearRay near = nearRay(i, pixel, params, coarseSize, textureSize(depth, 0));
        vec3 nearThrough = rayThrough(near);
        float like = likeness(distance, through, distanceAt(near.pixel), nearThrough, params);
        float weight = rayWeight(like, near.share);
        rays.coarse[i] = near.coarse;
        rays.weight[i] = weight;
        rays.best = max(rays.best, like);
        rays.total += weight;
        opacity += weight * (1.0 - nearThrough);
    }
    rays.opacity = opacity / rays.total;
    rays.own = 1.0 - through;
    return rays;
}

/// A pixel that no ray fits is to be marched on its own (thin posts, silhouettes).
bool isAlone(RaysAround rays) { return (params.flags & kMarchRefine) != 0u && rays.best < params.refineWeight; }

/// Weighted mean of what the rays found.
vec3 spread(RaysAround rays, sampler2D coarse) {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 4; ++i) sum += rays.weight[i] * texelFetch(coarse, rays.coarse[i], 0).rgb;
    return sum / rays.total;
}

/// The same of light that media scatter.
vec3 spreadScattered(RaysAround rays, sampler2D coarse) { return scaledByOpacity(spread(rays, coarse), rays.opacity, rays.own); }

#endif
