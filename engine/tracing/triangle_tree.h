#pragma once
// A tree of boxes over a scene's triangles that shaders walk without a stack.

#include <cstdint>
#include <span>
#include <vector>

#include "core/result.h"
#include "tracing/surface_scene.h"

namespace tyndall::tracing {

/// Nodes stand in the order in which they are visited: a node's first child follows it, and `next` is where to continue if its box is not hit.
struct TreeNode {
    static constexpr uint32_t kInner = 0xffffffffu;
    vec3 minimum{0}; // of the box, ray space
    uint32_t next = 0;
    vec3 maximum{0};
    uint32_t triangle = kInner; // of a leaf: index into what the tree was built from
};

/// Triangles that all rays pass, and triangles without area, are left out: they block nothing. Empty if none is left.
/// Errors: Embree gets no memory for it.
Result<std::vector<TreeNode>> buildTriangleTree(std::span<const SceneTriangle> triangles);

/// Boxes around triangles that have moved: the tree stays as it is. `corners(i)`: of triangle i.
template <typename Corners>
void refitTriangleTree(std::vector<TreeNode>& nodes, Corners&& corners) {
    for (size_t i = nodes.size(); i-- > 0;) {
        TreeNode& node = nodes[i];
        if (node.triangle != TreeNode::kInner) {
            const std::array<dvec3, 3> c = corners(node.triangle);
            node.minimum = vec3(glm::min(c[0], glm::min(c[1], c[2])));
            node.maximum = vec3(glm::max(c[0], glm::max(c[1], c[2])));
            continue;
        }
        node.minimum = nodes[i + 1].minimum;
        node.maximum = nodes[i + 1].maximum;
        for (uint32_t child = nodes[i + 1].next; child < node.next; child = nodes[child].next) {
            node.minimum = glm::min(node.minimum, nodes[child].minimum);
            node.maximum = glm::max(node.maximum, nodes[child].maximum);
        }
    }
}

} // namespace tyndall::tracing
