// What virtual point lights see. A light's map names, for each direction, the triangle that it sees first; where that leaves a doubt, all triangles are
// asked, in a tree of boxes that is walked without a stack.
#ifndef TYNDALL_GI_VPL_VISIBILITY
#define TYNDALL_GI_VPL_VISIBILITY
#include "gi/vpl/lights.glsl"
#include "gi/vpl/map_texel.glsl"

layout(std430) readonly buffer VplMaps { uint vplMaps[]; };
layout(std430) readonly buffer VplTriangles { VplTriangle vplTriangles[]; };
layout(std430) readonly buffer VplTree { VplTreeNode vplTree[]; };

const float kVplRounding = 1e-4; // of distances and coordinates: nearer to a plane than this a point counts as on it
const float kVplSeam = 1e-4;     // barycentric: neighbours overlap, so that nothing comes through between them

const uint kHides = 1u;
const uint kDoubtful = 2u; // the points are on different sides of the triangle's plane, but it does not lie between them; or rays pass parts of it

/// Of a triangle with holes: is there something where these barycentric coordinates are? Pieces as tracing::pieceNumber() has them.
bool covers(VplTriangle triangle, float second, float third) {
    vec2 at = clamp(vec2(second, third), 0.0, 1.0) * 8.0;
    ivec2 cell = min(ivec2(at), 7);
    cell.x = min(cell.x, 7 - cell.y);
    vec2 within = at - vec2(cell);
    bool upper = within.x + within.y > 1.0 && cell.x + cell.y < 7;
    int piece = cell.y * (16 - cell.y) + 2 * cell.x + int(upper);
    return (((piece < 32 ? triangle.coversLow : triangle.coversHigh) >> uint(piece & 31)) & 1u) != 0u;
}

uint triangleSays(uint id, vec3 from, vec3 to, float rounding) {
    if (id == kVplNothing) return 0u;
    VplTriangle triangle = vplTriangles[id];
    float ofFrom = dot(triangle.plane.xyz, from) + triangle.plane.w;
    float ofTo = dot(triangle.plane.xyz, to) + triangle.plane.w;
    bool whole = triangle.corner.w != 0.0;
    uint misses = whole ? 0u : kDoubtful; // behind what has holes there is more
    if (min(abs(ofFrom), abs(ofTo)) <= rounding || ofFrom * ofTo >= 0.0) return misses;
    vec3 off = mix(from, to, ofFrom / (ofFrom - ofTo)) - triangle.corner.xyz;
    float second = dot(triangle.second, off);
    float third = dot(triangle.third, off);
    bool crossed = min(second, third) > -kVplSeam && second + third < 1.0 + kVplSeam;
    return crossed && (whole || covers(triangle, second, third)) ? kHides : kDoubtful;
}

/// To the next node of the tree, unless a leaf whose box the way crosses was found already: its triangle.
void nextNode(inout uint node, inout uint triangle, vec3 from, vec3 inverse) {
    if (triangle != kVplNothing || node >= vpl.treeSize) return;
    VplTreeNode here = vplTree[node];
    vec3 low = (here.minimum - from) * inverse;
    vec3 high = (here.maximum - from) * inverse;
    float enter = max(maximumOf(min(low, high)), 0.0);
    float leave = min(minimumOf(max(low, high)), 1.0);
    bool inside = enter <= leave * (1.0 + 1e-5); // boxes may be flat
    node = inside ? node + 1u : here.next;
    if (inside) triangle = here.triangle;
}

/// Does a triangle lie between two points? Nothing within rounding of either counts: both may lie on surfaces.
bool triangleBetween(vec3 from, vec3 to) {
    vec3 way = to - from;
    float rounding = kVplRounding * (length(way) + length(to));
    vec3 inverse = 1.0 / mix(way, vec3(1e-20), equal(way, vec3(0.0)));
    uint node = 0u;
    // Up to four nodes a round: llvmpipe ends all loops of an invocation after 65,535 rounds.
    while (node < vpl.treeSize) {
        uint triangle = kVplNothing;
        nextNode(node, triangle, from, inverse);
        nextNode(node, triangle, from, inverse);
        nextNode(node, triangle, from, inverse);
        nextNode(node, triangle, from, inverse);
        if (triangleSays(triangle, from, to, rounding) == kHides) return true;
    }
    return false;
}

uint vplTriangleAt(uint light, ivec2 texel) { return vplMaps[vplMapStart(light) + vplTexelAt(texel)]; }

/// Does the light see the point? `direction`: unit, from the light. The four texels around the direction are looked at: what has an outline within
/// one of them is seen by another. A triangle there that lies between settles it, and so does it if the point lies behind none.
bool vplSees(uint light, vec3 position, vec3 direction, float distance) {
    if (vpl.mapSide == 0u || distance < uintBitsToFloat(vplMaps[vplNearestAt(light)])) return true;
    float side = float(vpl.mapSide);
    vec2 at = clamp((octahedralEncode(direction) * 0.5 + 0.5) * side, vec2(0.0), vec2(side - 0.5));
    ivec2 texel = ivec2(at);
    ivec2 beside = ivec2(lessThan(fract(at), vec2(0.5))) * -2 + 1;
    vec3 from = vplLights[light].position.xyz;
    float rounding = kVplRounding * (distance + length(position));
    uint said = triangleSays(vplTriangleAt(light, texel), from, position, rounding);
    said |= triangleSays(vplTriangleAt(light, texel + ivec2(beside.x, 0)), from, position, rounding) |
            triangleSays(vplTriangleAt(light, texel + ivec2(0, beside.y)), from, position, rounding) |
            triangleSays(vplTriangleAt(light, texel + beside), from, position, rounding); // no loop: llvmpipe counts its rounds
    return said == 0u || (said == kDoubtful && !triangleBetween(from, position));
}

#endif
