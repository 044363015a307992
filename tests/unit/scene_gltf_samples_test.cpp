// What the shared glTF sample models must give.
#include "scene/gltf_import.h"

#include <gtest/gtest.h>

#include "support/content.h"

namespace tyndall {
namespace {

namespace fs = std::filesystem;

Scene loadSample(const fs::path& path) {
    auto loaded = loadScene(path);
    CHECK(loaded.ok(), loaded.ok() ? "" : loaded.message());
    return std::move(loaded->scene);
}

void expectSameBounds(const Bounds& a, const Bounds& b, double relative) {
    const double size = glm::length(a.extent());
    EXPECT_LT(glm::distance(a.minimum, b.minimum), relative * size);
    EXPECT_LT(glm::distance(a.maximum, b.maximum), relative * size);
}

size_t triangles(const Scene& scene) {
    size_t count = 0;
    for (const Mesh& mesh : scene.meshes) count += mesh.indices.size() / 3;
    return count;
}

TEST(GltfSamples, CompressedVariantsEqualEachOther) {
    const fs::path folder = REQUIRE_CONTENT("gltf/compressed");
    for (const char* model : {"Duck", "BoxTextured", "CesiumMan"}) {
        const Scene quantized = loadSample(folder / (std::string(model) + "-quantized.glb"));
        for (const char* packing : {"-draco.glb", "-meshopt.glb"}) {
            const Scene packed = loadSample(folder / (std::string(model) + packing));
            EXPECT_EQ(triangles(packed), triangles(quantized)) << model << packing;
            expectSameBounds(packed.worldBounds(), quantized.worldBounds(), 2e-3);
        }
    }
    const auto plain = REQUIRE_CONTENT("gltf/khronos/BoxTextured/BoxTextured.gltf");
    expectSameBounds(loadSample(plain).worldBounds(),
                     loadSample(folder / "BoxTextured-draco.glb").worldBounds(), 1e-3);
}

TEST(GltfSamples, TextureTransformTestHasItsTransforms) {
    const Scene scene =
        loadSample(REQUIRE_CONTENT("gltf/khronos/TextureTransformTest/TextureTransformTest.gltf"));
    const auto find = [&](const std::string& name) -> const TextureRef& {
        for (const Material& material : scene.materials)
            if (material.name == name) return material.baseColorTexture;
        CHECK(false, name);
    };
    EXPECT_EQ(find("Offset U").offset, vec2(0.5f, 0));
    EXPECT_EQ(find("Offset UV").offset, vec2(0.5f, 0.5f));
}

TEST(GltfSamples, InstancingExampleHas125) {
    const Scene scene = loadSample(REQUIRE_CONTENT("gltf/ext/simple-instancing.glb"));
    size_t instances = 0;
    for (const Node& node : scene.nodes) instances += node.instances.size();
    EXPECT_EQ(instances, 125u);
}

TEST(GltfSamples, LightsExampleIsInCandelaAndLux) {
    const Scene scene = loadSample(REQUIRE_CONTENT("gltf/ext/Lights.glb"));
    ASSERT_EQ(scene.lights.size(), 4u);
    for (const Light& light : scene.lights) {
        if (light.type == LightType::Point) {
            EXPECT_EQ(light.intensity, 5);
        }
        if (light.name == "Spot") {
            EXPECT_NEAR(light.outerConeAngle, 0.3926991, 1e-6);
        }
        if (light.type == LightType::Directional) {
            EXPECT_NEAR(light.intensity, 1, 1e-6);
        }
    }
}

TEST(GltfSamples, AllOfThemAreSound) {
    std::vector<fs::path> files;
    for (const char* folder : {"gltf", "sponza"})
        if (const auto root = test::sharedContent(folder))
            for (const auto& entry : fs::recursive_directory_iterator(*root))
                if (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb")
                    files.push_back(entry.path());
    if (files.empty()) GTEST_SKIP() << "shared content 'gltf' is not here";
    for (const fs::path& path : files) {
        SCOPED_TRACE(path.string());
        const auto loaded = loadScene(path);
        ASSERT_TRUE(loaded.ok()) << loaded.message();
        const Scene& scene = loaded->scene;
        EXPECT_NE(scene.activeCamera, kNone);
        EXPECT_FALSE(scene.worldBounds().empty());
        for (size_t i = 0; i < scene.nodes.size(); ++i) EXPECT_LT(scene.nodes[i].parent, int(i));
        for (const Mesh& mesh : scene.meshes) {
            const size_t count = mesh.positions.size();
            EXPECT_GT(count, 0u);
            for (const uint32_t index : mesh.indices) ASSERT_LT(index, count);
            if (mesh.topology == MeshTopology::Triangles) {
                ASSERT_EQ(mesh.normals.size(), count);
            }
            for (const vec3& normal : mesh.normals) ASSERT_NEAR(glm::length(normal), 1, 1e-4);
            for (const auto& uvs : mesh.uvs) ASSERT_TRUE(uvs.empty() || uvs.size() == count);
            if (scene.materialOf(mesh).normalTexture.texture != kNone) {
                ASSERT_EQ(mesh.tangents.size(), count);
            }
        }
    }
}

TEST(GltfSamples, SponzaIsComplete) {
    const Scene scene = loadSample(REQUIRE_CONTENT("sponza/Sponza.gltf"));
    EXPECT_EQ(triangles(scene), 262267u);
    EXPECT_EQ(scene.meshes.size(), 103u);
    EXPECT_EQ(scene.materials.size(), 25u);
    EXPECT_EQ(scene.images.size(), 69u);
}

} // namespace
} // namespace tyndall
