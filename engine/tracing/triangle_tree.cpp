#include "tracing/triangle_tree.h"

#include <memory>
#include <type_traits>

#include <embree3/rtcore.h>

namespace tyndall::tracing {
namespace {

/// As Embree makes them.
struct BuildNode {
    RTCBounds bounds[2];
    BuildNode* children[2];
    uint32_t triangle;
};

void* makeNode(RTCThreadLocalAllocator allocator, unsigned, void*) {
    auto* node = static_cast<BuildNode*>(
        rtcThreadLocalAlloc(allocator, sizeof(BuildNode), alignof(BuildNode)));
    *node = {};
    node->triangle = TreeNode::kInner;
    return node;
}

void setChildren(void* node, void** children, unsigned count, void*) {
    for (unsigned i = 0; i < count; ++i)
        static_cast<BuildNode*>(node)->children[i] = static_cast<BuildNode*>(children[i]);
}

void setBounds(void* node, const RTCBounds** bounds, unsigned count, void*) {
    for (unsigned i = 0; i < count; ++i) static_cast<BuildNode*>(node)->bounds[i] = *bounds[i];
}

void* makeLeaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, size_t,
               void*) {
    auto* node = static_cast<BuildNode*>(makeNode(allocator, 0, nullptr));
    node->triangle = primitives->primID;
    return node;
}

TreeNode boxOf(const RTCBounds& b) {
    TreeNode node;
    node.minimum = {b.lower_x, b.lower_y, b.lower_z};
    node.maximum = {b.upper_x, b.upper_y, b.upper_z};
    return node;
}

/// Appends a node and all below it.
void flatten(const BuildNode& from, const RTCBounds& bounds, std::vector<TreeNode>& nodes) {
    const size_t at = nodes.size();
    nodes.push_back(boxOf(bounds));
    nodes[at].triangle = from.triangle;
    for (int i = 0; i < 2; ++i)
        if (from.children[i]) flatten(*from.children[i], from.bounds[i], nodes);
    nodes[at].next = uint32_t(nodes.size());
}

std::vector<RTCBuildPrimitive> boxesOf(std::span<const SceneTriangle> triangles,
                                       RTCBounds& around) {
    std::vector<RTCBuildPrimitive> boxes;
    Bounds all;
    for (size_t i = 0; i < triangles.size(); ++i) {
        const auto& [a, b, c] = triangles[i].corners;
        const double area = glm::length(glm::cross(b - a, c - a));
        if (triangles[i].covers == 0 || !(area > 0) || !std::isfinite(area)) continue;
        const vec3 low(glm::min(a, glm::min(b, c))), high(glm::max(a, glm::max(b, c)));
        boxes.push_back({low.x, low.y, low.z, 0, high.x, high.y, high.z, uint32_t(i)});
        all.include(dvec3(low));
        all.include(dvec3(high));
    }
    const vec3 low(all.minimum), high(all.maximum);
    around = {low.x, low.y, low.z, 0, high.x, high.y, high.z, 0};
    return boxes;
}

} // namespace

Result<std::vector<TreeNode>> buildTriangleTree(std::span<const SceneTriangle> triangles) {
    RTCBounds around{};
    std::vector<RTCBuildPrimitive> boxes = boxesOf(triangles, around);
    std::vector<TreeNode> nodes;
    if (boxes.empty()) return nodes;
    const std::unique_ptr<std::remove_pointer_t<RTCDevice>, decltype(&rtcReleaseDevice)> device(
        rtcNewDevice(nullptr), rtcReleaseDevice);
    const std::unique_ptr<std::remove_pointer_t<RTCBVH>, decltype(&rtcReleaseBVH)> tree(
        device ? rtcNewBVH(device.get()) : nullptr, rtcReleaseBVH);
    if (!tree) return Error{"Embree does not start"};
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.buildQuality = RTC_BUILD_QUALITY_MEDIUM;
    arguments.maxBranchingFactor = 2;
    arguments.minLeafSize = arguments.maxLeafSize = 1;
    arguments.bvh = tree.get();
    arguments.primitives = boxes.data();
    arguments.primitiveCount = arguments.primitiveArrayCapacity = boxes.size();
    arguments.createNode = makeNode;
    arguments.setNodeChildren = setChildren;
    arguments.setNodeBounds = setBounds;
    arguments.createLeaf = makeLeaf;
    const auto* root = static_cast<const BuildNode*>(rtcBuildBVH(&arguments));
    if (!root)
        return Error{"Embree cannot build a tree of boxes: there is not enough memory for " +
                     std::to_string(boxes.size()) + " triangles"};
    nodes.reserve(2 * boxes.size());
    flatten(*root, around, nodes);
    return nodes;
}

} // namespace tyndall::tracing
