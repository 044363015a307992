// The scene's triangles and a tree over them, for shaders that ask what stands between two points: buffers `TracedTriangles` and `TracedTree`.
#ifndef TYNDALL_SHARED_TRACED_H
#define TYNDALL_SHARED_TRACED_H
#include "shared/types.h"
TYNDALL_SHARED_BEGIN

TYNDALL_CONST uint kNoTriangle = 0xffffffffu; // in the place of a triangle's number

/// A triangle as what hides light.
struct TracedTriangle {
    vec4 plane;  // n·p + w = 0, n unit; 0 without area
    vec4 corner; // render space; w: 0 where rays pass parts of it, else 1
    vec3 second; // dot(second, p - corner): barycentric coordinate of the second corner
    uint coversLow;  // a bit for each piece that no ray passes (tracing::SceneTriangle)
    vec3 third;      // as `second`, of the third
    uint coversHigh;
};

/// As tracing::TreeNode.
struct TracedTreeNode {
    vec3 minimum;
    uint next;
    vec3 maximum;
    uint triangle; // kNoTriangle: an inner node
};

// Uniform block `Traced`.
struct TracedParams {
    uint treeSize; // nodes; 0: nothing stands between any two points
    uint padding0;
    uint padding1;
    uint padding2;
};

TYNDALL_SHARED_END
#endif
