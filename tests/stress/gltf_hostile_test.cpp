// What nobody should feed a loader, and everybody does.
#include <gtest/gtest.h>

#include "gltf_mutation.h"
#include "support/content.h"

namespace tyndall {
namespace {

namespace fs = std::filesystem;
using test::expectLoadedOrRefused;

constexpr uint64_t kCopies = 1000;

/// `count` damaged copies of the file `name` of `folder`, its neighbours intact beside it.
void damageAndLoad(const fs::path& folder, const std::string& name, uint64_t count,
                   uint64_t firstSeed) {
    const fs::path scratch = test::scratchDir("gltf-damaged");
    for (const auto& entry : fs::directory_iterator(folder)) {
        // Not copy_file: it would copy that the originals are read-only, too.
        if (entry.is_regular_file() && entry.file_size() < 200000) {
            ASSERT_TRUE(writeFileAtomically(scratch / entry.path().filename(),
                                            readFile(entry.path()).value())
                            .ok());
        }
    }
    const std::string good = readFile(folder / name).value();
    for (uint64_t i = 0; i < count; ++i) {
        SCOPED_TRACE(name + ", seed " + std::to_string(firstSeed + i));
        ASSERT_TRUE(writeFileAtomically(scratch / name, test::damaged(good, firstSeed + i)).ok());
        expectLoadedOrRefused(scratch / name);
        if (::testing::Test::HasFatalFailure()) return;
    }
    ASSERT_TRUE(writeFileAtomically(scratch / name, good).ok());
    EXPECT_TRUE(loadScene(scratch / name).ok()) << "the file as it was loads";
}

TEST(GltfHostile, FilesOfTheKhronosValidatorAreLoadedOrRefused) {
    const fs::path root = REQUIRE_CONTENT("invalid-gltf/khronos-validator");
    size_t files = 0, loaded = 0;
    for (const auto& entry : fs::recursive_directory_iterator(root)) {
        if (entry.path().extension() != ".gltf" && entry.path().extension() != ".glb") continue;
        SCOPED_TRACE(entry.path().string());
        ++files;
        expectLoadedOrRefused(entry.path());
        loaded += loadScene(entry.path()).ok() ? 1 : 0;
    }
    EXPECT_EQ(files, 372u);
    std::printf("%zu of %zu files were loaded, the others refused\n", loaded, files);
}

TEST(GltfHostile, DamagedGlbFiles) {
    const fs::path folder = REQUIRE_CONTENT("gltf/compressed");
    damageAndLoad(folder, "BoxTextured-quantized.glb", kCopies / 2, test::seed());
    damageAndLoad(folder, "BoxTextured-meshopt.glb", kCopies / 2, test::seed() + kCopies);
}

TEST(GltfHostile, DamagedDracoFiles) {
    const fs::path folder = REQUIRE_CONTENT("gltf/ext");
    damageAndLoad(folder, "heart_draco.glb", kCopies, test::seed());
}

TEST(GltfHostile, DamagedGltfFiles) {
    const fs::path models = REQUIRE_CONTENT("gltf/khronos");
    for (const char* model : {"BoxTextured", "RiggedSimple", "SimpleSparseAccessor", "MultiUVTest",
                              "MorphPrimitivesTest"})
        damageAndLoad(models / model, std::string(model) + ".gltf", kCopies / 5, test::seed());
    for (const char* binary :
         {"BoxTextured0.bin", "CesiumLogoFlat.png"}) { // the neighbours damaged
        const fs::path scratch = test::scratchDir("gltf-neighbours");
        for (const auto& entry : fs::directory_iterator(models / "BoxTextured"))
            ASSERT_TRUE(writeFileAtomically(scratch / entry.path().filename(),
                                            readFile(entry.path()).value())
                            .ok());
        const std::string good = readFile(models / "BoxTextured" / binary).value();
        for (uint64_t i = 0; i < kCopies / 4; ++i) {
            SCOPED_TRACE(std::string(binary) + ", seed " + std::to_string(test::seed() + i));
            ASSERT_TRUE(
                writeFileAtomically(scratch / binary, test::damaged(good, test::seed() + i)).ok());
            expectLoadedOrRefused(scratch / "BoxTextured.gltf");
        }
    }
}

TEST(GltfHostile, SmallFilesCannotAskForMuch) {
    const fs::path path = test::scratchDir("gltf-bombs") / "bomb.gltf";
    const auto refused = [&](const std::string& keys) {
        EXPECT_TRUE(
            writeFileAtomically(path, R"({"asset": {"version": "2.0"}, )" + keys + "}").ok());
        const auto result = loadScene(path);
        EXPECT_FALSE(result.ok()) << keys.substr(0, 200);
    };
    const std::string zeros =
        R"("accessors": [{"componentType": 5126, "type": "VEC3", "count": 4000000}], )";
    std::string primitives, nodes;
    for (int i = 0; i < 10000; ++i)
        primitives += std::string(i ? "," : "") + R"({"attributes": {"POSITION": 0}})";
    refused(zeros + R"("meshes": [{"primitives": [)" + primitives +
            R"(]}], "nodes": [{"mesh": 0}])");
    refused(
        R"("accessors": [{"componentType": 5126, "type": "VEC3", "count": 3}, {"componentType": 5126, "type": "VEC3", "count": 4000000000}],
               "nodes": [{"extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 1}}}}])");
    refused(
        R"("bufferViews": [{"buffer": 0, "byteLength": 8, "extensions": {"EXT_meshopt_compression": {"buffer": 0, "byteLength": 8,
               "byteStride": 256, "count": 4294967295, "mode": "ATTRIBUTES"}}}], "buffers": [{"byteLength": 8, "uri": "data:;base64,oAAAAAAAAAA="}],
               "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3}],
               "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0}])");
    refused(R"("nodes": )" + std::string(100000, '['));
    refused(R"("extras": )" + std::string(100000, '[') + std::string(100000, ']'));
    // A chain of nodes as deep as a file can make it is no problem.
    for (int i = 0; i < 50000; ++i)
        nodes += (i ? ", " : "") + (i < 49999 ? R"({"children": [)" + std::to_string(i + 1) + "]}"
                                              : std::string("{}"));
    ASSERT_TRUE(
        writeFileAtomically(
            path, R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [)" +
                      nodes + "]}")
            .ok());
    expectLoadedOrRefused(path);
    EXPECT_TRUE(loadScene(path).ok());
}

/// What tinygltf 2.7 refuses, though glTF 2.0 allows it or it does no harm.
TEST(GltfHostile, WhatTinygltfRefusesIsLoadedWhereItIsSound) {
    const fs::path path = test::scratchDir("gltf-tinygltf") / "model.gltf";
    for (
        const char* keys :
        {R"("buffers": [{"byteLength": 8}], "bufferViews": [{"buffer": 0, "byteLength": 8, "byteStride": 3}])",
         R"("buffers": [{"byteLength": 1, "uri": "data:image/webp;base64,AAAA"}])",
         R"("images": [{}, {"uri": "data:image/webp;base64,AAAA"}, {"uri": "none.png"}])",
         R"("animations": [{"samplers": [{}]}, {"channels": 7}])",
         R"("cameras": [{"type": "orthographic", "orthographic": {"ymag": 1, "znear": 0}}], "nodes": [{"camera": 0}])",
         R"("extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot"}]}},
            "nodes": [{"extensions": {"KHR_lights_punctual": {"light": 0.0}}}])",
         R"("extras": {"a": [null, 1e300, {"b": {}}]}, "extensions": {"VENDOR_x": {"y": [[[[1]]]]}})"}) {
        SCOPED_TRACE(keys);
        ASSERT_TRUE(
            writeFileAtomically(path, R"({"asset": {"version": "2.0"}, )" + std::string(keys) + "}")
                .ok());
        const auto loaded = loadScene(path);
        EXPECT_TRUE(loaded.ok()) << loaded.message();
    }
}

} // namespace
} // namespace tyndall
