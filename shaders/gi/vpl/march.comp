// Light of virtual point lights that media scatter to the eye; also for pixels that upsampling leaves open.
// COMPENSATION: kVplClamped, kVplClosedForm or kVplTraced.
#define MARCH_FILLS
#define MARCH_TURNS
#include "gi/shared/march.glsl"
#include "gi/vpl/scattered_light.glsl"

layout(std430) readonly buffer VplPathLight { vec4 vplPathLight[]; }; // nits of compensation paths, by square

/// Of the square of a pixel.
vec3 pathLightOf(ivec2 pixel, ivec2 size) {
    if ((vpl.pathLight & kVplPathsInMedia) == 0u) return vec3(0.0);
    ivec2 square = pixel / int(params.factor);
    int across = (size.x + int(params.factor) - 1) / int(params.factor);
    return vplPathLight[square.y * across + square.x].rgb;
}

vec3 mediaLight(Ray ray, float distance, ivec2 pixel, uvec2 number) {
    marchedMedia = params.media;
    vec3 before = vpl.firstPoint == 0u ? vec3(0.0) : imageLoad(inScatter, ivec2(number)).rgb;
    vec3 light = lightScatteredAlong(ray, distance, number, before);
    return vpl.endPoint == kVplAllPoints ? light + pathLightOf(pixel, textureSize(depth, 0)) : light;
}
