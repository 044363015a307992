// Counts its vertices; what it draws goes nowhere.
layout(std430) buffer Total { uint total; };
void main() {
    atomicAdd(total, 1u);
    gl_Position = vec4(0.0, 0.0, 0.5, 1.0);
}
