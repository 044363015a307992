// Visibility between two points: all triangles are tested, in a tree of boxes that is walked without a stack.
#ifndef TYNDALL_GI_SHARED_VISIBILITY
#define TYNDALL_GI_SHARED_VISIBILITY
#include "common/math.glsl"
#include "shared/traced.h"

layout(std140) uniform Traced { TracedParams traced; };
layout(std430) readonly buffer TracedTriangles { TracedTriangle tracedTriangles[]; };
layout(std430) readonly buffer TracedTree { TracedTreeNode tracedTree[]; };

const float kTracedRounding = 1e-4; // of distances and coordinates: nearer to a plane than this a point counts as on it
const float kTracedSeam = 1e-4;     // barycentric: neighbours overlap, so that no light passes between them

const uint kHides = 1u;
const uint kDoubtful = 2u; // the points are on different sides of the triangle's plane, but it does not lie between them; or rays pass parts of it

/// Does a triangle with holes cover these barycentric coordinates? Pieces as tracing::pieceNumber() has them.
bool covers(TracedTriangle triangle, float second, float third) {
    vec2 at = clamp(vec2(second, third), 0.0, 1.0) * 8.0;
    ivec2 cell = min(ivec2(at), 7);
    cell.x = min(cell.x, 7 - cell.y);
    vec2 within = at - vec2(cell);
    bool upper = within.x + within.y > 1.0 && cell.x + cell.y < 7;
    int piece = cell.y * (16 - cell.y) + 2 * cell.x + int(upper);
    return (((piece < 32 ? triangle.coversLow : triangle.coversHigh) >> uint(piece & 31)) & 1u) != 0u;
}

/// One triangle against the segment between two points: kHides, kDoubtful, or 0: it does not block.
uint triangleSays(uint id, vec3 from, vec3 to, float rounding) {
    if (id == kNoTriangle) return 0u;
    TracedTriangle triangle = tracedTriangles[id];
    float ofFrom = dot(triangle.plane.xyz, from) + triangle.plane.w;
    float ofTo = dot(triangle.plane.xyz, to) + triangle.plane.w;
    bool whole = triangle.corner.w != 0.0;
    uint misses = whole ? 0u : kDoubtful; // other triangles may block behind the holes
    if (min(abs(ofFrom), abs(ofTo)) <= rounding || ofFrom * ofTo >= 0.0) return misses;
    vec3 off = mix(from, to, ofFrom / (ofFrom - ofTo)) - triangle.corner.xyz;
    float second = dot(triangle.second, off);
    float third = dot(triangle.third, off);
    bool crossed = min(second, third) > -kTracedSeam && second + third < 1.0 + kTracedSeam;
    return crossed && (whole || covers(triangle, second, third)) ? kHides : kDoubtful;
}

/// Steps to the next node of the tree, unless a leaf whose box the segment crosses is found already: its triangle.
void nextNode(inout uint node, inout uint triangle, vec3 from, vec3 inverse) {
    if (triangle != kNoTriangle || node >= traced.treeSize) return;
    TracedTreeNode here = tracedTree[node];
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
    float rounding = kTracedRounding * (length(way) + length(to));
    vec3 inverse = 1.0 / mix(way, vec3(1e-20), equal(way, vec3(0.0)));
    uint node = 0u;
    // Up to four nodes a round: llvmpipe ends all loops of an invocation after 65,535 rounds.
    while (node < traced.treeSize) {
        uint triangle = kNoTriangle;
        nextNode(node, triangle, from, inverse);
        nextNode(node, triangle, from, inverse);
        nextNode(node, triangle, from, inverse);
        nextNode(node, triangle, from, inverse);
        if (triangleSays(triangle, from, to, rounding) == kHides) return true;
    }
    return false;
}

#endif
