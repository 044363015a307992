// Where one ray is marched for 2×2 or 4×4 pixels: which ray that is, and how far each of the four nearest ones stands for a pixel.
#ifndef TYNDALL_MEDIA_NEAREST_RAYS
#define TYNDALL_MEDIA_NEAREST_RAYS
#include "common/math.glsl"
#include "shared/march.h"

/// The pixel whose ray is marched for a square of pixels: its depth is its own, not a mixture.
ivec2 marchedPixel(ivec2 coarse, MarchParams params, ivec2 size) {
    return min(coarse * int(params.factor) + int(params.factor) / 2, size - 1);
}

/// One of the four marched rays nearest to a pixel.
struct NearRay {
    ivec2 coarse; // where it is among the marched ones
    ivec2 pixel;  // whose ray it is
    float share;  // bilinear
};

NearRay nearRay(int i, ivec2 pixel, MarchParams params, ivec2 coarseSize, ivec2 size) {
    vec2 at = (vec2(pixel) - vec2(int(params.factor) / 2)) / float(params.factor);
    vec2 corner = floor(at);
    ivec2 offset = ivec2(i & 1, i >> 1);
    vec2 share = mix(1.0 - (at - corner), at - corner, vec2(offset));
    NearRay ray;
    ray.coarse = clamp(ivec2(corner) + offset, ivec2(0), coarseSize - 1);
    ray.pixel = marchedPixel(ray.coarse, params, size);
    ray.share = share.x * share.y;
    return ray;
}

/// How well a ray stands for a pixel, from where each ends and what gets through to there: 1 for a perfect fit.
float likeness(float distance, vec3 through, float rayDistance, vec3 rayThrough, MarchParams params) {
    float depthError = abs(distance - rayDistance) / max(min(distance, rayDistance), 1e-20);
    float throughError = maximumOf(abs(through - rayThrough));
    // Where next to nothing is left of what lies behind, the distance does not matter.
    float seen = maximumOf(max(through, rayThrough));
    return 1.0 / (1.0 + seen * depthError / params.depthTolerance) / (1.0 + throughError / params.transmittanceTolerance);
}

/// With a floor under the share, so that a good fit on the far side still outweighs a bad one near by.
float rayWeight(float like, float share) {
    like = max(like, 1e-6); // whose square is a number: where none fits, all count alike
    return like * like * (share + 1e-3);
}

/// Light that media scatter towards a pixel, from that of a ray. It grows with how much the media fill the way: light over opacity changes less from
/// ray to ray than light does, and where there are no media there is none. Below an opacity of a thousandth, rounding would be seen.
vec3 scaledByOpacity(vec3 light, vec3 rayOpacity, vec3 opacity) {
    vec3 scale = min(opacity / max(rayOpacity, vec3(1e-3)), vec3(4.0));
    return light * mix(scale, vec3(1.0), lessThan(rayOpacity, vec3(1e-3)));
}

#endif
