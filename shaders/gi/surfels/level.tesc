// As finely as the patch says.
#include "shared/surfels.h"

layout(vertices = 1) out;
layout(std430) readonly buffer SurfelPatches { SurfelPatch patches[]; };
in uint patchNumber[];
patch out uint patchOfPoint;

void main() {
    patchOfPoint = patchNumber[0];
    float level = float(patches[patchNumber[0]].level);
    for (int i = 0; i < 4; ++i) gl_TessLevelOuter[i] = level;
    gl_TessLevelInner[0] = level;
    gl_TessLevelInner[1] = level;
}
