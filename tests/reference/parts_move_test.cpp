// Surfaces that move: trees that are refitted answer as such that are built anew.

#include <random>

#include <gtest/gtest.h>

#include "tracing/surface_scene.h"
#include "scene/primitives.h"

namespace tyndall::tracing {
namespace {

/// Thirty boxes and balls here and there.
Scene things(std::mt19937_64& random) {
    std::uniform_real_distribution<double> in(-1, 1);
    Scene scene;
    for (int i = 0; i < 2; ++i) {
        Primitive primitive;
        primitive.shape = i == 0 ? PrimitiveShape::Box : PrimitiveShape::Sphere;
        scene.meshes.push_back(makePrimitive(primitive));
    }
    for (int i = 0; i < 30; ++i) {
        Node& node = scene.nodes.emplace_back();
        node.meshes = {i % 2};
        node.translation = 4.0 * dvec3(in(random), in(random), in(random));
        node.rotation = glm::normalize(glm::dquat(1, in(random), in(random), in(random)));
    }
    return scene;
}

std::unique_ptr<SurfaceScene> built(const Scene& scene, const dvec3& origin) {
    return std::move(SurfaceScene::build(scene, origin, 1).value());
}

/// Rays into the scene meet the same places of the same triangles; returns how many meet anything.
int expectSame(const SurfaceScene& a, const SurfaceScene& b, std::mt19937_64& random) {
    std::uniform_real_distribution<double> in(-1, 1);
    int found = 0;
    for (int i = 0; i < 2000; ++i) {
        const dvec3 from = 8.0 * dvec3(in(random), in(random), in(random)),
                    to = 4.0 * dvec3(in(random), in(random), in(random));
        const Ray ray{from, glm::normalize(to - from)};
        const RayHit one = a.intersect(ray, 0, kInfinity, RayKind::Path, 1),
                     other = b.intersect(ray, 0, kInfinity, RayKind::Path, 1);
        EXPECT_EQ(one.found(), other.found()) << i;
        if (!one.found() || !other.found()) continue;
        ++found;
        // Embree computes in single precision, and in another order in another tree.
        EXPECT_NEAR(one.distance, other.distance, 1e-5 * other.distance);
        const SurfacePoint p = a.pointAt(ray, one), q = b.pointAt(ray, other);
        EXPECT_LT(glm::distance(p.position, q.position), 1e-5 * glm::length(q.position) + 1e-6);
        EXPECT_GT(glm::dot(p.surface.normal, q.surface.normal), 0.999)
            << "edges aside, where either side may be met";
        EXPECT_EQ(a.occluded(ray, 3, 1), b.occluded(ray, 3, 1));
    }
    return found;
}

TEST(MovingSurfaces, AnswerAsThoughBuiltAnew) {
    std::mt19937_64 random(12);
    std::uniform_real_distribution<double> in(-1, 1);
    Scene scene = things(random);
    const std::unique_ptr<SurfaceScene> kept = built(scene, dvec3(0));
    std::vector<uint32_t> moved;
    EXPECT_TRUE(kept->move(scene, dvec3(0), moved));
    EXPECT_TRUE(moved.empty());
    for (int step = 0; step < 4; ++step) {
        for (int i = step; i < 30; i += 4) {
            scene.nodes[size_t(i)].translation += dvec3(in(random), in(random), in(random));
            scene.nodes[size_t(i)].scale = dvec3(1, -1.2, 0.8 + 0.1 * step); // mirrored, too
        }
        ASSERT_TRUE(kept->move(scene, dvec3(0), moved));
        EXPECT_GE(moved.size(), 7u);
        const std::unique_ptr<SurfaceScene> fresh = built(scene, dvec3(0));
        EXPECT_EQ(kept->bounds().minimum, fresh->bounds().minimum);
        EXPECT_EQ(kept->bounds().maximum, fresh->bounds().maximum);
        EXPECT_GT(expectSame(*kept, *fresh, random), 500);
    }
    // Another origin of space moves all of them.
    ASSERT_TRUE(kept->move(scene, dvec3(1, 0, -2), moved));
    EXPECT_EQ(moved.size(), 30u);
    EXPECT_GT(expectSame(*kept, *built(scene, dvec3(1, 0, -2)), random), 500);
}

TEST(MovingSurfaces, AreBuiltAnewWhereTheyAreOthers) {
    std::mt19937_64 random(13);
    Scene scene = things(random);
    const std::unique_ptr<SurfaceScene> kept = built(scene, dvec3(0));
    std::vector<uint32_t> moved;
    scene.nodes[3].visible = false;
    EXPECT_FALSE(kept->move(scene, dvec3(0), moved));
    scene.nodes[3].visible = true;
    scene.nodes[4].scale.y = 0;
    EXPECT_FALSE(kept->move(scene, dvec3(0), moved)) << "flat: it may have been left out of trees";
    scene.nodes[4].scale.y = 1;
    scene.nodes[4].meshes = {1, 1};
    EXPECT_FALSE(kept->move(scene, dvec3(0), moved));
}

} // namespace
} // namespace tyndall::tracing
