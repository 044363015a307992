// From the rays of march.comp to every pixel.
#include "gi/vpl/scattered_light.glsl"

vec3 mediaLight(Ray ray, float distance, uvec2 pixel) { return lightScatteredAlong(ray, distance, pixel); }

#include "gi/upsample.glsl"
