// From the rays of march.comp to every pixel. Those that none fits are left to it again: shaders that gather are large.
#include "common/math.glsl"
#include "common/view.glsl"

vec4 mediaLight(Ray ray, float distance, uvec2 pixel) { return vec4(0.0); }

#include "gi/upsample.glsl"
