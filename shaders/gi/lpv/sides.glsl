// On which side of the surfaces around it a point lies: to which cell its light belongs.
#ifndef TYNDALL_GI_LPV_SIDES
#define TYNDALL_GI_LPV_SIDES
#include "common/octahedral.glsl"
#include "gi/lpv/grid.glsl"

layout(std430) readonly buffer LpvLinks { uint links[]; };

const float kOffSurface = 0.5; // cells by which a point on a surface is moved off it, into the cell that its light comes from and goes to

/// The farthest that `place` (cells from the lattice's corner) is behind a surface that crosses an axis through the middle of `cell` before
/// the next one's; at most 0 where it is behind none. `through`: the surface's normal, away from the middle.
float depthBehind(LpvGrid grid, ivec3 cell, vec3 place, out vec3 through) {
    uint cells = cellCount(grid);
    uint self = uint(grid.place.y) + cellIndex(grid, cell);
    float farthest = 0.0;
    through = vec3(0.0);
    if (links[kLpvBlocked * cells + self] == 0u) return farthest;
    vec3 away = place - vec3(cell) - 0.5;
    for (uint i = 0u; i < 6u; ++i) {
        uint nearest = links[(kLpvNearest + i) * cells + self];
        if (nearest == 0u) continue;
        vec3 axis = vec3(0.0);
        axis[i / 2u] = (i & 1u) == 0u ? 1.0 : -1.0;
        vec3 normal = octahedralDecode(vec2((nearest >> 10u) & 1023u, nearest & 1023u) / 1023.0 * 2.0 - 1.0);
        if (dot(normal, axis) < 0.0) normal = -normal;
        // Less than distances and normals are rounded by: a point on an edge belongs to both its surfaces.
        float behind = dot(normal, away - axis * (float(4096u - (nearest >> 20u)) / 4095.0)) - 0.002;
        if (behind <= farthest) continue;
        farthest = behind;
        through = normal;
    }
    return farthest;
}

/// The cell whose middle is on the same side as `place` of the surfaces around it: the cell that holds it, or, where one of these stands
/// between that one's middle and the point, one behind that surface: the next along the axis that the surface faces most, along the
/// second, or along both. If the point is hidden from all of them, it lies around a corner from the one that holds it.
ivec3 cellOnSide(LpvGrid grid, vec3 place) {
    ivec3 last = grid.size.xyz - 1;
    ivec3 cell = clamp(ivec3(floor(place)), ivec3(0), last);
    vec3 through, ignored;
    if (depthBehind(grid, cell, place, through) <= 0.0) return cell;
    vec3 size = abs(through);
    ivec3 first = size.x >= size.y && size.x >= size.z ? ivec3(1, 0, 0) : (size.y >= size.z ? ivec3(0, 1, 0) : ivec3(0, 0, 1));
    size *= vec3(1 - first);
    ivec3 second = size.x >= size.y && size.x >= size.z ? ivec3(1, 0, 0) : (size.y >= size.z ? ivec3(0, 1, 0) : ivec3(0, 0, 1));
    ivec3 sides = ivec3(sign(through));
    int tries = maximumOf(size) > 0.2 ? 3 : 1; // a surface that faces one axis does not matter along another
    for (int i = 0; i < tries; ++i) {
        ivec3 next = clamp(cell + (i == 0 ? first : (i == 1 ? second : first + second)) * sides, ivec3(0), last);
        if (depthBehind(grid, next, place, ignored) <= 0.0) return next;
    }
    return cell;
}

/// Whether the link from the centre of `cell` to that of `other` is open; false for cells that are not neighbours.
bool areOpen(uint blocked, ivec3 cell, ivec3 other) {
    ivec3 offset = other - cell;
    if (any(greaterThan(abs(offset), ivec3(1)))) return false;
    int number = offset.x + 1 + 3 * (offset.y + 1) + 9 * (offset.z + 1);
    if (number == 13) return true;
    return (blocked & (1u << uint(number < 13 ? number : number - 1))) == 0u;
}

#endif
