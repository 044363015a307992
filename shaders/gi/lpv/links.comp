// Links between cells that a triangle blocks. One workgroup for each triangle; its threads share the cells around it.
//
// A link is the segment between the centres of two neighbouring cells. A wall of any thickness crosses it or does not, and a
// cell belongs to the side of its centre. Links that graze an edge count as blocked: a missing blocked link would let light through a wall.
#include "common/octahedral.glsl"
#include "gi/lpv/lattice.glsl"
#include "shared/material.h"
#include "shared/object.h"

layout(local_size_x = 64) in;

layout(std140) uniform Triangles { LpvTriangles triangles; };
layout(std430) readonly buffer Vertices { float vertices[]; };
layout(std430) readonly buffer Indices { uint indices[]; };
layout(std430) readonly buffer Objects { ObjectData objects[]; };
layout(std430) readonly buffer Materials { MaterialData materials[]; };
layout(std430) buffer LpvLinks { uint links[]; };
uniform sampler2D baseColorTexture;

const float kGraze = 1e-4; // of a cell, and of a triangle's own coordinates

vec3 corner(uint index) {
    uint at = indices[index] * triangles.strideFloats;
    vec4 local = vec4(vertices[at], vertices[at + 1u], vertices[at + 2u], 1.0);
    return latticePosition((objects[triangles.object].renderFromLocal * local).xyz);
}

/// Where the segment from `p` along `way` crosses the triangle, 0..1; -1 where it does not (Möller and Trumbore 1997).
float crossing(vec3 p, vec3 way, vec3 a, vec3 ab, vec3 ac) {
    vec3 h = cross(way, ac);
    float determinant = dot(ab, h);
    if (abs(determinant) < 1e-12) return -1.0;
    float inverse = 1.0 / determinant;
    vec3 s = p - a;
    float u = dot(s, h) * inverse;
    vec3 q = cross(s, ab);
    float v = dot(way, q) * inverse;
    float t = dot(ac, q) * inverse;
    bool inside = u >= -kGraze && v >= -kGraze && u + v <= 1.0 + kGraze && t >= -kGraze && t <= 1.0 + kGraze;
    return inside ? clamp(t, 0.0, 1.0) : -1.0;
}

/// Blocks the link in direction j at its parameter `t`; the first surface's colour stays.
void blockLink(uint cell, uint cells, uint j, float t, vec3 colour) {
    atomicOr(links[kLpvBlocked * cells + cell], 1u << j);
    atomicMax(links[(kLpvSurface + j) * cells + cell], packUnorm4x8(vec4(colour, max(1.0 - t, 1.0 / 255.0))));
}

void main() {
    uint triangle = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    if (triangle >= triangles.count) return;
    vec3 a = corner(3u * triangle);
    vec3 b = corner(3u * triangle + 1u);
    vec3 c = corner(3u * triangle + 2u);
    ivec3 first = clamp(ivec3(floor(min(a, min(b, c)) - 0.5)) - 1, ivec3(-1), params.grid.size.xyz);
    ivec3 last = clamp(ivec3(floor(max(a, max(b, c)) - 0.5)) + 1, ivec3(-1), params.grid.size.xyz);
    ivec3 span = last - first + 1;
    vec3 normal = cross(b - a, c - a);
    float size = length(normal);
    if (!(size > 0.0)) return;
    normal /= size;
    uvec2 encoded = uvec2((octahedralEncode(normal) * 0.5 + 0.5) * 1023.0 + 0.5);
    uint packedNormal = encoded.x << 10u | encoded.y;
    MaterialData material = materials[objects[triangles.object].material];
    // The coarsest level of a texture is its mean.
    vec3 colour = material.baseColor.rgb;
    if (material.baseColorTexture.offset.w != 0.0) colour *= textureLod(baseColorTexture, vec2(0.5), 100.0).rgb;
    colour *= params.onward;
    uint cells = cellCount();
    for (uint i = gl_LocalInvocationID.x; i < uint(span.x * span.y * span.z); i += 64u) {
        ivec3 at = first + ivec3(i % uint(span.x), i / uint(span.x) % uint(span.y), i / uint(span.x * span.y));
        vec3 middle = vec3(at) + 0.5;
        if (abs(dot(middle - a, normal)) > 1.7321 + kGraze) continue; // no link from here reaches the plane
        bool hasSelf = isInside(at);
        uint self = hasSelf ? cellIndex(at) : 0u;
        // Half of the directions: the other half are the same links from the other end.
        for (uint j = 13u; j < kLpvDirections; ++j) {
            ivec3 offset = params.directions[j].offset.xyz;
            ivec3 to = at + offset;
            float t = crossing(middle, vec3(offset), a, b - a, c - a);
            if (t < 0.0) continue;
            int axis = params.directions[j].offset.w != 0 ? -1 : (offset.x != 0 ? 0 : (offset.y != 0 ? 1 : 2));
            uint units = uint(t * 4095.0 + 0.5);
            if (hasSelf) {
                blockLink(self, cells, j, t, colour);
                if (axis >= 0) atomicMax(links[(kLpvNearest + 2u * uint(axis)) * cells + self], (4096u - max(units, 1u)) << 20u | packedNormal);
            }
            if (!isInside(to)) continue;
            uint other = cellIndex(to);
            blockLink(other, cells, 25u - j, 1.0 - t, colour);
            if (axis >= 0) atomicMax(links[(kLpvNearest + 2u * uint(axis) + 1u) * cells + other], (4096u - max(4095u - units, 1u)) << 20u | packedNormal);
        }
    }
}
