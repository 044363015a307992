// What the glTF 2.0 specification says about small files made here.
#include "scene/gltf_import.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "core/image.h"
#include "support/content.h"

namespace tyndall {
namespace {

namespace fs = std::filesystem;

/// Builds a .gltf: a binary buffer with one view and one accessor for each array given.
class GltfBuilder {
public:
    /// Returns the accessor's index.
    template <typename T>
    int add(const std::vector<T>& values, int componentType, const std::string& type,
            int components, bool normalized = false) {
        while (bytes_.size() % 4) bytes_ += '\0';
        const size_t size = values.size() * sizeof(T);
        views_ += fmt::format(R"({}{{"buffer": 0, "byteOffset": {}, "byteLength": {}}})",
                              views_.empty() ? "" : ", ", bytes_.size(), size);
        accessors_ += fmt::format(
            R"({}{{"bufferView": {}, "componentType": {}, "count": {}, "type": "{}", "normalized": {}}})",
            accessors_.empty() ? "" : ", ", count_, componentType,
            values.size() / size_t(components), type, normalized);
        bytes_.append(reinterpret_cast<const char*>(values.data()), size);
        return count_++;
    }
    int positions(const std::vector<float>& values) { return add(values, 5126, "VEC3", 3); }
    int indices(const std::vector<uint16_t>& values) { return add(values, 5123, "SCALAR", 1); }

    /// `rest`: the other top-level keys, beginning with a comma.
    Result<GltfScene> import(const std::string& rest) const {
        static const fs::path folder = test::scratchDir("gltf");
        CHECK(writeFileAtomically(folder / "test.bin", bytes_).ok());
        const std::string json = fmt::format(
            R"({{"asset": {{"version": "2.0"}}, "buffers": [{{"uri": "test.bin", "byteLength": {}}}], "bufferViews": [{}], "accessors": [{}]{}}})",
            bytes_.size(), views_, accessors_, rest);
        CHECK(writeFileAtomically(folder / "test.gltf", json).ok());
        return importGltf(folder / "test.gltf");
    }

private:
    std::string bytes_, views_, accessors_;
    int count_ = 0;
};

Result<GltfScene> importText(const std::string& text) {
    static const fs::path folder = test::scratchDir("gltf-text");
    CHECK(writeFileAtomically(folder / "test.gltf", text).ok());
    return importGltf(folder / "test.gltf");
}

/// A file without buffers: asset and what is given.
Result<GltfScene> importKeys(const std::string& keys) {
    return importText(R"({"asset": {"version": "2.0"}, )" + keys + "}");
}

std::string refusal(const Result<GltfScene>& result) {
    if (result.ok()) return "(loaded)";
    const size_t name = result.message().find("test.gltf: ");
    return name == std::string::npos ? result.message() : result.message().substr(name + 11);
}

const std::vector<float> kFive = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0};

TEST(GltfImport, EveryPrimitiveModeBecomesAList) {
    struct Case {
        int mode;
        MeshTopology topology;
        std::vector<uint32_t> list; // in the file's vertex numbers; glTF 2.0 section 3.7.2.1
    };
    const Case cases[] = {
        {0, MeshTopology::Points, {0, 1, 2, 3, 4}},
        {1, MeshTopology::Lines, {0, 1, 2, 3}},
        {2, MeshTopology::Lines, {0, 1, 1, 2, 2, 3, 3, 4, 4, 0}},
        {3, MeshTopology::Lines, {0, 1, 1, 2, 2, 3, 3, 4}},
        {4, MeshTopology::Triangles, {0, 1, 2}},
        {5, MeshTopology::Triangles, {0, 1, 2, 1, 3, 2, 2, 3, 4}},
        {6, MeshTopology::Triangles, {1, 2, 0, 2, 3, 0, 3, 4, 0}},
    };
    for (const Case& one : cases)
        for (const bool indexed : {false, true}) {
            GltfBuilder builder;
            builder.positions(kFive);
            builder.indices({0, 1, 2, 3, 4});
            const auto loaded = builder.import(fmt::format(
                R"(, "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "mode": {}{}}}]}}], "nodes": [{{"mesh": 0}}])",
                one.mode, indexed ? R"(, "indices": 1)" : ""));
            ASSERT_TRUE(loaded.ok()) << loaded.message();
            const Mesh& mesh = loaded->scene.meshes.at(0);
            EXPECT_EQ(mesh.topology, one.topology);
            ASSERT_EQ(mesh.indices.size(), one.list.size()) << "mode " << one.mode;
            for (size_t i = 0; i < one.list.size(); ++i) {
                const vec3 expected(kFive[3 * one.list[i]], kFive[3 * one.list[i] + 1],
                                    kFive[3 * one.list[i] + 2]);
                EXPECT_EQ(mesh.positions[mesh.indices[i]], expected)
                    << "mode " << one.mode << ", corner " << i;
            }
            EXPECT_EQ(mesh.normals.empty(), one.topology != MeshTopology::Triangles);
            for (const vec3& normal : mesh.normals)
                EXPECT_NEAR(std::abs(normal.z), 1, 1e-6)
                    << "flat normals of a figure in the plane z = 0";
        }
}

TEST(GltfImport, QuantisedAttributesEqualTheirFloats) {
    GltfBuilder builder;
    builder.add<int16_t>({-32768, 0, 32767, 0, 32767, 0, 16384, -16384, 100, 0}, 5122, "VEC3", 3,
                         true); // 3 elements, one number unused
    builder.add<int8_t>({127, 0, 0, 0, 127, 0, 0, 0, 127}, 5120, "VEC3", 3, true);
    builder.add<uint8_t>({0, 255, 51, 102, 255, 255}, 5121, "VEC2", 2, true);
    builder.add<uint16_t>({65535, 0, 13107, 0, 0, 0, 0, 65535, 65535}, 5123, "VEC3", 3, true);
    builder.add<uint16_t>({7, 300, 2, 0, 1, 1}, 5123, "VEC2", 2, false);
    const auto loaded = builder.import(R"(, "meshes": [{"primitives": [{"attributes":
        {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2, "COLOR_0": 3, "TEXCOORD_1": 4}}]}], "nodes": [{"mesh": 0}])");
    ASSERT_TRUE(loaded.ok()) << loaded.message();
    const Mesh& mesh = loaded->scene.meshes.at(0);
    EXPECT_EQ(mesh.positions[0], vec3(-1, 0, 1)) << "-32768 is clamped to -1";
    EXPECT_EQ(mesh.positions[1], vec3(0, 1, 0));
    EXPECT_EQ(mesh.positions[2], vec3(16384 / 32767.0f, -16384 / 32767.0f, 100 / 32767.0f));
    EXPECT_EQ(mesh.normals[1], vec3(0, 1, 0));
    EXPECT_EQ(mesh.uvs[0][0], vec2(0, 1));
    EXPECT_EQ(mesh.uvs[0][1], vec2(0.2f, 0.4f));
    EXPECT_EQ(mesh.colors[0], vec4(1, 0, 13107 / 65535.0f, 1))
        << "alpha is 1 where a colour has three numbers";
    EXPECT_EQ(mesh.uvs[1][0], vec2(7, 300))
        << "integers that are not normalised stay what they are";
}

TEST(GltfImport, InterleavedAndOffsetAccessorsAreFollowed) {
    // Two vertices' worth of padding, then position and UV interleaved with a stride of 24 bytes.
    std::vector<float> data(6, -1.0f);
    for (int i = 0; i < 3; ++i)
        for (const float v :
             {float(i), float(10 + i), float(20 + i), 0.25f * float(i), 0.5f, -1.0f})
            data.push_back(v);
    std::string bytes(reinterpret_cast<const char*>(data.data()), data.size() * 4);
    const fs::path folder = test::scratchDir("gltf-interleaved");
    ASSERT_TRUE(writeFileAtomically(folder / "a b.bin", bytes).ok());
    ASSERT_TRUE(
        writeFileAtomically(
            folder / "a.gltf",
            R"({"asset": {"version": "2.0"}, "buffers": [{"uri": "a%20b.bin", "byteLength": 96}],
        "bufferViews": [{"buffer": 0, "byteOffset": 16, "byteLength": 80, "byteStride": 24}],
        "accessors": [{"bufferView": 0, "byteOffset": 8, "componentType": 5126, "count": 3, "type": "VEC3"},
                      {"bufferView": 0, "byteOffset": 20, "componentType": 5126, "count": 3, "type": "VEC2"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}}]}], "nodes": [{"mesh": 0}]})")
            .ok());
    const auto loaded = importGltf(folder / "a.gltf");
    ASSERT_TRUE(loaded.ok()) << loaded.message();
    const Mesh& mesh = loaded->scene.meshes.at(0);
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(mesh.positions[size_t(i)], vec3(float(i), float(10 + i), float(20 + i)));
        EXPECT_EQ(mesh.uvs[0][size_t(i)], vec2(0.25f * float(i), 0.5f));
    }
}

TEST(GltfImport, SparseAccessorReplacesElements) {
    const auto path =
        REQUIRE_CONTENT("gltf/khronos/SimpleSparseAccessor/SimpleSparseAccessor.gltf");
    const auto loaded = importGltf(path);
    ASSERT_TRUE(loaded.ok()) << loaded.message();
    // Two rows of seven vertices, (0..6, 0) and (0..6, 1); vertices 8, 10 and 12 become (1,2,0), (3,3,0), (5,4,0).
    std::vector<vec3> expected;
    for (const vec3& p : {vec3(1, 2, 0), vec3(3, 3, 0), vec3(5, 4, 0)}) expected.push_back(p);
    const auto& positions = loaded->scene.meshes.at(0).positions;
    for (const vec3& p : expected)
        EXPECT_NE(std::find(positions.begin(), positions.end(), p), positions.end());
    for (const vec3& p : {vec3(1, 1, 0), vec3(3, 1, 0), vec3(5, 1, 0)})
        EXPECT_EQ(std::find(positions.begin(), positions.end(), p), positions.end());
    EXPECT_EQ(loaded->scene.meshes[0].bounds.maximum, dvec3(6, 4, 0));
}

TEST(GltfImport, MaterialsArriveWithAllTheirTextures) {
    // A 1x1 red PNG.
    const std::string png =
        "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGP4z8AAAAMBAQDJ/pLvAAAAAElFTkSuQmCC";
    const auto loaded = importKeys(R"("images": [{"uri": "data:image/png;base64,)" + png + R"("}],
        "samplers": [{"magFilter": 9728, "minFilter": 9985, "wrapS": 33071, "wrapT": 33648}],
        "textures": [{"source": 0, "sampler": 0}, {"source": 0}],
        "extensionsUsed": ["KHR_texture_transform", "KHR_materials_emissive_strength", "KHR_materials_specular", "KHR_materials_unlit"],
        "materials": [{"name": "all", "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0.5, "roughnessFactor": 0.6,
            "baseColorTexture": {"index": 0, "texCoord": 1, "extensions": {"KHR_texture_transform":
              {"offset": [0.1, 0.2], "scale": [3, 4], "rotation": 0.5, "texCoord": 2}}},
            "metallicRoughnessTexture": {"index": 1}},
          "normalTexture": {"index": 0, "scale": 0.7}, "occlusionTexture": {"index": 0, "strength": 0.8, "texCoord": 1},
          "emissiveTexture": {"index": 0}, "emissiveFactor": [0.5, 1, 0], "alphaMode": "BLEND", "alphaCutoff": 0.25, "doubleSided": true,
          "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 20}, "KHR_materials_specular": {"specularFactor": 0.3},
            "KHR_materials_unlit": {}}}, {}])");
    ASSERT_TRUE(loaded.ok()) << loaded.message();
    const Scene& scene = loaded->scene;
    const Material& material = scene.materials.at(0);
    EXPECT_EQ(material.baseColor, vec4(0.1f, 0.2f, 0.3f, 0.4f));
    EXPECT_EQ(material.metallic, 0.5f);
    EXPECT_EQ(material.roughness, 0.6f);
    EXPECT_EQ(material.specular, 0.3f);
    EXPECT_EQ(material.emissive, vec3(10, 20, 0)) << "factor times strength, nits";
    EXPECT_EQ(material.normalScale, 0.7f);
    EXPECT_EQ(material.occlusionStrength, 0.8f);
    EXPECT_EQ(material.alphaMode, AlphaMode::Blend);
    EXPECT_EQ(material.alphaCutoff, 0.25f);
    EXPECT_TRUE(material.doubleSided);
    EXPECT_TRUE(material.unlit);
    EXPECT_EQ(material.baseColorTexture.uvSet, 2)
        << "the transform's texCoord replaces the texture's";
    EXPECT_EQ(material.baseColorTexture.offset, vec2(0.1f, 0.2f));
    EXPECT_EQ(material.baseColorTexture.scale, vec2(3, 4));
    EXPECT_EQ(material.baseColorTexture.rotation, 0.5f);
    EXPECT_EQ(material.occlusionTexture.uvSet, 1);
    ASSERT_EQ(scene.textures.size(), 2u);
    ASSERT_EQ(scene.images.size(), 1u) << "one picture, used by two textures";
    EXPECT_EQ(scene.images[0].rgba, (std::vector<uint8_t>{255, 0, 0, 255}));
    const Sampler expected{Filter::Nearest, Filter::Linear, MipFilter::Nearest, Wrap::ClampToEdge,
                           Wrap::MirroredRepeat};
    EXPECT_EQ(scene.textures[size_t(material.normalTexture.texture)].sampler, expected);
    EXPECT_EQ(scene.textures[size_t(material.metallicRoughnessTexture.texture)].sampler, Sampler{})
        << "repeat, linear";
    const Material& plain = scene.materials.at(1);
    EXPECT_EQ(plain.baseColor, vec4(1));
    EXPECT_EQ(plain.metallic, 1) << "glTF's default";
    EXPECT_EQ(plain.specular, 1);
}

TEST(GltfImport, NodesKeepTheirTransformsCamerasAndLights) {
    const auto loaded = importKeys(
        R"("scene": 1, "scenes": [{"nodes": [3]}, {"nodes": [0]}], "extensionsUsed": ["KHR_lights_punctual"],
        "nodes": [{"name": "root", "children": [2, 1], "matrix": [0,1,0,0, -1,0,0,0, 0,0,1,0, 5,0,0,1]},
                  {"name": "eye", "camera": 0, "translation": [1, 2, 3], "rotation": [0, 2, 0, 0], "scale": [1, 1, -1]},
                  {"name": "lamp", "extensions": {"KHR_lights_punctual": {"light": 0}}}, {"name": "other scene"}],
        "cameras": [{"type": "orthographic", "orthographic": {"xmag": 2, "ymag": 3, "znear": 0.5, "zfar": 9}}],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot", "color": [1, 0, 0.5], "intensity": 40, "range": 6,
          "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.3}}]}})");
    ASSERT_TRUE(loaded.ok()) << loaded.message();
    const Scene& scene = loaded->scene;
    ASSERT_EQ(scene.nodes.size(), 3u) << "the scene that is not the default one is left out";
    EXPECT_EQ(scene.nodes[0].name, "root");
    EXPECT_EQ(scene.nodes[1].name, "lamp");
    EXPECT_EQ(scene.nodes[2].name, "eye");
    EXPECT_EQ(scene.activeCamera, 2);
    const auto world = scene.worldTransforms();
    // The root turns +X to +Y: (1,2,3) lands at (-2,1,3) and is moved by 5.
    EXPECT_NEAR(glm::distance(dvec3(world[2][3]), dvec3(3, 1, 3)), 0, 1e-12);
    EXPECT_LT(glm::determinant(dmat3(world[2])), 0) << "mirrored";
    const Camera& camera = scene.cameras.at(0);
    EXPECT_EQ(camera.type, CameraType::Orthographic);
    EXPECT_EQ(camera.ymag, 3);
    EXPECT_EQ(camera.znear, 0.5);
    const Light& light = scene.lights.at(0);
    EXPECT_EQ(light.type, LightType::Spot);
    EXPECT_EQ(light.color, vec3(1, 0, 0.5f));
    EXPECT_EQ(light.intensity, 40);
    EXPECT_EQ(light.range, 6);
    EXPECT_EQ(light.innerConeAngle, 0.1f);
    EXPECT_EQ(light.outerConeAngle, 0.3f);
    EXPECT_EQ(loaded->notes.size(), 2u)
        << "one of two scenes is shown, and a rotation has length 2";
}

TEST(GltfImport, InstancesAreTranslationRotationScale) {
    GltfBuilder builder;
    builder.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
    builder.positions({10, 0, 0, 0, 20, 0});
    builder.add<int16_t>({0, 0, 32767, 0, 0, 0, 0, 32767}, 5122, "VEC4", 4,
                         true); // half a turn about Z; none
    builder.positions({1, 1, 1, 2, 3, 4});
    const auto loaded = builder.import(
        R"(, "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0,
        "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 1, "ROTATION": 2, "SCALE": 3}}}}],
        "extensionsRequired": ["EXT_mesh_gpu_instancing"])");
    ASSERT_TRUE(loaded.ok()) << loaded.message();
    const auto& instances = loaded->scene.nodes.at(0).instances;
    ASSERT_EQ(instances.size(), 2u);
    EXPECT_NEAR(glm::distance(instances[0] * dvec4(1, 2, 3, 1), dvec4(10 - 1, -2, 3, 1)), 0, 1e-12);
    EXPECT_NEAR(glm::distance(instances[1] * dvec4(1, 2, 3, 1), dvec4(2, 20 + 6, 12, 1)), 0, 1e-12);
    // All corners of both instances: x from 9 to 10 and 0 to 2.
    EXPECT_NEAR(loaded->scene.worldBounds().maximum.x, 10, 1e-9);
    EXPECT_NEAR(loaded->scene.worldBounds().maximum.y, 23, 1e-9);
}

TEST(GltfImport, SkinnedMeshTakesItsRestPoseAndNotItsNode) {
    GltfBuilder builder;
    builder.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
    builder.add<uint8_t>({0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, 5121, "VEC4", 4);
    builder.add<float>({1, 0, 0, 0, 1, 0, 0, 0, 0.5, 0.5, 0, 0}, 5126, "VEC4", 4);
    const auto loaded = builder.import(
        R"(, "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2}}]}],
        "skins": [{"joints": [1, 2]}], "nodes": [{"mesh": 0, "skin": 0, "translation": [100, 0, 0]}, {"translation": [0, 0, 3]}, {"translation": [0, 0, 7]}])");
    ASSERT_TRUE(loaded.ok()) << loaded.message();
    const Mesh& mesh = loaded->scene.meshes.at(0);
    EXPECT_EQ(mesh.positions[0], vec3(0, 0, 3));
    EXPECT_EQ(mesh.positions[1], vec3(1, 0, 7));
    EXPECT_EQ(mesh.positions[2], vec3(0, 1, 5)) << "half way between both joints";
    EXPECT_NEAR(loaded->scene.worldBounds().maximum.x, 1, 1e-6)
        << "the node's own transform is ignored (glTF 2.0, 3.7.3.3)";
}

/// The mean of joints at y = 0 to 7, each with an eighth of the weight: 3.5. The first four alone would give 1.5.
TEST(GltfImport, AllSetsOfInfluencesMoveAVertex) {
    GltfBuilder builder;
    builder.positions({0, 0, 0, 1, 0, 0, 0, 0, 1});
    std::vector<uint8_t> first, second;
    for (int vertex = 0; vertex < 3; ++vertex)
        for (uint8_t joint = 0; joint < 4; ++joint) {
            first.push_back(joint);
            second.push_back(uint8_t(joint + 4));
        }
    builder.add(first, 5121, "VEC4", 4);
    builder.add(second, 5121, "VEC4", 4);
    builder.add(std::vector<float>(12, 0.125f), 5126, "VEC4", 4);
    std::string joints, nodes;
    for (int joint = 0; joint < 8; ++joint) {
        joints += fmt::format("{}{}", joint ? ", " : "", joint + 1);
        nodes += fmt::format(R"(, {{"translation": [0, {}, 0]}})", joint);
    }
    const auto loaded = builder.import(
        R"(, "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "JOINTS_0": 1, "JOINTS_1": 2, "WEIGHTS_0": 3, "WEIGHTS_1": 3}}]}],
        "skins": [{"joints": [)" +
        joints + R"(]}], "nodes": [{"mesh": 0, "skin": 0})" + nodes + "]");
    ASSERT_TRUE(loaded.ok()) << loaded.message();
    EXPECT_EQ(loaded->scene.meshes.at(0).positions,
              (std::vector<vec3>{{0, 3.5f, 0}, {1, 3.5f, 0}, {0, 3.5f, 1}}));
}

TEST(GltfImport, RoundingErrorsOutsideOfTheLimitsAreTakenWithANote) {
    const auto loaded = importKeys(
        R"("materials": [{"pbrMetallicRoughness": {"metallicFactor": 1.0000001, "roughnessFactor": -1e-9, "baseColorFactor": [1.000001, 0.5, 0, 1]}}],
        "nodes": [{"matrix": [2,0,0,1e-8, 0,2,0,0, 0,0,2,-1e-7, 3,0,0,0.9999999]}, {"rotation": [0, 0, 0, 1.0000001]}])");
    ASSERT_TRUE(loaded.ok()) << loaded.message();
    const Material& material = loaded->scene.materials.at(0);
    EXPECT_EQ(material.metallic, 1.0f);
    EXPECT_EQ(material.roughness, 0.0f);
    EXPECT_EQ(material.baseColor, vec4(1, 0.5f, 0, 1));
    const dmat4& matrix = loaded->scene.nodes.at(0).matrix.value();
    EXPECT_EQ(dvec4(matrix[0][3], matrix[1][3], matrix[2][3], matrix[3][3]), dvec4(0, 0, 0, 1));
    EXPECT_EQ(matrix[3][0], 3.0);
    EXPECT_EQ(
        loaded->notes,
        (std::vector<std::string>{
            "test.gltf: /materials/0/pbrMetallicRoughness/metallicFactor is 1.0000001, a rounding error outside of glTF's limits; the limit is taken (also in 2 other places)",
            "test.gltf: /nodes/0/matrix has a last row that is not 0, 0, 0, 1, a rounding error outside of glTF's limits; the limit is taken"}));
}

TEST(GltfImport, WhatIsMoreThanARoundingErrorIsRefused) {
    const std::pair<const char*, const char*> cases[] = {
        {R"("materials": [{"pbrMetallicRoughness": {"metallicFactor": 1.001}}])",
         "/materials/0/pbrMetallicRoughness/metallicFactor is 1.001 but must be at most 1"},
        {R"("materials": [{"emissiveFactor": [0, -0.1, 0]}])",
         "/materials/0/emissiveFactor/1 is -0.1 but must be at least 0"},
        {R"("nodes": [{"matrix": [1,0,0,0.001, 0,1,0,0, 0,0,1,0, 0,0,0,1]}])",
         "/nodes/0/matrix is not affine: its last row (elements 3, 7, 11 and 15) must be 0, 0, 0, 1"},
    };
    for (const auto& [keys, sentence] : cases)
        EXPECT_EQ(refusal(importKeys(keys)), sentence) << keys;
}

/// RFC 3986 wants "%25" for '%'; exporters write the name as it is. What the URI means comes first.
TEST(GltfImport, FilesAreFoundByWhatTheirUriMeansElseByItsLetters) {
    const fs::path folder = test::scratchDir("gltf-names");
    const auto loads = [&](const std::string& uri) {
        CHECK(
            writeFileAtomically(
                folder / "test.gltf",
                fmt::format(
                    R"({{"asset": {{"version": "2.0"}}, "buffers": [{{"uri": "{}", "byteLength": 1}}]}})",
                    uri))
                .ok());
        return importGltf(folder / "test.gltf").ok();
    };
    for (const char* name : {"10%.bin", "20%25.bin", "a b.bin", "c+d.bin", "e#f.bin"})
        ASSERT_TRUE(writeFileAtomically(folder / name, "x").ok());
    for (const char* uri : {"10%.bin", "10%25.bin", "20%25.bin", "20%2525.bin", "a b.bin",
                            "a%20b.bin", "c+d.bin", "e#f.bin", "none/../c+d.bin", "./c+d.bin"})
        EXPECT_TRUE(loads(uri)) << uri;
    for (const char* uri : {"30%.bin", "c d.bin", "c+d.bin?v=1", "file:c+d.bin", "%2Fetc%2Fpasswd"})
        EXPECT_FALSE(loads(uri)) << uri;
}

TEST(GltfImport, MorphTargetsTakeTheirDefaultWeights) {
    GltfBuilder builder;
    builder.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
    builder.positions({0, 0, 2, 0, 0, 4, 0, 0, 0});
    const auto loaded = builder.import(
        R"(, "meshes": [{"weights": [0.5], "primitives": [{"attributes": {"POSITION": 0}, "targets": [{"POSITION": 1}]}]}],
        "nodes": [{"mesh": 0}, {"mesh": 0, "weights": [1]}])");
    ASSERT_TRUE(loaded.ok()) << loaded.message();
    const Scene& scene = loaded->scene;
    EXPECT_EQ(scene.meshes[size_t(scene.nodes[0].meshes.at(0))].positions[1], vec3(1, 0, 2));
    EXPECT_EQ(scene.meshes[size_t(scene.nodes[1].meshes.at(0))].positions[1], vec3(1, 0, 4))
        << "a node's weights replace the mesh's";
}

TEST(GltfImport, NonFiniteNumbersInBuffersBecomeZero) {
    GltfBuilder builder;
    builder.positions({0, NAN, 0, INFINITY, 0, 0, 0, 3e38f, 1});
    const auto loaded = builder.import(
        R"(, "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0}])");
    ASSERT_TRUE(loaded.ok()) << loaded.message();
    EXPECT_EQ(loaded->scene.meshes.at(0).positions,
              (std::vector<vec3>{{0, 0, 0}, {0, 0, 0}, {0, 0, 1}}));
    ASSERT_EQ(loaded->notes.size(), 1u);
    EXPECT_NE(loaded->notes[0].find("3 values that are not finite"), std::string::npos)
        << loaded->notes[0];
}

TEST(GltfImport, RefusalsNameThePlace) {
    const std::pair<const char*, const char*> cases[] = {
        {R"("extensionsRequired": ["KHR_texture_basisu"])",
         "/extensionsRequired names 'KHR_texture_basisu', which is not supported"},
        {R"("nodes": [{"mesh": 3}])", "/nodes/0/mesh is 3, but 'meshes' has 0 elements"},
        {R"("nodes": [{"mesh": -1}])", "/nodes/0/mesh is -1 but must be at least 0"},
        {R"("nodes": [{"mesh": 1e300}])", "/nodes/0/mesh is 1e+300 but must be at most 2147483647"},
        {R"("nodes": [{"children": [1]}, {"children": [0]}], "scenes": [{"nodes": [0]}])",
         "/nodes/0 is reached twice; every node must have one parent, and none may be below itself"},
        {R"("nodes": [{"children": [2]}, {"children": [2]}, {}])",
         "/nodes/2 is reached twice; every node must have one parent, and none may be below itself"},
        {R"("nodes": {})", "/nodes is {} but must be of type array"},
        {R"("nodes": [{"translation": [1, 2, 1e31]}])",
         "/nodes/0/translation/2 is 1e+31 but must be at most 1e+30"},
        {R"("buffers": [{"uri": "/etc/passwd", "byteLength": 1}])",
         "/buffers/0/uri is not relative, and only data URIs and relative paths are read"},
        {R"("buffers": [{"uri": "http://example.com/a.bin", "byteLength": 1}])",
         "/buffers/0/uri is not relative, and only data URIs and relative paths are read"},
        {R"("buffers": [{"uri": "file%3A///etc/passwd", "byteLength": 1}])",
         "/buffers/0/uri is not relative, and only data URIs and relative paths are read"},
        {R"("buffers": [{"uri": "no%zz.bin", "byteLength": 1}])",
         "/buffers/0/uri is 'no%zz.bin', but there is no such file"},
        {R"("buffers": [{"uri": "missing.bin", "byteLength": 1}])",
         "/buffers/0/uri is 'missing.bin', but there is no such file"},
        {R"("buffers": [{"uri": "data:application/octet-stream;base64,AA*A", "byteLength": 1}])",
         "/buffers/0/uri is a data URI with a character that is not base64"},
        {R"("buffers": [{"uri": "data:application/octet-stream;base64,AAAA", "byteLength": 4}])",
         "/buffers/0/byteLength is 4, but there are 3 bytes"},
        {R"("cameras": [{"type": "perspective"}], "nodes": [{"camera": 0}])",
         "/cameras/0 is perspective but lacks the key 'perspective'"},
    };
    for (const auto& [keys, sentence] : cases)
        EXPECT_EQ(refusal(importKeys(keys)), sentence) << keys;
    EXPECT_EQ(refusal(importText("{}")), "the file lacks the key 'asset', which is required");
    EXPECT_EQ(refusal(importText(R"({"asset": {"version": "1.0"}})")),
              "/asset/version is '1.0', but only glTF 2.x is read");
    EXPECT_EQ(refusal(importText(std::string("glTF\x02\0\0\0\xff\0\0\0", 12))),
              "the file has 12 bytes but its header says 255; it is cut short");
}

TEST(GltfImport, AccessorsCannotReachOutsideTheirBytes) {
    const std::string head =
        R"({"asset": {"version": "2.0"}, "buffers": [{"uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA", "byteLength": 36}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0}], )";
    const auto with = [&](const char* view, const char* accessor) {
        return refusal(importText(
            head + R"("bufferViews": [{"buffer": 0, )" + view +
            R"(}], "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", )" +
            accessor + "}]}"));
    };
    EXPECT_EQ(with(R"("byteLength": 36)", R"("count": 3)"), "(loaded)");
    EXPECT_EQ(with(R"("byteLength": 37)", R"("count": 3)"),
              "/bufferViews/0 spans bytes 0 to 37 of a buffer of 36");
    EXPECT_EQ(with(R"("byteLength": 1099511627776, "byteOffset": 1099511627776)", R"("count": 3)"),
              "/bufferViews/0 spans bytes 1099511627776 to 2199023255552 of a buffer of 36");
    EXPECT_EQ(with(R"("byteLength": 36)", R"("count": 4)"),
              "/accessors/0 needs 48 bytes from byte 0 on, but its buffer view has 36");
    EXPECT_EQ(with(R"("byteLength": 36)", R"("count": 3, "byteOffset": 4)"),
              "/accessors/0 needs 36 bytes from byte 4 on, but its buffer view has 36");
    EXPECT_EQ(with(R"("byteLength": 36, "byteStride": 4)", R"("count": 3)"),
              "/accessors/0 has elements of 12 bytes, but its buffer view a stride of 4");
    const std::string huge = with(R"("byteLength": 36)", R"("count": 4294967295)");
    EXPECT_NE(huge.find("/accessors/0 would unpack to 12884901885 elements"), std::string::npos)
        << huge;
    EXPECT_NE(
        refusal(
            importText(
                head +
                R"("bufferViews": [], "accessors": [{"componentType": 5126, "type": "VEC3", "count": 3000000000}]})"))
            .find("would unpack"),
        std::string::npos)
        << "an accessor without bytes is zeros, but not any number of them";
}

TEST(GltfImport, IndicesBeyondTheVerticesAreRefused) {
    GltfBuilder builder;
    builder.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
    builder.indices({0, 1, 3});
    EXPECT_EQ(
        refusal(builder.import(
            R"(, "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}], "nodes": [{"mesh": 0}])")),
        "/meshes/0/primitives/0/indices holds 3, but there are 3 vertices");
}

} // namespace
} // namespace tyndall
