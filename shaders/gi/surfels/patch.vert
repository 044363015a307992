// A patch of the scene's surfaces: it has one vertex, its number.
#include "shared/surfels.h"

layout(std140) uniform Set { SurfelSet set; };
out uint patchNumber;

void main() { patchNumber = set.firstPatch + uint(gl_VertexID); }
