layout(vertices = 3) out;
in vec3 cornerIn[];
out vec3 corner[];
layout(std140) uniform Params { vec4 levels; }; // of edges 0, 1, 2, and of the inside
void main() {
    corner[gl_InvocationID] = cornerIn[gl_InvocationID];
    gl_TessLevelOuter[0] = levels.x;
    gl_TessLevelOuter[1] = levels.y;
    gl_TessLevelOuter[2] = levels.z;
    gl_TessLevelInner[0] = levels.w;
}
