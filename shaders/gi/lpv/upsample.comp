// From the rays of march.comp to every pixel.
#include "gi/lpv/scattered_light.glsl"

vec4 mediaLight(Ray ray, float distance, uvec2 pixel) { return vec4(lightScatteredAlong(ray, distance), 1.0); }

#include "gi/upsample.glsl"
