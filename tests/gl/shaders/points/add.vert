// Point n adds (1, n, n mod 7, −1) to pixel n mod `width` of a row.
flat out vec4 value;
uniform int width;
void main() {
    value = vec4(1, gl_VertexID, gl_VertexID % 7, -1);
    gl_Position = vec4((2.0 * float(gl_VertexID % width) + 1.0) / float(width) - 1.0, 0.0, 0.5, 1.0);
    gl_PointSize = 1.0;
}
