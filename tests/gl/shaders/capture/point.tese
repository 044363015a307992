#if POINTS
layout(triangles, equal_spacing, point_mode) in;
#else
layout(triangles, equal_spacing) in;
#endif
in vec3 corner[];
layout(xfb_offset = 0) out Surfel {
    vec4 position; // w: number of the patch
    vec4 weights;
};
void main() {
    position.xyz = gl_TessCoord.x * corner[0] + gl_TessCoord.y * corner[1] + gl_TessCoord.z * corner[2];
    position.w = float(gl_PrimitiveID);
    weights = vec4(gl_TessCoord, 0.0);
}
