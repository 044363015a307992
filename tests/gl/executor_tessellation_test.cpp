// Tessellated patches, captured: how many points there are and where they lie (OpenGL 4.5, section 11.2.2).
#include <cmath>

#include "executor_points_fixture.h"

namespace tyndall::fg {
namespace {

struct Levels {
    float outer[3], inner; // as the block Params of capture/level.tesc
};
struct Surfel {
    float position[4], weights[4];
};
/// A triangle of no particular shape, and another beside it.
const std::vector<std::array<float, 4>> kCorners = {{0, 0, 0, 1}, {3, 1, 0, 1}, {1, 2, 5, 1},
                                                    {4, 4, 4, 1}, {7, 4, 5, 1}, {4, 9, 4, 1}};

/// Corners of a triangle to weights of its vertices: `steps` of `n` from the outside to the inside.
std::array<std::array<double, 3>, 3> ringCorners(int n, int steps) {
    // Lines at right angles to two edges, from the first of n steps along each, meet on the bisector at 2/(n√3) of an edge, that is 4/(3n)
    // of the height: the corner's own weight is 1 − 4/(3n), the others share the rest.
    const double own = 1 - 4.0 * steps / (3.0 * n), other = (1 - own) / 2;
    return {{{own, other, other}, {other, own, other}, {other, other, own}}};
}

/// The weights of all points for one level n at all edges and inside, from the text of the specification.
std::vector<std::array<double, 3>> expectedWeights(int n) {
    std::vector<std::array<double, 3>> all;
    for (int ring = 0; n - 2 * ring >= 0; ++ring) {
        const auto corners = ringCorners(n, ring);
        const int segments = n - 2 * ring;
        if (segments == 0) all.push_back(corners[0]);
        for (int edge = 0; edge < 3; ++edge)
            for (int i = 0; i < segments; ++i) {
                const double t = double(i) / segments;
                std::array<double, 3> weights{};
                for (size_t k = 0; k < 3; ++k)
                    weights[k] =
                        (1 - t) * corners[size_t(edge)][k] + t * corners[size_t(edge + 1) % 3][k];
                all.push_back(weights);
            }
    }
    return all;
}

/// Points of one patch: outer edges as their levels say, then the rings inside, down to a triangle or to one point.
int expectedPoints(const Levels& levels) {
    const auto up = [](float level) { return int(std::ceil(std::max(level, 1.0f))); };
    const int outer = up(levels.outer[0]) + up(levels.outer[1]) + up(levels.outer[2]);
    int inner = up(levels.inner);
    if (inner == 1 && outer == 3) return 3;
    if (inner == 1) inner = 2; // the specification's 1 + ε, rounded up
    int inside = inner % 2 == 0 ? 1 : 0;
    for (int segments = inner - 2; segments > 0; segments -= 2) inside += 3 * segments;
    return outer + inside;
}

class ExecutorTessellationTest : public ExecutorPointsTest {
protected:
    struct Result {
        std::vector<Surfel> surfels;
        uint32_t count;
    };
    /// Points, or triangles, that the first `vertices` of kCorners become.
    Result tessellate(const Levels& levels, uint32_t vertices, bool asPoints = true) {
        struct Pass {
            BufferHandle corners, surfels, count;
            Levels levels;
            uint32_t vertices;
            int asPoints;
        };
        begin();
        const BufferHandle corners = uploaded("corners", kCorners);
        const Pass& pass = graph().addPass<Pass>(
            "surfelize",
            [&](Builder& b, Pass& d) {
                d.corners = b.read(corners);
                d.surfels =
                    b.create("surfels", BufferDesc{40000 * sizeof(Surfel)}, Access::Capture);
                d.count = b.create("count", BufferDesc{4}, Access::Capture);
                d.levels = levels;
                d.vertices = vertices;
                d.asPoints = asPoints ? 1 : 0;
            },
            [](const Pass& d, PassContext& c) {
                c.raster({.vertex = "capture/corner.vert",
                          .tessControl = "capture/level.tesc",
                          .tessEvaluation = "capture/point.tese"},
                         {{"POINTS", d.asPoints}})
                    .bind("Corners", d.corners)
                    .params(d.levels)
                    .capture(d.surfels, d.count)
                    .draw(d.vertices);
            });
        graph().markOutput(pass.surfels);
        graph().markOutput(pass.count);
        run();
        EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
        Result result{valuesOf<Surfel>(pass.surfels), valuesOf<uint32_t>(pass.count)[0]};
        result.surfels.resize(result.count * (asPoints ? 1u : 3u));
        return result;
    }
};
TYNDALL_GL_TESTS(ExecutorTessellationTest);

TEST_P(ExecutorTessellationTest, PointModeMakesAsManyPointsAsTheSpecificationCounts) {
    std::vector<Levels> cases = {{{1, 1, 1}, 3},          {{2, 3, 4}, 1},    {{5, 1, 1}, 6},
                                 {{2.3f, 3, 4.9f}, 4.2f}, {{0.5f, 1, 1}, 1}, {{64, 64, 64}, 64.0f}};
    for (int n = 1; n <= 9; ++n) cases.push_back({{float(n), float(n), float(n)}, float(n)});
    for (const Levels& levels : cases) {
        SCOPED_TRACE(::testing::Message() << levels.outer[0] << " " << levels.outer[1] << " "
                                          << levels.outer[2] << ", inside " << levels.inner);
        EXPECT_EQ(tessellate(levels, 3).count, uint32_t(expectedPoints(levels)));
        EXPECT_EQ(tessellate(levels, 6).count, 2 * uint32_t(expectedPoints(levels)));
    }
}

TEST_P(ExecutorTessellationTest, NoPatchesMakeNoPoints) {
    EXPECT_EQ(tessellate({{4, 4, 4}, 4}, 0).count, 0u);
    EXPECT_EQ(tessellate({{0, 4, 4}, 4}, 6).count, 0u) << "an outer level of 0 drops the patch";
    EXPECT_EQ(tessellate({{4, 4, 4}, 4}, 2).count, 0u) << "two vertices are no patch";
}

TEST_P(ExecutorTessellationTest, PointsLieWhereTheSpecificationPutsThem) {
    for (const int n : {1, 2, 3, 4, 5, 8}) {
        const float level = float(n);
        const Result result = tessellate({{level, level, level}, level}, 3);
        const std::vector<std::array<double, 3>> expected = expectedWeights(n);
        ASSERT_EQ(result.surfels.size(), expected.size()) << "level " << n;
        for (const auto& weights : expected) {
            int found = 0;
            for (const Surfel& surfel : result.surfels) {
                double distance = 0;
                for (size_t k = 0; k < 3; ++k)
                    distance = std::max(distance, std::abs(weights[k] - double(surfel.weights[k])));
                // Tessellators compute in fixed point with 16 bits after the point; a few such steps add up.
                found += distance < 1e-4;
            }
            EXPECT_EQ(found, 1) << "level " << n << ", point " << weights[0] << " " << weights[1];
        }
    }
}

TEST_P(ExecutorTessellationTest, PointsLieInsideTheirTriangles) {
    const Result result = tessellate({{5, 6, 7}, 8}, 6);
    ASSERT_GT(result.count, 0u);
    for (const Surfel& surfel : result.surfels) {
        const size_t first = surfel.position[3] == 0 ? 0 : 3;
        float sum = 0;
        for (size_t k = 0; k < 3; ++k) {
            EXPECT_GE(surfel.weights[k], 0);
            sum += surfel.weights[k];
            float expected = 0;
            for (size_t corner = 0; corner < 3; ++corner)
                expected += surfel.weights[corner] * kCorners[first + corner][k];
            EXPECT_NEAR(surfel.position[k], expected,
                        4e-6f) // coordinates up to 9: four roundings of 2^-21
                << "the evaluation shader's own sum";
        }
        EXPECT_NEAR(sum, 1, 1e-6f); // one rounding a weight
    }
    // Patches come in order.
    EXPECT_TRUE(std::ranges::is_sorted(result.surfels, {},
                                       [](const Surfel& surfel) { return surfel.position[3]; }));
    EXPECT_EQ(result.surfels.back().position[3], 1);
}

TEST_P(ExecutorTessellationTest, TwoRunsGiveTheSameBits) {
    const Result first = tessellate({{9, 6.5f, 7}, 11}, 6),
                 second = tessellate({{9, 6.5f, 7}, 11}, 6);
    ASSERT_EQ(first.count, second.count);
    ASSERT_GT(first.count, 0u);
    EXPECT_EQ(std::memcmp(first.surfels.data(), second.surfels.data(),
                          first.surfels.size() * sizeof(Surfel)),
              0);
}

TEST_P(ExecutorTessellationTest, WithoutPointModeTrianglesAreCapturedAndCounted) {
    // Between two rings of 3m and 3(m − 2) edges lies a triangle for each edge; the innermost ring is one triangle or a point.
    for (const int n : {1, 2, 3, 4, 7}) {
        uint32_t expected = 0;
        for (int m = n; m > 0; m -= 2) expected += m == 1 ? 1 : uint32_t(6 * m - 6);
        const float level = float(n);
        const Result result = tessellate({{level, level, level}, level}, 3, false);
        EXPECT_EQ(result.count, expected) << "level " << n;
        // They cover the triangle once: their areas, in weights, sum to that of the whole.
        double area = 0;
        for (size_t i = 0; i + 2 < result.surfels.size(); i += 3) {
            const auto at = [&](size_t vertex, int k) {
                return double(result.surfels[i + vertex].weights[k]);
            };
            area += std::abs((at(1, 0) - at(0, 0)) * (at(2, 1) - at(0, 1)) -
                             (at(2, 0) - at(0, 0)) * (at(1, 1) - at(0, 1)));
        }
        EXPECT_NEAR(area, 1, 1e-4); // fixed point, as above
    }
}

TEST_P(ExecutorTessellationTest, PatchesHaveAsManyVerticesAsTheStateSays) {
    library().addSource("test/plain.vert", "void main() { gl_Position = vec4(0); }\n");
    library().addSource("test/quad.tesc",
                        "layout(vertices = 4) out;\nvoid main() {\n"
                        "  for (int i = 0; i < 4; ++i) gl_TessLevelOuter[i] = 3.0;\n"
                        "  gl_TessLevelInner[0] = gl_TessLevelInner[1] = 3.0; }\n");
    library().addSource("test/quad.tese", "layout(quads, equal_spacing, point_mode) in;\n"
                                          "layout(xfb_offset = 0) out float patchNumber;\n"
                                          "void main() { patchNumber = float(gl_PrimitiveID); }\n");
    struct Quads {
        BufferHandle points, count;
    };
    begin();
    const Quads& pass = graph().addPass<Quads>(
        "quads",
        [](Builder& b, Quads& d) {
            d.points = b.create("points", BufferDesc{4 * 64}, Access::Capture);
            d.count = b.create("count", BufferDesc{4}, Access::Capture);
        },
        [](const Quads& d, PassContext& c) {
            RasterState state;
            state.patchVertices = 4;
            c.raster({.vertex = "test/plain.vert",
                      .tessControl = "test/quad.tesc",
                      .tessEvaluation = "test/quad.tese"})
                .state(state)
                .capture(d.points, d.count)
                .draw(12);
        });
    graph().markOutput(pass.points);
    graph().markOutput(pass.count);
    run();
    EXPECT_EQ(valuesOf<uint32_t>(pass.count)[0], 3u * 4 * 4) << "three patches of 4 by 4 points";
    for (size_t i = 0; i < 48; ++i) EXPECT_EQ(valuesOf<float>(pass.points)[i], float(i / 16));
}

TEST_P(ExecutorTessellationTest, AChangedStageIsMadeAnew) {
    EXPECT_EQ(tessellate({{2, 2, 2}, 2}, 3).count, 7u);
    library().addSource("capture/level.tesc",
                        "layout(vertices = 3) out;\nin vec3 cornerIn[];\nout vec3 corner[];\n"
                        "layout(std140) uniform Params { vec4 levels; };\nvoid main() {\n"
                        "  corner[gl_InvocationID] = cornerIn[gl_InvocationID];\n"
                        "  for (int i = 0; i < 3; ++i) gl_TessLevelOuter[i] = levels[i] + 1.0;\n"
                        "  gl_TessLevelInner[0] = levels.w + 1.0; }\n");
    EXPECT_EQ(library().pollChanges(), 1);
    EXPECT_EQ(tessellate({{2, 2, 2}, 2}, 3).count, 12u);
}

} // namespace
} // namespace tyndall::fg
