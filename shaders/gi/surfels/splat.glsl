// What both stages of a splat know.
#ifndef TYNDALL_GI_SURFELS_SPLAT
#define TYNDALL_GI_SURFELS_SPLAT
#include "common/random.glsl"
#include "common/view.glsl"
#include "gi/surfels/interleave.glsl"
#include "shared/surfels.h"

layout(std140) uniform Splat { SurfelSplatParams splat; };
layout(std430) readonly buffer LitSurfels { LitSurfel lit[]; };

const float kEndless = 1e18; // metres; its square is finite

#endif
