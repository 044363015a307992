// From rays to pixels.
#define MARCH_FILLS
#include "gi/shared/upsample.glsl"
