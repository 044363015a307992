// From the rays of march.comp to every pixel.
#include "gi/shared/upsample.glsl"
#include "gi/lpv/scattered_light.glsl"
