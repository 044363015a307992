// Where the camera goes that a bare glTF file is supplied with: in front of a model, inside of an interior.
#include <gmock/gmock.h>

#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "core/image.h"
#include "scene/scene_file.h"
#include "support/content.h"

namespace tyndall {
namespace {

namespace fs = std::filesystem;

constexpr const char* kInside = "a camera inside the scene, which is closed around its middle";
constexpr const char* kInFront = "a camera that frames the scene";

/// A bare glTF file of triangles; `inward`: they show their fronts to the inside.
LoadedScene bare(const std::vector<vec3>& positions, std::vector<uint32_t> indices, bool inward,
                 const std::string& node = "") {
    if (inward)
        for (size_t i = 0; i < indices.size(); i += 3) std::swap(indices[i], indices[i + 1]);
    const size_t vertexBytes = positions.size() * sizeof(vec3), indexBytes = indices.size() * 4;
    std::string bytes(vertexBytes + indexBytes, '\0');
    std::memcpy(bytes.data(), positions.data(), vertexBytes);
    std::memcpy(bytes.data() + vertexBytes, indices.data(), indexBytes);
    const fs::path folder = test::scratchDir("camera");
    CHECK(writeFileAtomically(folder / "a.bin", bytes).ok());
    const std::string text = fmt::format(
        R"({{"asset": {{"version": "2.0"}}, "buffers": [{{"uri": "a.bin", "byteLength": {}}}],
        "bufferViews": [{{"buffer": 0, "byteLength": {}}}, {{"buffer": 0, "byteOffset": {}, "byteLength": {}}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": {}, "type": "VEC3"}}, {{"bufferView": 1, "componentType": 5125, "count": {}, "type": "SCALAR"}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1}}]}}], "nodes": [{{"mesh": 0{}}}]}})",
        bytes.size(), vertexBytes, vertexBytes, indexBytes, positions.size(), indices.size(), node);
    CHECK(writeFileAtomically(folder / "a.gltf", text).ok());
    return loadScene(folder / "a.gltf").value();
}

/// Corner i has x by bit 0, y by bit 1, z by bit 2; fronts outside. `sides`: 6, or 5 without the one at +Z.
LoadedScene box(const dvec3& low, const dvec3& high, bool inward, int sides = 6,
                const std::string& node = "") {
    std::vector<vec3> corners;
    for (int i = 0; i < 8; ++i)
        corners.emplace_back(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y,
                             i & 4 ? high.z : low.z);
    std::vector<uint32_t> indices = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                                     2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
    indices.resize(size_t(6 * sides));
    return bare(corners, indices, inward, node);
}

LoadedScene sphere(double radius, bool inward) {
    std::vector<vec3> positions;
    std::vector<uint32_t> indices;
    constexpr uint32_t kAround = 24, kDown = 12;
    for (uint32_t j = 0; j <= kDown; ++j)
        for (uint32_t i = 0; i <= kAround; ++i) {
            const double phi = 2 * kPi * i / kAround, theta = kPi * j / kDown;
            positions.emplace_back(radius * std::sin(theta) * std::cos(phi),
                                   radius * std::cos(theta),
                                   radius * std::sin(theta) * std::sin(phi));
        }
    for (uint32_t j = 0; j < kDown; ++j)
        for (uint32_t i = 0; i < kAround; ++i) {
            const uint32_t a = j * (kAround + 1) + i, b = a + 1, c = a + kAround + 1, d = c + 1;
            indices.insert(indices.end(), {a, b, c, b, d, c});
        }
    return bare(positions, indices, inward);
}

TEST(SuppliedCamera, StandsInARoomAtTheHeightOfAnEyeAndLooksAlongIt) {
    // 12 m long in X, 3 m high, 4 m wide.
    const LoadedScene loaded = box({-6, 0, -2}, {6, 3, 2}, true);
    EXPECT_THAT(loaded.supplied, ::testing::Contains(kInside));
    const Scene& scene = loaded.scene;
    const dmat4 pose = scene.worldTransforms()[size_t(scene.activeCamera)];
    EXPECT_TRUE((Bounds{{-6, 0, -2}, {6, 3, 2}}.contains(dvec3(pose[3]))));
    EXPECT_NEAR(pose[3].y, 1.5, 1e-9) << "half of a height below 3.2 m";
    // The longest ways free are the diagonals of the plan, 18° from X; rays are 3.75° apart.
    EXPECT_GT(std::abs(pose[2].x), std::cos(glm::radians(22.5)));
    EXPECT_NEAR(pose[2].y, 0, 1e-12) << "level";
    const Camera& camera = scene.cameras[size_t(scene.nodes[size_t(scene.activeCamera)].camera)];
    EXPECT_THAT(loaded.supplied, ::testing::Contains(::testing::HasSubstr("a lamp of")));
    EXPECT_GT(camera.znear, 0);
    EXPECT_LT(camera.znear, 0.1) << "metres: nothing in a room is nearer than the walls";
}

TEST(SuppliedCamera, HoldsInOtherUnitsAndMirrored) {
    // The same room in centimetres: the eye is at the same part of its height.
    const Scene room = box({-600, 0, -200}, {600, 300, 200}, true).scene;
    const double y = room.worldTransforms()[size_t(room.activeCamera)][3].y;
    EXPECT_GT(y, 0.1 * 300);
    EXPECT_LE(y, 0.5 * 300);
    // A mirror turns what is modelled as a solid inside out, and back by the sign of its determinant (glTF 2.0, 3.7.4).
    EXPECT_THAT(box({-6, 0, -2}, {6, 3, 2}, true, 6, R"(, "scale": [-1, 1, 1])").supplied,
                ::testing::Contains(kInside));
    EXPECT_THAT(box({-6, 0, -2}, {6, 3, 2}, false, 6, R"(, "scale": [-1, 1, 1])").supplied,
                ::testing::Contains(kInFront));
}

TEST(SuppliedExposure, InARoomIsForWhatTheLampLights) {
    // Around the middle of a ball all that is seen is as far from the lamp, which brings 10 lux to what faces it and half of that on the mean.
    EXPECT_NEAR(double(sphere(2, true).scene.ev100), std::log2(10 * 0.5 / 2.5), 0.25);
    // The sun and the sky do not come in, and a room has no size that counts.
    const float room = box({-6, 0, -2}, {6, 3, 2}, true).scene.ev100;
    EXPECT_EQ(box({-600, 0, -200}, {600, 300, 200}, true).scene.ev100, room);
    EXPECT_LT(double(room), std::log2(10 / 2.5))
        << "most of it is further from the lamp than the nearest wall";
    // Outside the sun's 10 lux and the sky's π/2 arrive.
    EXPECT_NEAR(double(sphere(2, false).scene.ev100), std::log2((10 + 0.5 * kPi) / 2.5), 0.25);
}

TEST(SuppliedCamera, StaysInFrontOfModels) {
    EXPECT_THAT(sphere(2, false).supplied, ::testing::Contains(kInFront));
    EXPECT_THAT(sphere(2, true).supplied, ::testing::Contains(kInside));
    EXPECT_THAT(box({-6, 0, -2}, {6, 3, 2}, false).supplied, ::testing::Contains(kInFront));
    EXPECT_THAT(box({-1, -1, -1}, {1, 1, 1}, true, 5).supplied, ::testing::Contains(kInFront))
        << "a box that is open to the front is looked into";
    const auto man = REQUIRE_CONTENT("gltf/compressed/CesiumMan-quantized.glb");
    EXPECT_THAT(loadScene(man).value().supplied, ::testing::Contains(kInFront));
    const auto sponza = REQUIRE_CONTENT("sponza/Sponza.gltf");
    EXPECT_THAT(loadScene(sponza).value().supplied, ::testing::Contains(kInside));
}

} // namespace
} // namespace tyndall
