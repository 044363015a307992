// The scene as techniques share it for rays: what a second update costs, and what stands between two points as shaders find it, against Embree.

#include <random>

#include "gl/api.h"
#include "gl/gl_fixture.h"
#include "shaders/table_compute.h"
#include "support/content.h"
#include "support/render.h"
#include "volumetric_gi/shared/traced_scene.h"

namespace tyndall::test {
namespace {

using namespace volumetric_gi;

const char* const kRoomWithFog = R"({"tyndall": 1, "nodes": [
    {"name": "floor", "primitive": {"shape": "box", "size": [4, 0.1, 4]}, "translation": [0, -0.05, 0]},
    {"name": "left", "primitive": {"shape": "box", "size": [0.1, 3, 4]}, "translation": [-2, 1.5, 0]},
    {"name": "ball", "primitive": {"shape": "sphere", "size": [0.8, 0.8, 0.8]}, "translation": [0.8, 0.4, -0.5]},
    {"name": "board", "primitive": {"shape": "box", "size": [1, 1, 0.02]}, "translation": [-0.5, 1, 0]},
    {"name": "lamp", "light": {"type": "point", "intensity": 100}, "translation": [0, 2.5, 0]},
    {"name": "fog", "scale": [4, 3, 4], "medium": {"type": "homogeneous", "shape": "box", "scattering": [0.3, 0.3, 0.3]}, "translation": [0, 1.5, 0]}
    ]})";

plugin::FrameInputs inputsOf(const Scene& scene) {
    plugin::FrameInputs inputs{};
    inputs.whole = &scene;
    return inputs;
}

TEST(TracedScene, AskedAgainNothingIsMadeAnew) {
    Scene scene = sceneFromJson(kRoomWithFog);
    const plugin::FrameInputs inputs = inputsOf(scene);
    TracedScene traced;
    ASSERT_TRUE(traced.update(inputs, {}).ok());
    const auto* const lights = traced.scene().lights.get();
    const uint64_t key = traced.key();
    ASSERT_TRUE(traced.update(inputs, {}).ok());
    EXPECT_EQ(traced.scene().lights.get(), lights);
    EXPECT_EQ(traced.key(), key);
}

TEST(TracedScene, TechniquesWithOtherOptionsShareSurfacesAndKeepTheGuessesOfMedia) {
    Scene scene = sceneFromJson(kRoomWithFog);
    const plugin::FrameInputs inputs = inputsOf(scene);
    TracedScene traced;
    ASSERT_TRUE(traced.update(inputs, {.proxyMedia = true}).ok());
    const auto* const surfaces = traced.scene().surfaces.get();
    const auto* const proxies = traced.scene().media.get();
    const uint64_t walks = traced.walksKey();
    EXPECT_NE(proxies, &traced.media());
    ASSERT_TRUE(traced.update(inputs, {}).ok());
    EXPECT_EQ(traced.scene().media.get(), &traced.media());
    EXPECT_NE(traced.scene().media.get(), proxies);
    ASSERT_TRUE(traced.update(inputs, {.proxyMedia = true}).ok());
    EXPECT_EQ(traced.scene().surfaces.get(), surfaces);
    EXPECT_EQ(traced.scene().media.get(), proxies); // what kept walks name
    EXPECT_EQ(traced.walksKey(), walks);
}

using TracedVisibility = GlTest;
TYNDALL_GL_TESTS(TracedVisibility);

struct Pair {
    dvec3 from, to;
};

/// Is the answer the same for all ways near by, and for one that is shorter by `margin` at both ends? Else it is one of rounding.
bool isClear(const tracing::SurfaceScene& surfaces, const Pair& pair, bool hidden, double margin) {
    for (int i = 0; i < 8; ++i) {
        const dvec3 off = margin * (2.0 * dvec3(i & 1, (i >> 1) & 1, i >> 2) - 1.0);
        const dvec3 from = pair.from + off, way = pair.to - from;
        const double length = glm::length(way);
        if (surfaces.occluded({from + way * (margin / length), way / length}, length - 2 * margin,
                              0) != hidden)
            return false;
    }
    return true;
}

TEST_P(TracedVisibility, IsThatOfRays) {
    const Scene scene = sceneFromJson(kRoomWithFog);
    TracedScene traced;
    ASSERT_TRUE(traced.update(inputsOf(scene), {}).ok());
    const tracing::SurfaceScene& surfaces = *traced.scene().surfaces;
    std::mt19937_64 random(uint64_t(seed()) + 5);
    std::uniform_real_distribution<double> across(-3, 3), up(-0.5, 3);
    std::vector<Pair> pairs;
    std::vector<bool> hidden;
    std::vector<vec4> inputs;
    constexpr double kMargin = 3e-3; // the query's own rounding is 1e-4 of some 10 m
    while (pairs.size() < 2000) {
        const Pair pair{{across(random), up(random), across(random)},
                        {across(random), up(random), across(random)}};
        const double length = glm::distance(pair.from, pair.to);
        if (length < 4 * kMargin) continue;
        const bool found =
            surfaces.occluded({pair.from, (pair.to - pair.from) / length}, length, 0);
        if (!isClear(surfaces, pair, found, kMargin)) continue;
        pairs.push_back(pair);
        hidden.push_back(found);
        inputs.insert(inputs.end(), {vec4(vec3(pair.from), 0), vec4(vec3(pair.to), 0)});
    }
    const gpu::TracedParams params{uint32_t(traced.tree().size()), 0, 0, 0};
    const gl::Buffer block("params", std::as_bytes(std::span(&params, 1))),
        triangles("triangles", std::as_bytes(std::span(traced.triangles()))),
        tree("tree", std::as_bytes(std::span(traced.tree())));
    gl::ShaderLibrary library;
    const std::vector<vec4> found = runTable(
        library, {"gi/shared/visibility.glsl"},
        "outputs[id] = vec4(triangleBetween(inputs[2u * id].xyz, inputs[2u * id + 1u].xyz));",
        inputs, pairs.size(), uint32_t(pairs.size()), [&](const gl::Program& program) {
            glBindBufferBase(GL_UNIFORM_BUFFER, GLuint(program.find("Traced")->binding),
                             block.id());
            bindStorage(program, "TracedTriangles", triangles);
            bindStorage(program, "TracedTree", tree);
        });
    size_t among = 0;
    for (size_t i = 0; i < pairs.size(); ++i) {
        EXPECT_EQ(found[i].x != 0, hidden[i]) << i;
        among += hidden[i];
    }
    // Neither answer is rare.
    EXPECT_GT(among, pairs.size() / 10);
    EXPECT_LT(among, pairs.size() * 9 / 10);
}

} // namespace
} // namespace tyndall::test
