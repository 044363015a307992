// The corners of patches, pulled from a buffer.
layout(std430) readonly buffer Corners { vec4 corners[]; };
out vec3 cornerIn;
void main() { cornerIn = corners[gl_VertexID].xyz; }
