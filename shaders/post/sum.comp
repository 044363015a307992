// The picture is the sum of its terms. Always added in the same order, so that the same terms give the same bits.

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

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(sum)))) return;
    vec3 total = texelFetch(image0, pixel, 0).rgb;
#if COUNT > 1
    total += texelFetch(image1, pixel, 0).rgb;
#endif
#if COUNT > 2
    total += texelFetch(image2, pixel, 0).rgb;
#endif
#if COUNT > 3
    total += texelFetch(image3, pixel, 0).rgb;
#endif
#if COUNT > 4
    total += texelFetch(image4, pixel, 0).rgb;
#endif
#if COUNT > 5
    total += texelFetch(image5, pixel, 0).rgb;
#endif
#if COUNT > 6
    total += texelFetch(image6, pixel, 0).rgb;
#endif
#if COUNT > 7
    total += texelFetch(image7, pixel, 0).rgb;
#endif
    imageStore(sum, pixel, vec4(total, 1.0));
}
