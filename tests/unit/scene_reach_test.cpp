#include "scene/scene_reach.h"

#include <gtest/gtest.h>


namespace tyndall {
namespace {

constexpr double kRange[] = {1e2, 1e3, 1e4, 1e5, 1e6, 1e7}; // metres

/// A box of this size, a metre of which is one of the scene's.
void addBox(Scene& scene, const dvec3& centre, const dvec3& size) {
    Mesh mesh;
    mesh.bounds.include(-0.5 * size);
    mesh.bounds.include(0.5 * size);
    Node node;
    node.translation = centre;
    node.meshes = {int(scene.meshes.size())};
    scene.meshes.push_back(std::move(mesh));
    scene.nodes.push_back(std::move(node));
}

void addLamp(Scene& scene, const dvec3& place) {
    Node node;
    node.translation = place;
    node.light = int(scene.lights.size());
    scene.lights.emplace_back().type = LightType::Point;
    scene.nodes.push_back(std::move(node));
}

void addFog(Scene& scene, double size, float scattering, float absorption) {
    Medium medium;
    medium.kind = MediumKind::Box;
    medium.size = dvec3(size);
    medium.scattering = vec3(scattering);
    medium.absorption = vec3(absorption);
    Node node;
    node.medium = int(scene.media.size());
    scene.media.push_back(std::move(medium));
    scene.nodes.push_back(std::move(node));
}

/// A room's worth of things around the origin.
Scene room() {
    Scene scene;
    addBox(scene, {0, -0.05, 0}, {4, 0.1, 4});
    addBox(scene, {0.2, 0.4, -0.2}, {0.5, 0.8, 0.5});
    addBox(scene, {-1.5, 1, 0}, {0.1, 2, 4});
    addLamp(scene, {0.5, 3, 0.3});
    return scene;
}

const Viewer kViewer{{0, 1, 6}, {0, 0, -1}, 0.5};

void expectSame(const Bounds& a, const Bounds& b) {
    EXPECT_EQ(a.minimum, b.minimum);
    EXPECT_EQ(a.maximum, b.maximum);
}

TEST(SceneReach, OneClusterIsTheWholeScene) {
    const Scene scene = room();
    const SceneReach reach = reachOf(findClusters(scene), kViewer);
    expectSame(reach.surroundings, scene.worldBounds());
    expectSame(reach.content, scene.contentBounds());
    EXPECT_EQ(reach.withLamps.maximum.y, 3) << "the lamp's height";
}

TEST(SceneReach, FarSpecksChangeNothing) {
    const SceneReach alone = reachOf(findClusters(room()), kViewer);
    for (const double distance : kRange)
        for (const dvec3 way : {dvec3(0, 0, 1), dvec3(0, 0, -1), dvec3(1, 0, 0), dvec3(0, 1, 0)}) {
            Scene scene = room();
            addBox(scene, distance * way, dvec3(0.5));
            addLamp(scene, distance * way + dvec3(0, 5, 0));
            SceneReach reach = reachOf(findClusters(scene), kViewer);
            reach.seen = alone.seen; // a speck in view is still drawn
            EXPECT_TRUE(reach == alone) << distance << " m away";
        }
}

TEST(SceneReach, FarThingsThatAreLargeAreSurroundings) {
    Scene scene = room();
    addBox(scene, {0, 0, -5000}, {3000, 2000, 3000}); // a mountain in view
    const SceneReach reach = reachOf(findClusters(scene), kViewer);
    expectSame(reach.surroundings, scene.worldBounds());
    Viewer back = kViewer;
    back.forward = {0, 0, 1};
    back.eye = {0, 1, -6};
    EXPECT_LT(reachOf(findClusters(scene), back).content.extent().z, 10)
        << "looking away from it, detail goes to the room";
}

TEST(SceneReach, HowFarAbsorbingFogGoesOnDoesNotMatter) {
    const auto reachIn = [](double size) {
        Scene scene = room();
        addFog(scene, size, 0.15f, 0.25f);
        return reachOf(findClusters(scene), kViewer);
    };
    const SceneReach reach = reachIn(200);
    for (const double size : kRange)
        if (size > 200) {
            EXPECT_TRUE(reachIn(size) == reach) << size << " m of fog";
        }
    // Diffusion length 1/√(3·0.25·0.4) = 1.83 m: twelve of them to each side.
    EXPECT_GT(reach.surroundings.extent().x, 2 * 12 * 1.82);
    EXPECT_LT(reach.surroundings.extent().x, 2 * 12 * 1.83 + 4 + 11);
    // Fog of a size that light crosses counts whole.
    Scene small = room();
    addFog(small, 16, 0.15f, 0.25f);
    EXPECT_EQ(reachOf(findClusters(small), kViewer).surroundings.extent().x, 16);
}

TEST(SceneReach, LightGoesAnyDistanceInFogThatDoesNotAbsorb) {
    Scene scene = room();
    addFog(scene, 1e4, 0.4f, 0);
    const SceneReach reach = reachOf(findClusters(scene), kViewer);
    EXPECT_EQ(reach.surroundings.extent().x, 1e4);
    EXPECT_LT(reach.content.extent().x, 50) << "but what is seen is not farther away";
}

TEST(SceneReach, InWideFogDetailFollowsInWholeSteps) {
    Scene scene;
    addFog(scene, 1e5, 0.15f, 0.25f);
    const SceneClusters clusters = findClusters(scene);
    int changes = 0;
    SceneReach last = reachOf(clusters, kViewer);
    for (int i = 1; i <= 1000; ++i) {
        Viewer viewer = kViewer;
        viewer.eye.x = 0.1 * i; // 100 m
        const SceneReach reach = reachOf(clusters, viewer);
        EXPECT_TRUE(reach.content.contains(viewer.eye));
        changes += reach == last ? 0 : 1;
        last = reach;
    }
    EXPECT_GT(changes, 5);
    EXPECT_LT(changes, 50);
}

TEST(SceneReach, FromOutsideAllOfTheFogCounts) {
    Scene scene;
    addFog(scene, 1e3, 0.15f, 0.25f);
    Viewer viewer = kViewer;
    viewer.eye = {0, 0, 3e3};
    EXPECT_EQ(reachOf(findClusters(scene), viewer).content.extent().x, 1e3);
}

TEST(SceneReach, ManyClustersEndInOne) {
    Scene scene;
    for (int i = 0; i < 3000; ++i)
        addBox(scene, {1e3 * (i % 60), 0, 1e3 * (i / 60)}, dvec3(1));
    const SceneClusters found = findClusters(scene);
    EXPECT_LE(found.clusters.size(), 64u);
    Bounds all;
    for (const SceneCluster& cluster : found.clusters) all.include(cluster.things);
    expectSame(all, scene.worldBounds());
}

TEST(SceneReach, EmptyScenesAreEmpty) {
    EXPECT_TRUE(reachOf(findClusters(Scene{}), kViewer).surroundings.empty());
    Scene lamps;
    addLamp(lamps, {0, 0, 0});
    addLamp(lamps, {0, 0, 6});
    EXPECT_TRUE(reachOf(findClusters(lamps), kViewer).surroundings.empty());
}

} // namespace
} // namespace tyndall
