// The picture is the sum of its terms. Always added in the same order, so that the same terms give the same bits.

#include "shared/post.h"

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D image0;
#if COUNT > 1
uniform sampler2D image1;
#endif
#if COUNT > 2
uniform sampler2D image2;
#endif
#if COUNT > 3
uniform sampler2D image3;
#endif
#if COUNT > 4
uniform sampler2D image4;
#endif
#if COUNT > 5
uniform sampler2D image5;
#endif
#if COUNT > 6
uniform sampler2D image6;
#endif
#if COUNT > 7
uniform sampler2D image7;
#endif
layout(rgba32f) uniform writeonly image2D sum;
layout(std430) buffer FirstInvalid { uint last[]; }; // of each term image: ~frame, the first one with a value that is not finite; 0: none
layout(std140) uniform Params { SumParams params; };

/// The light as it is. Where it is not finite, the frame is kept for its term image; which costs nothing where all is well.
vec3 checked(vec3 light, uint image) {
    const float kMaximum = 3.4e38;
    if (!all(lessThanEqual(abs(light), vec3(kMaximum))) && image >= params.before)
        atomicMax(last[params.base + image - params.before], ~params.frame);
    return light;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(sum)))) return;
    vec3 total = checked(texelFetch(image0, pixel, 0).rgb, 0u);
#if COUNT > 1
    total += checked(texelFetch(image1, pixel, 0).rgb, 1u);
#endif
#if COUNT > 2
    total += checked(texelFetch(image2, pixel, 0).rgb, 2u);
#endif
#if COUNT > 3
    total += checked(texelFetch(image3, pixel, 0).rgb, 3u);
#endif
#if COUNT > 4
    total += checked(texelFetch(image4, pixel, 0).rgb, 4u);
#endif
#if COUNT > 5
    total += checked(texelFetch(image5, pixel, 0).rgb, 5u);
#endif
#if COUNT > 6
    total += checked(texelFetch(image6, pixel, 0).rgb, 6u);
#endif
#if COUNT > 7
    total += checked(texelFetch(image7, pixel, 0).rgb, 7u);
#endif
    imageStore(sum, pixel, vec4(total, 1.0));
}
