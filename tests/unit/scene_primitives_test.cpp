#include "scene/primitives.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/mesh_tools.h"
#include "scene/scene_edit.h"

namespace tyndall {
namespace {

struct Totals {
    double area = 0;
    double volume = 0; // by the divergence theorem; positive when triangles face outward
    bool normalsAgree = true;
};

Totals measure(const Mesh& mesh) {
    Totals totals;
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        const dvec3 a = mesh.positions[mesh.indices[i]], b = mesh.positions[mesh.indices[i + 1]],
                    c = mesh.positions[mesh.indices[i + 2]];
        const dvec3 cross = glm::cross(b - a, c - a);
        totals.area += 0.5 * glm::length(cross);
        totals.volume += glm::dot(a, glm::cross(b, c)) / 6;
        for (size_t k = 0; k < 3; ++k)
            totals.normalsAgree &= glm::dot(cross, dvec3(mesh.normals[mesh.indices[i + k]])) > 0;
    }
    return totals;
}

TEST(Primitives, BoxHasItsAreaVolumeAndOutwardNormals) {
    const Mesh mesh = makePrimitive({PrimitiveShape::Box, {4, 0.5, 3}});
    const Totals totals = measure(mesh);
    EXPECT_NEAR(totals.area, 2 * (4 * 0.5 + 0.5 * 3 + 3 * 4), 1e-6);
    EXPECT_NEAR(totals.volume, 6, 1e-6);
    EXPECT_TRUE(totals.normalsAgree);
    EXPECT_EQ(mesh.bounds.minimum, dvec3(-2, -0.25, -1.5));
    EXPECT_EQ(mesh.bounds.maximum, dvec3(2, 0.25, 1.5));
}

TEST(Primitives, SphereLiesOnTheEllipsoidWithItsNormals) {
    const dvec3 half(0.5, 1, 2);
    const Mesh mesh = makePrimitive({PrimitiveShape::Sphere, 2.0 * half});
    EXPECT_TRUE(measure(mesh).normalsAgree);
    EXPECT_NEAR(measure(mesh).volume / (4.0 / 3 * kPi * half.x * half.y * half.z), 1, 2e-3);
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
        const dvec3 p = dvec3(mesh.positions[i]) / half;
        EXPECT_NEAR(glm::length(p), 1, 1e-6);
        EXPECT_NEAR(glm::dot(glm::normalize(p / half), dvec3(mesh.normals[i])), 1, 1e-6);
    }
}

TEST(Primitives, CylinderIsClosed) {
    const Mesh mesh = makePrimitive({PrimitiveShape::Cylinder, {2, 3, 2}});
    EXPECT_TRUE(measure(mesh).normalsAgree);
    EXPECT_NEAR(measure(mesh).volume / (kPi * 3), 1, 1e-3);
    EXPECT_NEAR(measure(mesh).area / (2 * kPi + 2 * kPi * 3), 1, 1e-3);
}

TEST(Primitives, PlaneAndDiskFaceUp) {
    for (const PrimitiveShape shape : {PrimitiveShape::Plane, PrimitiveShape::Disk}) {
        const Mesh mesh = makePrimitive({shape, {2, 1, 4}});
        const Totals totals = measure(mesh);
        EXPECT_TRUE(totals.normalsAgree);
        EXPECT_NEAR(totals.area, shape == PrimitiveShape::Plane ? 8 : 2 * kPi, 1e-2);
        for (const vec3& normal : mesh.normals) EXPECT_EQ(normal, vec3(0, 1, 0));
        for (const vec3& position : mesh.positions) EXPECT_EQ(position.y, 0.0f);
    }
}

TEST(MeshTools, FlatNormalsGiveEachTriangleItsOwn) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {5, 5, 5}};
    mesh.uvs[0] = {{0, 0}, {1, 0}, {0, 1}, {1, 1}, {2, 2}};
    mesh.indices = {0, 1, 2, 0, 2, 3, 4, 4, 4};
    makeFlatNormals(mesh);
    ASSERT_EQ(mesh.positions.size(), 9u);
    EXPECT_EQ(mesh.normals[0], vec3(0, 0, 1));
    EXPECT_EQ(mesh.normals[4], vec3(1, 0, 0));
    EXPECT_EQ(mesh.normals[8], vec3(0, 0, 1)) << "a triangle without area has some unit normal";
    EXPECT_EQ(mesh.uvs[0][5], vec2(1, 1)) << "other attributes follow their vertices";
}

TEST(MeshTools, TangentsPointAlongGrowingU) {
    for (const PrimitiveShape shape :
         {PrimitiveShape::Box, PrimitiveShape::Plane, PrimitiveShape::Sphere}) {
        Mesh mesh = makePrimitive({shape, {1, 2, 3}});
        makeTangents(mesh, 0);
        ASSERT_EQ(mesh.tangents.size(), mesh.positions.size());
        for (size_t i = 0; i < mesh.tangents.size(); ++i) {
            EXPECT_NEAR(glm::length(vec3(mesh.tangents[i])), 1, 1e-5);
            EXPECT_NEAR(glm::dot(vec3(mesh.tangents[i]), mesh.normals[i]), 0, 1e-5);
            // v runs down and u to the right seen from outside: +Y of a normal map is cross(normal, tangent).
            EXPECT_EQ(mesh.tangents[i].w, 1);
        }
    }
    const Mesh plane = [] {
        Mesh mesh = makePrimitive({PrimitiveShape::Plane, {1, 1, 1}});
        makeTangents(mesh, 0);
        return mesh;
    }();
    EXPECT_NEAR(plane.tangents[0].x, 1, 1e-6) << "u grows along +X";
}

TEST(MeshTools, MirroredUvsSplitTheirSeam) {
    Mesh mesh; // two triangles that share an edge; the second has u mirrored there
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
    mesh.normals.assign(4, {0, 0, 1});
    mesh.uvs[0] = {{0, 1}, {1, 1}, {0, 0}, {1, 1}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    makeTangents(mesh, 0);
    ASSERT_EQ(mesh.positions.size(), 6u) << "the two shared vertices are there twice";
    for (size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(mesh.tangents[mesh.indices[k]], vec4(1, 0, 0, 1));
        EXPECT_EQ(mesh.tangents[mesh.indices[3 + k]], vec4(-1, 0, 0, -1));
    }
}

// --- scene and edits ---------------------------------------------------------------------------------------------

Scene chain() { // a - b - c, and d at the root
    Scene scene;
    for (const char* name : {"a", "b", "c", "d"}) {
        Node node;
        node.name = name;
        if (*name != 'a' && *name != 'd') node.parent = int(scene.nodes.size()) - 1;
        addNode(scene, node);
    }
    return scene;
}

TEST(Scene, WorldTransformsMultiplyFromTheRoot) {
    Scene scene = chain();
    // Translate by x, turn +X to +Y, scale by 2: a point (1,0,0) of c goes to 2·, turned, moved.
    setNodeTransform(scene, 0, {10, 0, 0}, dquat(1, 0, 0, 0), dvec3(1));
    setNodeTransform(scene, 1, {0, 0, 0}, glm::angleAxis(kPi / 2, dvec3(0, 0, 1)), dvec3(1));
    setNodeTransform(scene, 2, {0, 0, 0}, dquat(1, 0, 0, 0), dvec3(2, 3, 4));
    const dvec4 p = scene.worldTransforms()[2] * dvec4(1, 0, 0, 1);
    EXPECT_NEAR(glm::distance(p, dvec4(10, 2, 0, 1)), 0, 1e-12);
}

TEST(Scene, InvisibleParentsHideTheirChildren) {
    Scene scene = chain();
    setNodeVisible(scene, 1, false);
    EXPECT_EQ(scene.worldVisibility(), (std::vector<bool>{true, false, false, true}));
}

TEST(SceneEdit, EveryChangeTakesANewNumber) {
    Scene scene = chain();
    const int light = addLight(scene, {});
    const SceneVersions before = scene.versions;
    const Version lightBefore = scene.lights[size_t(light)].version;
    setLight(scene, light, {});
    EXPECT_GT(scene.lights[size_t(light)].version, lightBefore);
    EXPECT_GT(scene.versions.lights, before.lights);
    EXPECT_EQ(scene.versions.materials, before.materials);
    setNodeTransform(scene, 0, dvec3(1), dquat(1, 0, 0, 0), dvec3(1));
    EXPECT_GT(scene.versions.transforms, before.transforms);
    EXPECT_EQ(scene.versions.structure, before.structure);
    EXPECT_THROW(setLight(scene, 7, {}), CheckFailure);
    EXPECT_THROW(setNodeTransform(scene, 0, dvec3(NAN), dquat(1, 0, 0, 0), dvec3(1)), CheckFailure);
}

TEST(SceneEdit, RemovingTakesTheSubtreeAndRenumbers) {
    Scene scene = chain();
    scene.nodes[3].camera = addCamera(scene, {});
    setActiveCamera(scene, 3);
    EXPECT_EQ(removeNode(scene, 1), (std::vector<int>{0, kNone, kNone, 1}));
    ASSERT_EQ(scene.nodes.size(), 2u);
    EXPECT_EQ(scene.nodes[1].name, "d");
    EXPECT_EQ(scene.activeCamera, 1);
}

TEST(SceneEdit, ReparentingKeepsParentsFirst) {
    Scene scene = chain();
    const std::vector<int> now = reparentNode(scene, 0, 3);
    EXPECT_EQ(scene.nodes[size_t(now[0])].parent, now[3]);
    for (size_t i = 0; i < scene.nodes.size(); ++i) EXPECT_LT(scene.nodes[i].parent, int(i));
    EXPECT_THROW(reparentNode(scene, now[0], now[2]), CheckFailure) << "no node hangs below itself";
}

} // namespace
} // namespace tyndall
