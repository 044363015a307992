// Light that leaves surfaces, as seen through the media between them and the eye, and (ADD) light that the media add.

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D radiance;
uniform sampler2D transmittance;
#if ADD
uniform sampler2D added;
#endif
layout(rgba32f) uniform writeonly image2D seen;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(seen)))) return;
    vec3 light = texelFetch(radiance, pixel, 0).rgb * texelFetch(transmittance, pixel, 0).rgb;
#if ADD
    light += texelFetch(added, pixel, 0).rgb;
#endif
    imageStore(seen, pixel, vec4(light, 1.0));
}
