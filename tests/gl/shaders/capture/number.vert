// Numbers that the processor can make as well, to the last bit: whole ones, and quotients by powers of two.
layout(xfb_offset = 0) flat out uvec2 hashed;
layout(xfb_offset = 8) out float quotient;
void main() {
    uint id = uint(gl_VertexID);
    hashed = uvec2(id, (id * 747796405u + 2891336453u) ^ (id >> 3));
    quotient = float(id) / 8.0 - 3.0;
    gl_Position = vec4(0.0, 0.0, 0.5, 1.0); // the middle of the target
    gl_PointSize = 1.0;
}
