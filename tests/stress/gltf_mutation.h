#pragma once
// Damaged copies of good files, by seed: cut short, bits flipped, digits replaced.

#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <filesystem>
#include <random>
#include <string>

#include "core/image.h"
#include "scene/scene_file.h"

namespace tyndall::test {

inline std::string damaged(std::string bytes, uint64_t seed) {
    std::mt19937_64 random(seed);
    const auto below = [&](size_t n) { return size_t(random() % n); };
    if (bytes.empty()) return bytes;
    switch (random() % 4) {
    case 0: bytes.resize(below(bytes.size())); break;
    case 1:
        for (size_t i = 0, n = 1 + below(8); i < n; ++i)
            bytes[below(bytes.size())] ^= char(1 << below(8));
        break;
    case 2: // digits: still valid JSON more often than not, with other numbers in it
        for (size_t i = 0, n = 1 + below(6); i < n; ++i) {
            const size_t start = below(bytes.size());
            const size_t digit = bytes.find_first_of("0123456789", start);
            if (digit != std::string::npos) bytes[digit] = "0123456789-e.,]}"[below(16)];
        }
        break;
    default: // a piece of the file over another piece
        const size_t length = 1 + below(std::min<size_t>(bytes.size(), 64));
        const size_t from = below(bytes.size() - length + 1), to = below(bytes.size() - length + 1);
        bytes.replace(to, length, bytes.substr(from, length));
    }
    return bytes;
}

/// Loaded and sound, or refused with one sentence, in reasonable time.
inline void expectLoadedOrRefused(const std::filesystem::path& path) {
    const std::clock_t start =
        std::clock(); // of the process: other work on the machine does not count
    const auto result = loadScene(path);
    const double seconds = double(std::clock() - start) / CLOCKS_PER_SEC;
    EXPECT_LT(seconds, 20) << "sanitizers included";
    if (!result.ok()) {
        const std::string& message = result.message();
        EXPECT_NE(message.find(path.filename().string()), std::string::npos)
            << "the sentence names the file: " << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        EXPECT_LT(message.size(), 1500u) << message;
        return;
    }
    const Scene& scene = result->scene;
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        ASSERT_LT(scene.nodes[i].parent, int(i));
        for (const int mesh : scene.nodes[i].meshes) ASSERT_LT(size_t(mesh), scene.meshes.size());
        ASSERT_LT(scene.nodes[i].light, int(scene.lights.size()));
        ASSERT_LT(scene.nodes[i].camera, int(scene.cameras.size()));
    }
    for (const Mesh& mesh : scene.meshes) {
        ASSERT_LT(mesh.material, int(scene.materials.size()));
        for (const uint32_t index : mesh.indices) ASSERT_LT(index, mesh.positions.size());
        for (const vec3& p : mesh.positions)
            ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
        for (const vec3& n : mesh.normals)
            ASSERT_TRUE(std::isfinite(n.x) && std::isfinite(n.y) && std::isfinite(n.z));
        for (const vec4& t : mesh.tangents)
            ASSERT_TRUE(std::isfinite(t.x) && std::isfinite(t.y) && std::isfinite(t.z));
    }
    for (const Texture& texture : scene.textures)
        ASSERT_LT(size_t(texture.image), scene.images.size());
    const Bounds bounds = scene.worldBounds();
    if (!bounds.empty()) {
        EXPECT_TRUE(std::isfinite(glm::length(bounds.extent())));
    }
    EXPECT_NE(scene.activeCamera, kNone);
}

} // namespace tyndall::test
