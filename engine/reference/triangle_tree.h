#pragma once
// A tree of boxes over a scene's triangles that is walked without a stack, on processors that have none to spare.

#include <cstdint>
#include <span>
#include <vector>

#include "core/result.h"
#include "reference/surface_scene.h"

namespace tyndall::reference {

/// Nodes stand in the order in which they are visited: a node's first child follows it, and `next` is where to go on when nothing in it is met.
struct TreeNode {
    static constexpr uint32_t kInner = 0xffffffffu;
    vec3 minimum{0}; // of the box, ray space
    uint32_t next = 0;
    vec3 maximum{0};
    uint32_t triangle = kInner; // of a leaf: index into what the tree was built from
};

/// Triangles that rays may pass, and such without area, are left out: nothing is hidden behind them. Empty where none is left.
/// Errors: Embree gets no memory for it.
Result<std::vector<TreeNode>> buildTriangleTree(std::span<const SceneTriangle> triangles);

} // namespace tyndall::reference
