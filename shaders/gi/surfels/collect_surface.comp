// As collect.comp, of pixels' surfaces: pixels count that are about in one plane and face the same way.
#include "gi/surfels/interleave.glsl"
#include "gi/shared/surface_light.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std140) uniform Collect { SurfelCollectParams collect; };
uniform sampler2DArray levels;
uniform sampler2D coarser;
layout(rgba32f) writeonly uniform image2D collected;

const float kOffPlane = 0.02; // sine of the angle out of the plane that halves a weight

vec3 filtered(ivec2 pixel, Receiver r) {
    if (collect.spacing == 0) return texelFetch(coarser, pixel, 0).rgb;
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    float eye = length(r.position - cameraRay(vec2(pixel) + 0.5).origin);
    for (int i = 0; i < 9; ++i) {
        ivec2 step = ivec2(i % 3, i / 3) - 1;
        ivec2 at = pixel + step * collect.spacing;
        Receiver other;
        if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, collect.size)) || !receiverAt(at, 0.0, other)) continue;
        float facing = max(dot(r.normal, other.normal), 0.0);
        float offPlane = abs(dot(r.facet, other.position - r.position)) / max(eye, 1e-20);
        float like = facing * facing * facing * facing / (1.0 + offPlane / kOffPlane);
        float weight = like * like * float((2 - abs(step.x)) * (2 - abs(step.y)));
        sum += weight * texelFetch(coarser, at, 0).rgb;
        weights += weight;
    }
    return sum / max(weights, 1e-37);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, collect.size))) return;
    vec3 light = vec3(0.0);
    Receiver r;
    if (receiverAt(pixel, 0.0, r)) {
        if (collect.hasCoarser != 0u) light = filtered(pixel, r);
        if (collect.hasOwn != 0u) {
            uint level = uint(collect.level);
            ivec2 texel = subBufferCorner(level, subBufferOf(level, pixel), collect.size) + (pixel >> collect.level);
            light += texelFetch(levels, ivec3(texel, collect.level), 0).rgb;
        }
        if (collect.last != 0u) light *= reflectance(r);
    }
    imageStore(collected, pixel, vec4(light, 1.0));
}
