// Running mean over frames, and beside it in alpha the sum of squared deviations of luminance (Welford 1962), from which the
// error of the mean is estimated. Updated as a difference, so that a still pixel keeps its value to the last bit.

#include "shared/post.h"

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D image;
uniform sampler2D previous;
layout(rgba32f) uniform writeonly image2D current;
layout(std140) uniform Params { AccumulateParams params; };

float luminance(vec3 c) { return dot(c, vec3(0.2126, 0.7152, 0.0722)); }

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(current)))) return;
    vec3 value = texelFetch(image, pixel, 0).rgb;
    if (params.frame == 1u) {
        imageStore(current, pixel, vec4(value, 0.0));
        return;
    }
    vec4 before = texelFetch(previous, pixel, 0);
    vec3 mean = before.rgb + (value - before.rgb) * params.weight;
    float squares = before.a + (luminance(value) - luminance(before.rgb)) * (luminance(value) - luminance(mean));
    imageStore(current, pixel, vec4(mean, max(squares, 0.0)));
}
