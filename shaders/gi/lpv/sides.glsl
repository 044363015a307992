// On which side of the surfaces around it a point lies: to which cell its light belongs.
#ifndef TYNDALL_GI_LPV_SIDES
#define TYNDALL_GI_LPV_SIDES
#include "common/octahedral.glsl"
#include "gi/lpv/lattice.glsl"

layout(std430) readonly buffer LpvLinks { uint links[]; };

const float kOffSurface = 0.5; // cells that a point on a surface is moved off it: into the cell that its light goes to and comes from

/// The cell whose middle is on the same side as `place` (cells from the lattice's corner) of the surfaces that cross the axes through it:
/// the cell that holds it, or, where one of these stands between that one's middle and the point, the next one behind that surface.
ivec3 cellOnSide(vec3 place) {
    ivec3 last = params.size.xyz - 1;
    ivec3 cell = clamp(ivec3(floor(place)), ivec3(0), last);
    uint cells = cellCount();
    uint self = cellIndex(cell);
    if (links[kLpvBlocked * cells + self] == 0u) return cell;
    vec3 away = place - vec3(cell) - 0.5;
    float farthest = 0.002; // cells: what distances and normals are rounded by; a point on an edge belongs to both its surfaces
    ivec3 chosen = cell;
    for (uint i = 0u; i < 6u; ++i) {
        uint nearest = links[(kLpvNearest + i) * cells + self];
        if (nearest == 0u) continue;
        vec3 axis = vec3(0.0);
        axis[i / 2u] = (i & 1u) == 0u ? 1.0 : -1.0;
        vec3 normal = octahedralDecode(vec2((nearest >> 10u) & 1023u, nearest & 1023u) / 1023.0 * 2.0 - 1.0);
        if (dot(normal, axis) < 0.0) normal = -normal;
        float behind = dot(normal, away - axis * (float(4096u - (nearest >> 20u)) / 4095.0));
        if (behind <= farthest) continue;
        farthest = behind;
        vec3 size = abs(normal);
        ivec3 next = size.x >= size.y && size.x >= size.z ? ivec3(1, 0, 0) : (size.y >= size.z ? ivec3(0, 1, 0) : ivec3(0, 0, 1));
        chosen = cell + next * ivec3(sign(normal));
    }
    return clamp(chosen, ivec3(0), last);
}

/// Whether light gets from the middle of `cell` straight to that of `other`; false for cells that are not neighbours.
bool areOpen(uint blocked, ivec3 cell, ivec3 other) {
    ivec3 offset = other - cell;
    if (any(greaterThan(abs(offset), ivec3(1)))) return false;
    int number = offset.x + 1 + 3 * (offset.y + 1) + 9 * (offset.z + 1);
    if (number == 13) return true;
    return (blocked & (1u << uint(number < 13 ? number : number - 1))) == 0u;
}

#endif
