// The tree of boxes that is walked without a stack, against all triangles one by one.

#include <random>

#include <gtest/gtest.h>

#include "tracing/triangle_tree.h"

namespace tyndall::tracing {
namespace {

/// Möller and Trumbore's test, for ends that lie off the plane; and is there a piece?
bool crosses(const SceneTriangle& triangle, const dvec3& from, const dvec3& to) {
    const dvec3 a = triangle.corners[1] - triangle.corners[0],
                b = triangle.corners[2] - triangle.corners[0], way = to - from;
    const dvec3 p = glm::cross(way, b);
    const double determinant = glm::dot(a, p);
    if (std::abs(determinant) < 1e-14) return false;
    const dvec3 off = from - triangle.corners[0], q = glm::cross(off, a);
    const double u = glm::dot(off, p) / determinant, v = glm::dot(way, q) / determinant,
                 t = glm::dot(b, q) / determinant;
    if (!(u >= 0 && v >= 0 && u + v <= 1 && t > 0 && t < 1)) return false;
    for (int piece = 0, j = 0; j < 8; ++j) // row by row, as the numbers go
        for (int k = 0; k < 15 - 2 * j; ++k, ++piece) {
            const double x = 8 * u - k / 2, y = 8 * v - j;
            const bool in =
                k % 2 == 0 ? x >= 0 && y >= 0 && x + y <= 1 : x <= 1 && y <= 1 && x + y > 1;
            if (in) return (triangle.covers >> piece & 1) != 0;
        }
    ADD_FAILURE() << "no piece has " << u << ", " << v;
    return false;
}

/// As the shader does it. `visited`: nodes.
bool hidden(const std::vector<TreeNode>& tree, const std::vector<SceneTriangle>& triangles,
            const dvec3& from, const dvec3& to, size_t& visited) {
    const dvec3 inverse = 1.0 / (to - from);
    for (size_t at = 0; at < tree.size(); ++visited) {
        const TreeNode& node = tree[at];
        const dvec3 low = (dvec3(node.minimum) - from) * inverse,
                    high = (dvec3(node.maximum) - from) * inverse;
        const dvec3 nearer = glm::min(low, high), farther = glm::max(low, high);
        const bool inside = std::max({nearer.x, nearer.y, nearer.z, 0.0}) <=
                            std::min({farther.x, farther.y, farther.z, 1.0});
        if (inside && node.triangle != TreeNode::kInner &&
            crosses(triangles[node.triangle], from, to))
            return true;
        at = inside ? at + 1 : node.next;
    }
    return false;
}

TEST(TriangleTree, FindsWhatAllTrianglesHide) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> in(-1, 1);
    const auto point = [&] { return dvec3(in(random), in(random), in(random)); };
    std::vector<SceneTriangle> triangles;
    for (int i = 0; i < 500; ++i) {
        const dvec3 place = 10.0 * point();
        // Coordinates that single precision holds: boxes are rounded to it.
        const auto corner = [&] { return dvec3(vec3(place + point())); };
        // Some whole, some with pieces missing, some that all rays pass.
        triangles.push_back({{corner(), corner(), corner()},
                             i % 7 == 0  ? 0
                             : i % 7 < 4 ? random()
                                         : ~0ull});
        if (i % 50 == 0) triangles.back().corners[2] = triangles.back().corners[1]; // without area
        if (i % 60 == 1) triangles.push_back(triangles.back());                     // twice
    }
    const auto tree = buildTriangleTree(triangles);
    ASSERT_TRUE(tree.ok()) << tree.message();
    int found = 0;
    size_t visited = 0;
    for (int i = 0; i < 5000; ++i) {
        const dvec3 from = 12.0 * point(), to = 12.0 * point();
        bool expected = false;
        for (const SceneTriangle& triangle : triangles)
            expected = expected || crosses(triangle, from, to);
        EXPECT_EQ(hidden(*tree, triangles, from, to, visited), expected) << i;
        found += expected;
    }
    EXPECT_GT(found, 500);
    EXPECT_LT(found, 4500);
    EXPECT_LT(double(visited) / 5000, 0.25 * double(tree->size())) << "boxes spare nothing";
}

TEST(TriangleTree, IsRefittedWhereTrianglesHaveMoved) {
    std::mt19937_64 random(6);
    std::uniform_real_distribution<double> in(-1, 1);
    const auto point = [&] { return dvec3(in(random), in(random), in(random)); };
    std::vector<SceneTriangle> triangles(300);
    for (SceneTriangle& triangle : triangles) {
        const dvec3 place = 10.0 * point();
        for (dvec3& corner : triangle.corners) corner = dvec3(vec3(place + point()));
    }
    std::vector<TreeNode> tree = buildTriangleTree(triangles).value();
    const dvec3 by(3, -8, 1);
    for (size_t i = 0; i < triangles.size(); i += 3)
        for (dvec3& corner : triangles[i].corners) corner = dvec3(vec3(corner + by));
    refitTriangleTree(tree, [&](uint32_t i) { return triangles[i].corners; });
    int found = 0;
    size_t visited = 0;
    for (int i = 0; i < 3000; ++i) {
        const dvec3 from = 14.0 * point(), to = 14.0 * point();
        bool expected = false;
        for (const SceneTriangle& triangle : triangles)
            expected = expected || crosses(triangle, from, to);
        EXPECT_EQ(hidden(tree, triangles, from, to, visited), expected) << i;
        found += expected;
    }
    EXPECT_GT(found, 200);
}

TEST(TriangleTree, OfNothingIsEmpty) {
    EXPECT_TRUE(buildTriangleTree({}).value().empty());
    const SceneTriangle veil{{dvec3(0), dvec3(1, 0, 0), dvec3(0, 1, 0)}, 0};
    EXPECT_TRUE(buildTriangleTree({&veil, 1}).value().empty());
    const SceneTriangle wall{veil.corners, 1};
    EXPECT_EQ(buildTriangleTree({&wall, 1}).value().size(), 1u);
}

} // namespace
} // namespace tyndall::tracing
