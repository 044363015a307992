// Exposure, tone curve, sRGB encoding and dithering. The one place where an invalid value is replaced, and it is counted.

#include "post/tone_curves.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D image;
layout(rgba8) uniform writeonly image2D display;
layout(std430) buffer InvalidPixels { uint nonFinite; uint negative; };
layout(std140) uniform Params { TonemapParams params; };

uint hash(uint x) { // PCG output permutation
    x = x * 747796405u + 2891336453u;
    x = ((x >> ((x >> 28u) + 4u)) ^ x) * 277803737u;
    return (x >> 22u) ^ x;
}

float triangularNoise(uvec2 pixel, uint channel) {
    uint h = hash(pixel.x + hash(pixel.y + hash(channel + params.seed)));
    return (float(h & 0xffffu) + float(h >> 16u)) / 65536.0 - 1.0;
}

vec3 validOrBlack(vec3 c) {
    const float kMaximum = 3.4e38;
    bvec3 ordered = lessThanEqual(abs(c), vec3(kMaximum)); // false for NaN and infinity
    if (!all(ordered)) atomicAdd(nonFinite, 1u);
    else if (any(lessThan(c, vec3(0.0)))) atomicAdd(negative, 1u);
    return vec3(c.r >= 0.0 && c.r <= kMaximum ? c.r : 0.0, c.g >= 0.0 && c.g <= kMaximum ? c.g : 0.0,
                c.b >= 0.0 && c.b <= kMaximum ? c.b : 0.0);
}

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(ivec2(pixel), imageSize(display)))) return;
    // Beyond 2^20 times display white every curve is flat; bounded so that no curve squares its way to infinity.
    vec3 exposed = min(validOrBlack(texelFetch(image, ivec2(pixel), 0).rgb) * params.exposure, 1048576.0);
    vec3 encoded = srgbFromLinear(clamp(toneCurve(params.curve, exposed), 0.0, 1.0));
    if (params.dither != 0u) {
        vec3 noise = vec3(triangularNoise(pixel, 0u), triangularNoise(pixel, 1u), triangularNoise(pixel, 2u));
        encoded += noise / 255.0 * vec3(greaterThan(encoded, vec3(0.0))) * vec3(lessThan(encoded, vec3(1.0)));
    }
    imageStore(display, ivec2(pixel), vec4(clamp(encoded, 0.0, 1.0), 1.0));
}
