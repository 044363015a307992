// A technique's light from surfaces, through the media between them and the eye.

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D radiance;
uniform sampler2D transmittance;
layout(rgba32f) uniform writeonly image2D attenuated;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(attenuated)))) return;
    imageStore(attenuated, pixel, vec4(texelFetch(radiance, pixel, 0).rgb * texelFetch(transmittance, pixel, 0).rgb, 1.0));
}
