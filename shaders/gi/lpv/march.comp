// Light of the lattices that media scatter to the eye.
#include "gi/shared/march.glsl"
#include "gi/lpv/scattered_light.glsl"
