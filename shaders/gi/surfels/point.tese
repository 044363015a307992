// Points of a patch as surfels.
#include "gi/surfels/patch.glsl"

layout(triangles, equal_spacing, point_mode) in;
patch in uint patchOfPoint;
layout(xfb_offset = 0) out Captured {
    vec4 position;
    vec4 normal;
    vec4 base;
    vec4 surface;
};

void main() {
    Surfel surfel = surfelOf(patchOfPoint, gl_TessCoord);
    position = surfel.position;
    normal = surfel.normal;
    base = surfel.base;
    surface = surfel.surface;
}
