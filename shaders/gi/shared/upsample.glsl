// From the rays of gi/shared/march.glsl to every pixel. A pixel that no ray fits is marched here by mediaLight(), which the including shader defines; with
// MARCH_FILLS it is left open (w: 0) for a third pass, because gathering shaders are large.
#include "media/spread_rays.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D transmittance;
uniform sampler2D before; // of the rays
layout(rgba32f) writeonly uniform image2D inScatter;

#ifndef MARCH_FILLS
vec3 mediaLight(Ray ray, float distance, ivec2 pixel, uvec2 number);
#endif

vec3 rayThrough(NearRay ray) { return texelFetch(transmittance, ray.pixel, 0).rgb; }

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(inScatter)))) return;
    float distance = distanceAt(pixel);
    RaysAround rays = raysAround(pixel, distance, texelFetch(transmittance, pixel, 0).rgb, textureSize(before, 0));
    vec4 light = vec4(spreadScattered(rays, before), 1.0);
#ifdef MARCH_FILLS
    if (isAlone(rays)) light = vec4(0.0);
#else
    if (isAlone(rays)) light.rgb = mediaLight(cameraRay(vec2(pixel) + 0.5), distance, pixel, uvec2(pixel));
#endif
    imageStore(inScatter, pixel, light);
}
