// From the rays of march.comp to every pixel.
#include "gi/lpv/scattered_light.glsl"

vec3 mediaLight(Ray ray, float distance, uvec2 pixel) { return lightScatteredAlong(ray, distance); }

#include "gi/upsample.glsl"
