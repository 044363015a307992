// Unit vectors as points of a square: the octahedron |x|+|y|+|z| = 1 with its lower half folded out (Meyer et al. 2010, "On
// floating-point normal vectors"). With 16 bits a coordinate the direction is good to 5e-5 radians.
#ifndef TYNDALL_COMMON_OCTAHEDRAL
#define TYNDALL_COMMON_OCTAHEDRAL

vec2 octahedralFold(vec2 p) {
    // sign() would be 0 on the axes and tear the map there.
    return (1.0 - abs(p.yx)) * vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
}

// Unit vector to [-1,1]².
vec2 octahedralEncode(vec3 direction) {
    vec3 p = direction / (abs(direction.x) + abs(direction.y) + abs(direction.z));
    return p.z >= 0.0 ? p.xy : octahedralFold(p.xy);
}

// [-1,1]² to a unit vector.
vec3 octahedralDecode(vec2 square) {
    vec3 p = vec3(square, 1.0 - abs(square.x) - abs(square.y));
    if (p.z < 0.0) p.xy = octahedralFold(p.xy);
    return normalize(p);
}

// The same over [0,1]², for unsigned normalised textures. The scale by 65534 of 65535 steps puts a texel's value exactly on the
// middle of the square, so that the axes come back without error.
vec2 octahedralEncodeUnorm(vec3 direction) {
    return (octahedralEncode(direction) * 0.5 + 0.5) * (65534.0 / 65535.0);
}

vec3 octahedralDecodeUnorm(vec2 unorm) {
    return octahedralDecode(clamp(unorm * (65535.0 / 65534.0) * 2.0 - 1.0, vec2(-1.0), vec2(1.0)));
}

#endif
