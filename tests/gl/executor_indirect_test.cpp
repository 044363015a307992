// Counts that shaders decide, draws that go nowhere, and sums of many points.
#include <algorithm>
#include <limits>

#include "executor_points_fixture.h"

namespace tyndall::fg {
namespace {

using ::testing::HasSubstr;

struct Draw {
    BufferHandle arguments;
    TextureHandle color;
    uint64_t offset;
};
constexpr float kBlack[4] = {0, 0, 0, 0};

class ExecutorIndirectTest : public ExecutorPointsTest {
protected:
    /// A row of pixels to which the points of `arguments` are added (points/add.vert).
    TextureHandle drawPoints(BufferHandle arguments, int width, uint64_t offset = 0) {
        return graph()
            .addPass<Draw>(
                "draw",
                [&](Builder& b, Draw& d) {
                    d.arguments = b.read(arguments, Access::Indirect);
                    d.color = b.create("color", color(width, 1), Access::ColorTarget);
                    d.offset = offset;
                },
                [](const Draw& d, PassContext& c) {
                    c.clearTexture(d.color, kBlack);
                    const Target targets[] = {{d.color}};
                    RasterState state = points();
                    state.blend = BlendMode::Add;
                    c.raster("points/add.vert", "points/add.frag")
                        .colors(targets)
                        .state(state)
                        .set("width", c.desc(d.color).width)
                        .drawIndirect(d.arguments, d.offset);
                })
            .color;
    }
};
TYNDALL_GL_TESTS(ExecutorIndirectTest);

TEST_P(ExecutorIndirectTest, TheBufferSaysHowMuchIsDrawn) {
    // Words before the arguments, then vertices, instances, first vertex.
    for (const DrawArguments& expected : {DrawArguments{40, 1, 0, 0}, DrawArguments{0, 1, 0, 0},
                                          DrawArguments{40, 0, 0, 0}, DrawArguments{5, 3, 20, 0}}) {
        begin();
        const std::vector<uint32_t> words = {9, expected.vertexCount, expected.instanceCount,
                                             expected.firstVertex, expected.baseInstance};
        const TextureHandle out = drawPoints(uploaded("arguments", words), 1, 4);
        graph().markOutput(out);
        run();
        const uint32_t points = expected.vertexCount * expected.instanceCount;
        uint32_t sum = 0;
        for (uint32_t i = 0; i < expected.vertexCount; ++i) sum += expected.firstVertex + i;
        const Image image = executor().readImage(out);
        EXPECT_EQ(image.at(0, 0)[0], float(points));
        EXPECT_EQ(image.at(0, 0)[1], float(sum * expected.instanceCount));
    }
}

TEST_P(ExecutorIndirectTest, ABarrierStandsBeforeArgumentsThatAShaderWrote) {
    library().addSource(
        "test/arguments.comp",
        "layout(local_size_x = 1) in;\n"
        "layout(std430) buffer Arguments { uint arguments[4]; };\nuniform int points;\n"
        "void main() { arguments[0] = uint(points); arguments[1] = 1u;\n"
        "  arguments[2] = 0u; arguments[3] = 0u; }\n");
    for (const int points : {12, 0, 5000}) {
        struct Arguments {
            BufferHandle out;
            int points;
        };
        begin();
        const Arguments& arguments = graph().addPass<Arguments>(
            "arguments",
            [&](Builder& b, Arguments& d) {
                d.out = b.create("arguments", BufferDesc{sizeof(DrawArguments)});
                d.points = points;
            },
            [](const Arguments& d, PassContext& c) {
                c.compute("test/arguments.comp")
                    .bind("Arguments", d.out)
                    .set("points", d.points)
                    .dispatch(1);
            });
        const TextureHandle out = drawPoints(arguments.out, 1);
        graph().markOutput(out);
        run();
        EXPECT_EQ(executor().compiled().passes[1].barriers, GLuint(GL_COMMAND_BARRIER_BIT));
        EXPECT_EQ(executor().readImage(out).at(0, 0)[0], float(points));
    }
}

TEST_P(ExecutorIndirectTest, WhatWasCapturedIsDrawnWithoutAReadBack) {
    struct Capture {
        BufferHandle numbers, arguments;
        uint32_t points;
    };
    for (const uint32_t points : {33u, 0u}) {
        begin();
        const Capture& capture = graph().addPass<Capture>(
            "capture",
            [&](Builder& b, Capture& d) {
                d.numbers = b.create("numbers", BufferDesc{12 * 20}, Access::Capture);
                d.arguments =
                    b.create("arguments", BufferDesc{sizeof(DrawArguments)}, Access::Capture);
                d.points = points;
            },
            [](const Capture& d, PassContext& c) {
                const DrawArguments arguments;
                c.upload(d.arguments, 0, &arguments, sizeof arguments);
                c.raster({.vertex = "capture/number.vert"})
                    .state(ExecutorPointsTest::points())
                    .capture(d.numbers, d.arguments, offsetof(DrawArguments, vertexCount))
                    .draw(d.points);
            });
        const TextureHandle out = drawPoints(capture.arguments, 1);
        graph().markOutput(out);
        run();
        EXPECT_EQ(executor().compiled().passes[1].barriers, 0u) << "GL orders transform feedback";
        // The buffer has room for 20.
        EXPECT_EQ(executor().readImage(out).at(0, 0)[0], float(std::min(points, 20u)));
    }
}

TEST_P(ExecutorIndirectTest, ABufferThatShadersAppendToIsDrawnAsFarAsItIsFilled) {
    library().addSource(
        "test/append.comp",
        "layout(local_size_x = 64) in;\nlayout(std430) buffer Arguments { uint arguments[4]; };\n"
        "layout(std430) writeonly buffer Numbers { uint numbers[]; };\n"
        "void main() { uint i = gl_GlobalInvocationID.x;\n"
        "  if (i % 3u != 0u) return;\n  numbers[atomicAdd(arguments[0], 1u)] = i; }\n");
    struct Append {
        BufferHandle numbers, arguments;
    };
    begin();
    const Append& append = graph().addPass<Append>(
        "append",
        [](Builder& b, Append& d) {
            d.numbers = b.create("numbers", BufferDesc{4 * 1024});
            d.arguments = b.create("arguments", BufferDesc{sizeof(DrawArguments)});
        },
        [](const Append& d, PassContext& c) {
            const DrawArguments arguments;
            c.upload(d.arguments, 0, &arguments, sizeof arguments);
            c.compute("test/append.comp")
                .bind("Numbers", d.numbers)
                .bind("Arguments", d.arguments)
                .dispatchOver(1024);
        });
    const TextureHandle out = drawPoints(append.arguments, 1);
    graph().markOutput(out);
    graph().markOutput(append.numbers);
    run();
    EXPECT_EQ(executor().readImage(out).at(0, 0)[0], 342) << "multiples of 3 below 1024";
    std::vector<uint32_t> numbers = valuesOf<uint32_t>(append.numbers);
    numbers.resize(342);
    std::ranges::sort(numbers); // nothing promises their order
    for (uint32_t i = 0; i < 342; ++i) ASSERT_EQ(numbers[i], 3 * i);
}

TEST_P(ExecutorIndirectTest, AbsentArgumentsDrawNothing) {
    begin();
    const Draw& skipped = graph().addPass<Draw>(
        "skipped",
        [](Builder& b, Draw& d) {
            d.arguments = b.create("arguments", BufferDesc{16}), b.skip("no medium");
        },
        [](const Draw&, PassContext&) {});
    const TextureHandle out = drawPoints(skipped.arguments, 4);
    graph().markOutput(out);
    run();
    EXPECT_EQ(everywhere(out), 0);
}

TEST_P(ExecutorIndirectTest, ArgumentsBeyondTheBufferAreNamed) {
    begin();
    graph().markOutput(drawPoints(uploaded("arguments", std::vector<uint32_t>(4)), 1, 4));
    EXPECT_THAT(failure(),
                HasSubstr("pass 'draw' reads draw arguments at byte 4 of a buffer of 16"));
}

TEST_P(ExecutorIndirectTest, NoGroupsAreDispatchedWhereTheBufferSaysSo) {
    library().addSource(
        "test/count.comp",
        "layout(local_size_x = 4) in;\nlayout(std430) buffer Total { uint total; };\n"
        "void main() { atomicAdd(total, 1u); }\n");
    struct Count {
        BufferHandle arguments, total;
    };
    for (const DispatchArguments& groups :
         {DispatchArguments{0, 1, 1}, DispatchArguments{3, 0, 1}, DispatchArguments{5, 2, 3}}) {
        begin();
        const BufferHandle arguments =
            uploaded("arguments", std::vector<DispatchArguments>{groups});
        const Count& count = graph().addPass<Count>(
            "count",
            [&](Builder& b, Count& d) {
                d.arguments = b.read(arguments, Access::Indirect);
                d.total = b.create("total", BufferDesc{4});
            },
            [](const Count& d, PassContext& c) {
                c.clearBuffer(d.total, 0);
                c.compute("test/count.comp").bind("Total", d.total).dispatchIndirect(d.arguments);
            });
        graph().markOutput(count.total);
        run();
        EXPECT_EQ(valuesOf<uint32_t>(count.total)[0],
                  4 * groups.groupsX * groups.groupsY * groups.groupsZ);
    }
}

// --- no targets ---

TEST_P(ExecutorIndirectTest, ADrawWithoutTargetsRunsItsVerticesAndLeavesNoError) {
    struct Count {
        BufferHandle total;
        TextureHandle color;
    };
    begin();
    const Count& count = graph().addPass<Count>(
        "count",
        [](Builder& b, Count& d) {
            d.total = b.create("total", BufferDesc{4});
            d.color = b.create("color", color(2, 1), Access::ColorTarget);
        },
        [](const Count& d, PassContext& c) {
            c.clearBuffer(d.total, 0);
            c.raster({.vertex = "points/count.vert"}).bind("Total", d.total).draw(300);
            // What follows is drawn again.
            c.clearTexture(d.color, kBlack);
            const Target targets[] = {{d.color}};
            c.raster("points/add.vert", "points/add.frag")
                .colors(targets)
                .state(points())
                .set("width", 2)
                .draw(2);
        });
    graph().markOutput(count.total);
    graph().markOutput(count.color);
    run();
    EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
    EXPECT_EQ(glIsEnabled(GL_RASTERIZER_DISCARD), GL_FALSE);
    // Triangles share no vertices here: each is run once, or again where a driver likes to.
    EXPECT_GE(valuesOf<uint32_t>(count.total)[0], 300u);
    EXPECT_EQ(everywhere(count.color), 1);
}

TEST_P(ExecutorIndirectTest, FragmentsNeedTargets) {
    begin();
    graph().addPass<Draw>(
        "count", [](Builder& b, Draw&) { b.sideEffect(); },
        [](const Draw&, PassContext& c) {
            c.raster("points/add.vert", "points/add.frag").state(points()).set("width", 1).draw(1);
        });
    EXPECT_THAT(
        failure(),
        HasSubstr("pass 'count' draws with 'points/add.vert points/add.frag' without targets"));
}

TEST_P(ExecutorIndirectTest, WithoutFragmentsDepthIsStillDrawn) {
    struct Depth {
        TextureHandle depth;
    };
    begin();
    const Depth& pass = graph().addPass<Depth>(
        "depth",
        [](Builder& b, Depth& d) {
            d.depth = b.create("depth", texture2D(Format::Depth32F, 4, 1), Access::DepthTarget);
        },
        [](const Depth& d, PassContext& c) {
            c.clearTexture(d.depth, kBlack);
            RasterState state = points();
            state.depth = DepthMode::TestAndWrite;
            c.raster({.vertex = "points/add.vert"})
                .depthOnly({d.depth})
                .state(state)
                .set("width", 4)
                .draw(4);
        });
    graph().markOutput(pass.depth);
    run();
    EXPECT_EQ(everywhere(pass.depth), 0.5f);
}

// --- sums ---

TEST_P(ExecutorIndirectTest, SumsOfManyOverlappingPointsAreExact) {
    // 5000 points over 3 pixels; sums of whole numbers below 2^24 have no rounding, and are beyond 16-bit floats.
    constexpr uint32_t kPoints = 5000, kWidth = 3;
    double expected[kWidth][4] = {};
    for (uint32_t i = 0; i < kPoints; ++i) {
        const double value[4] = {1, double(i), double(i % 7), -1};
        for (size_t k = 0; k < 4; ++k) expected[i % kWidth][k] += value[k];
    }
    ASSERT_GT(expected[0][1], 65504);
    ASSERT_LT(expected[0][1], 16777216);
    begin();
    const TextureHandle out =
        drawPoints(uploaded("arguments", std::vector<uint32_t>{kPoints, 1, 0, 0}), kWidth);
    graph().markOutput(out);
    run();
    const Image image = executor().readImage(out);
    for (uint32_t x = 0; x < kWidth; ++x)
        for (size_t k = 0; k < 4; ++k)
            EXPECT_EQ(double(image.at(int(x), 0)[k]), expected[x][k]) << x << ", channel " << k;
}

} // namespace
} // namespace tyndall::fg
