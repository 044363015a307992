// From the rays of march.comp to every pixel.
#define MARCH_FILLS
#include "gi/shared/upsample.glsl"
