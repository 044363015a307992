#include "renderer/emissive_lights.h"

#include <gtest/gtest.h>

#include "scene/primitives.h"

namespace tyndall {
namespace {

/// One glowing primitive of 2, 3 and 4 nits.
Scene glowing(PrimitiveShape shape, const dvec3& size, const dvec3& scale = dvec3(1)) {
    Scene scene;
    Material material;
    material.emissive = {2, 3, 4};
    scene.materials.push_back(material);
    Mesh mesh = makePrimitive({shape, size});
    mesh.material = 0;
    scene.meshes.push_back(mesh);
    Node node;
    node.name = "glow";
    node.primitive = Primitive{shape, size};
    node.meshes = {0};
    node.translation = {1, 2, 3};
    node.scale = scale;
    scene.nodes.push_back(node);
    return scene;
}

EmissiveLights find(const Scene& scene) {
    return findEmissiveLights(scene, scene.worldTransforms(), scene.worldVisibility());
}

/// The direction in which a light looks: -Z of its node.
dvec3 looks(const EmissiveLight& light) { return glm::normalize(-dvec3(light.worldFromLight[2])); }

TEST(EmissiveLights, APlaneIsARectangleOfItsRadianceThatLooksOutOfItsFront) {
    const EmissiveLights found = find(glowing(PrimitiveShape::Plane, {2, 1, 0.5}, {3, 1, 4}));
    ASSERT_EQ(found.lights.size(), 1u);
    const EmissiveLight& rect = found.lights[0];
    EXPECT_EQ(rect.light.type, LightType::Rect);
    EXPECT_EQ(rect.light.radiance, vec3(2, 3, 4));
    EXPECT_NEAR(glm::dot(looks(rect), dvec3(0, 1, 0)), 1, 1e-12);
    // 2·3 by 0.5·4 metres: the plane's world size.
    EXPECT_NEAR(double(rect.light.size.x) * glm::length(dvec3(rect.worldFromLight[0])), 6, 1e-6);
    EXPECT_NEAR(double(rect.light.size.y) * glm::length(dvec3(rect.worldFromLight[1])), 2, 1e-6);
    // Just off the surface, on the side that it lights.
    const dvec3 off = dvec3(rect.worldFromLight[3]) - dvec3(1, 2, 3);
    EXPECT_GT(off.y, 0);
    EXPECT_LT(glm::length(off), 0.01);
    EXPECT_TRUE(found.notes.empty());
}

TEST(EmissiveLights, ADoubleSidedPlaneShinesBothWaysAndAMirroredOneStillOutOfItsFront) {
    Scene scene = glowing(PrimitiveShape::Plane, {1, 1, 1});
    scene.materials[0].doubleSided = true;
    const EmissiveLights both = find(scene);
    ASSERT_EQ(both.lights.size(), 2u);
    EXPECT_NEAR(glm::dot(looks(both.lights[0]), looks(both.lights[1])), -1, 1e-12);
    for (const dvec3& scale : {dvec3(-1, 1, 1), dvec3(1, -1, 1)}) {
        const EmissiveLights mirrored = find(glowing(PrimitiveShape::Plane, {1, 1, 1}, scale));
        ASSERT_EQ(mirrored.lights.size(), 1u);
        // The front is where the plane's +Y has gone.
        EXPECT_NEAR(glm::dot(looks(mirrored.lights[0]), dvec3(0, scale.y, 0)), 1, 1e-12);
        EXPECT_GT((mirrored.lights[0].worldFromLight[3].y - 2) * scale.y, 0);
    }
}

TEST(EmissiveLights, ABallHasTheIntensityOfALambertianBall) {
    const EmissiveLights found = find(glowing(PrimitiveShape::Sphere, dvec3(0.5), dvec3(2)));
    ASSERT_EQ(found.lights.size(), 1u);
    const Light& ball = found.lights[0].light;
    EXPECT_EQ(ball.type, LightType::Point);
    EXPECT_FLOAT_EQ(ball.radius, 0.5f);
    for (int c = 0; c < 3; ++c) // pi r^2 L
        EXPECT_FLOAT_EQ(ball.color[c] * ball.intensity, float(kPi * 0.25 * (2 + c)));
    EXPECT_EQ(dvec3(found.lights[0].worldFromLight[3]), dvec3(1, 2, 3));
}

TEST(EmissiveLights, WhatIsNoPlaneAndNoBallIsNamed) {
    const auto expectNamed = [](const Scene& scene) {
        const EmissiveLights found = find(scene);
        EXPECT_TRUE(found.lights.empty());
        ASSERT_EQ(found.notes.size(), 1u);
        EXPECT_NE(found.notes[0].find("'glow'"), std::string::npos) << found.notes[0];
    };
    expectNamed(glowing(PrimitiveShape::Box, {1, 1, 1}));
    expectNamed(glowing(PrimitiveShape::Sphere, {1, 2, 1})); // an egg
    Scene textured = glowing(PrimitiveShape::Plane, {1, 1, 1});
    textured.materials[0].emissiveTexture.texture = 0;
    expectNamed(textured);
}

TEST(EmissiveLights, WhatIsDarkHiddenOrUnlitIsNoLight) {
    Scene dark = glowing(PrimitiveShape::Plane, {1, 1, 1}), hidden = dark, unlit = dark;
    dark.materials[0].emissive = vec3(0);
    hidden.nodes[0].visible = false;
    unlit.materials[0].unlit = true;
    for (const Scene& scene : {dark, hidden, unlit}) {
        EXPECT_TRUE(find(scene).lights.empty());
        EXPECT_TRUE(find(scene).notes.empty());
    }
}

} // namespace
} // namespace tyndall
