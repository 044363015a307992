// Light that leaves surfaces, seen through the media, and light that the media send: one image a term.
// LE = T·Le(surface) + Le(media), LSE = T·L(surface), LVE = in-scatter; the same for what techniques computed.

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D surfaceEmission;
uniform sampler2D surfaceDirect;
uniform sampler2D transmittance;
uniform sampler2D mediumEmission;
layout(rgba32f) uniform writeonly image2D imageLE;
layout(rgba32f) uniform writeonly image2D imageLSE;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(imageLE)))) return;
    vec3 through = texelFetch(transmittance, pixel, 0).rgb;
    vec3 emission = texelFetch(surfaceEmission, pixel, 0).rgb * through;
#if EMISSION
    emission += texelFetch(mediumEmission, pixel, 0).rgb;
#endif
    imageStore(imageLE, pixel, vec4(emission, 1.0));
    imageStore(imageLSE, pixel, vec4(texelFetch(surfaceDirect, pixel, 0).rgb * through, 1.0));
}
