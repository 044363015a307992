// Transform feedback: what is captured, how much of it, and what is refused.
#include <algorithm>

#include "executor_points_fixture.h"

namespace tyndall::fg {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

struct Number {
    uint32_t id, hash;
    float quotient;
    bool operator==(const Number&) const = default;
};
static_assert(sizeof(Number) == 12);

/// What capture/number.vert says.
Number numberOf(uint32_t id) {
    return {id, (id * 747796405u + 2891336453u) ^ (id >> 3), float(id) / 8.0f - 3.0f};
}

struct Pass {
    BufferHandle numbers, count;
    TextureHandle color;
    uint32_t first, second; // vertices of two draws
};

class ExecutorCaptureTest : public ExecutorPointsTest {
protected:
    /// Captures `first` points and then `second` more into a buffer of zeros and so many bytes.
    const Pass& captureNumbers(uint32_t first, uint32_t second, uint64_t bytes) {
        const Pass& pass = graph().addPass<Pass>(
            "capture",
            [&](Builder& b, Pass& d) {
                d.numbers = b.create("numbers", BufferDesc{bytes}, Access::Capture);
                d.count = b.create("count", BufferDesc{16}, Access::Capture);
                d.first = first;
                d.second = second;
            },
            [](const Pass& d, PassContext& c) {
                c.clearBuffer(d.numbers, 0);
                c.clearBuffer(d.count, 77);
                RasterCommand command = c.raster({.vertex = "capture/number.vert"});
                command.state(points()).capture(d.numbers, d.count, 8);
                command.draw(d.first);
                command.draw(d.second, 1, d.first);
            });
        graph().markOutput(pass.numbers);
        graph().markOutput(pass.count);
        return pass;
    }
    /// One pass that declares nothing but a buffer of numbers, and is needed.
    template <typename Execute> void pass(Execute execute) {
        graph().addPass<Pass>(
            "surfelize",
            [&](Builder& b, Pass& d) {
                d.numbers = b.create("numbers", BufferDesc{1200}, Access::Capture);
                d.count = undeclared_;
                d.color = b.create("color", color(), Access::ColorTarget);
                b.sideEffect();
            },
            execute);
    }
    BufferHandle undeclared_;
};
TYNDALL_GL_TESTS(ExecutorCaptureTest);

TEST_P(ExecutorCaptureTest, VerticesAreWhatTheProcessorComputes) {
    begin();
    const Pass& pass = captureNumbers(600, 400, 1200 * sizeof(Number));
    run();
    EXPECT_EQ(valuesOf<uint32_t>(pass.count), (std::vector<uint32_t>{77, 77, 1000, 77}));
    const std::vector<Number> numbers = valuesOf<Number>(pass.numbers);
    ASSERT_EQ(numbers.size(), 1200u);
    for (uint32_t i = 0; i < 1000; ++i) ASSERT_EQ(numbers[i], numberOf(i)) << i;
    for (uint32_t i = 1000; i < 1200; ++i) ASSERT_EQ(numbers[i], (Number{0, 0, 0})) << i;
}

TEST_P(ExecutorCaptureTest, WhatDoesNotFitIsDroppedByWholePrimitives) {
    begin();
    const Pass& pass = captureNumbers(8, 8, 10 * sizeof(Number) + 8);
    run();
    EXPECT_EQ(valuesOf<uint32_t>(pass.count)[2], 10u);
    const std::vector<uint32_t> words = valuesOf<uint32_t>(pass.numbers);
    EXPECT_EQ(valuesOf<Number>(pass.numbers)[9], numberOf(9));
    EXPECT_EQ(words[30], 0u) << "of the eleventh nothing is there";
    EXPECT_EQ(words[31], 0u);
}

TEST_P(ExecutorCaptureTest, WhereNothingIsDrawnTheCountIsZero) {
    begin();
    const Pass& pass = captureNumbers(0, 0, 1200);
    run();
    EXPECT_EQ(valuesOf<uint32_t>(pass.count), (std::vector<uint32_t>{77, 77, 0, 77}));
}

TEST_P(ExecutorCaptureTest, TheNextCaptureStartsAtTheFirstByte) {
    begin();
    const Pass& made = graph().addPass<Pass>(
        "capture",
        [](Builder& b, Pass& d) {
            d.numbers = b.create("numbers", BufferDesc{4 * sizeof(Number)}, Access::Capture);
            d.count = b.create("counts", BufferDesc{8}, Access::Capture);
        },
        [](const Pass& d, PassContext& c) {
            c.clearBuffer(d.numbers, 0);
            RasterCommand command = c.raster({.vertex = "capture/number.vert"});
            command.state(points());
            command.capture(d.numbers, d.count).draw(4);
            command.capture(d.numbers, d.count, 4).draw(2, 1, 100);
        });
    graph().markOutput(made.numbers);
    graph().markOutput(made.count);
    run();
    EXPECT_EQ(valuesOf<Number>(made.numbers),
              (std::vector<Number>{numberOf(100), numberOf(101), numberOf(2), numberOf(3)}));
    EXPECT_EQ(valuesOf<uint32_t>(made.count), (std::vector<uint32_t>{4, 2}));
}

TEST_P(ExecutorCaptureTest, APassMayDrawWhatItCaptures) {
    begin();
    const Pass& made = graph().addPass<Pass>(
        "both",
        [](Builder& b, Pass& d) {
            d.numbers = b.create("numbers", BufferDesc{3 * sizeof(Number)}, Access::Capture);
            d.color = b.create("color", color(1, 1), Access::ColorTarget);
        },
        [](const Pass& d, PassContext& c) {
            const float black[4] = {};
            c.clearTexture(d.color, black);
            const Target targets[] = {{d.color}};
            RasterState state = points();
            state.blend = BlendMode::Add;
            c.raster({.vertex = "capture/number.vert", .fragment = "points/one.frag"})
                .colors(targets)
                .state(state)
                .capture(d.numbers)
                .draw(3);
        });
    graph().markOutput(made.numbers);
    graph().markOutput(made.color);
    run();
    EXPECT_EQ(valuesOf<Number>(made.numbers),
              (std::vector<Number>{numberOf(0), numberOf(1), numberOf(2)}));
    EXPECT_EQ(everywhere(made.color), 3);
}

/// Adds one for every captured number, read by a compute shader of a later pass.
TEST_P(ExecutorCaptureTest, ALaterPassReadsWhatWasCaptured) {
    library().addSource("test/sum.comp",
                        "layout(local_size_x = 64) in;\n"
                        "layout(std430) readonly buffer Numbers { uint numbers[]; };\n"
                        "layout(std430) readonly buffer Count { uint counts[4]; };\n"
                        "layout(std430) buffer Total { uint total; };\n"
                        "void main() { uint i = gl_GlobalInvocationID.x;\n"
                        "  if (i < counts[2]) atomicAdd(total, numbers[3u * i]); }\n");
    for (const uint32_t points : {100u, 0u, 7u}) {
        struct Sum {
            BufferHandle numbers, count, total;
        };
        begin();
        const Pass& made = captureNumbers(points, 0, 100 * sizeof(Number));
        const Sum& sum = graph().addPass<Sum>(
            "sum",
            [&](Builder& b, Sum& d) {
                d.numbers = b.read(made.numbers), d.count = b.read(made.count),
                d.total = b.create("total", BufferDesc{4});
            },
            [](const Sum& d, PassContext& c) {
                c.clearBuffer(d.total, 0);
                c.compute("test/sum.comp")
                    .bind("Numbers", d.numbers)
                    .bind("Count", d.count)
                    .bind("Total", d.total)
                    .dispatchOver(100);
            });
        graph().markOutput(sum.total);
        run();
        EXPECT_EQ(valuesOf<uint32_t>(sum.total)[0], points * (points - 1) / 2) << points;
    }
}

// --- what is refused ---

TEST_P(ExecutorCaptureTest, ABufferThatWasNotDeclaredIsNamed) {
    begin();
    undeclared_ = uploaded("fog", std::vector<uint32_t>(4));
    graph().markOutput(undeclared_);
    pass([](const Pass& d, PassContext& c) {
        c.raster({.vertex = "capture/number.vert"}).state(points()).capture(d.count).draw(3);
    });
    EXPECT_THAT(
        failure(),
        AllOf(HasSubstr("pass 'surfelize' binds 'fog' to 'capture' without having declared it"),
              HasSubstr("a write as capture")));
}

TEST_P(ExecutorCaptureTest, ACountThatWasNotDeclaredIsNamed) {
    begin();
    undeclared_ = uploaded("fog", std::vector<uint32_t>(4));
    graph().markOutput(undeclared_);
    pass([](const Pass& d, PassContext& c) {
        c.raster({.vertex = "capture/number.vert"})
            .state(points())
            .capture(d.numbers, d.count)
            .draw(3);
    });
    EXPECT_THAT(
        failure(),
        HasSubstr("pass 'surfelize' binds 'fog' to 'capture count' without having declared it"));
}

TEST_P(ExecutorCaptureTest, ACaptureWithoutABufferIsNamed) {
    begin();
    pass([](const Pass&, PassContext& c) {
        c.raster({.vertex = "capture/number.vert"}).state(points()).draw(3);
    });
    EXPECT_THAT(failure(),
                HasSubstr("pass 'surfelize' draws with 'capture/number.vert', which captures"));
    begin();
    pass([](const Pass& d, PassContext& c) {
        RasterCommand command = c.raster({.vertex = "capture/number.vert"});
        command.state(points()).capture(d.numbers).draw(3);
        c.clearBuffer(d.numbers, 0);
        command.draw(3); // where would it go on?
    });
    EXPECT_THAT(failure(), HasSubstr("call capture() before, and again after a clear"));
}

TEST_P(ExecutorCaptureTest, AProgramThatCapturesNothingIsNamed) {
    library().addSource("test/plain.vert", "void main() { gl_Position = vec4(0); }\n");
    begin();
    pass([](const Pass& d, PassContext& c) {
        c.raster({.vertex = "test/plain.vert"}).state(points()).capture(d.numbers).draw(3);
    });
    EXPECT_THAT(
        failure(),
        HasSubstr(
            "pass 'surfelize' captures from 'test/plain.vert', which has no output with xfb_offset"));
}

TEST_P(ExecutorCaptureTest, AMixOfPrimitivesIsRefused) {
    begin();
    pass([](const Pass& d, PassContext& c) {
        RasterCommand command = c.raster({.vertex = "capture/number.vert"});
        command.state(points()).capture(d.numbers).draw(3);
        command.state({}).draw(3);
    });
    EXPECT_THAT(failure(), HasSubstr("either points, lines or triangles"));
}

TEST_P(ExecutorCaptureTest, HalfATessellationAndPatchesThatAreTooLargeAreNamed) {
    library().addSource("test/plain.vert", "void main() { gl_Position = vec4(0); }\n");
    library().addSource("test/plain.tesc", "layout(vertices = 3) out;\nvoid main() {}\n");
    library().addSource("test/plain.tese", "layout(triangles, point_mode) in;\n"
                                           "layout(xfb_offset = 0) out vec4 a;\n"
                                           "void main() { a = vec4(0); }\n");
    begin();
    pass([](const Pass&, PassContext& c) {
        c.raster({.vertex = "capture/corner.vert", .tessControl = "capture/level.tesc"});
    });
    EXPECT_THAT(failure(), HasSubstr("'capture/corner.vert' with one stage of tessellation"));
    begin();
    pass([](const Pass& d, PassContext& c) {
        RasterState state;
        state.patchVertices = 1000;
        c.raster({.vertex = "test/plain.vert",
                  .tessControl = "test/plain.tesc",
                  .tessEvaluation = "test/plain.tese"})
            .state(state)
            .capture(d.numbers)
            .draw(3);
    });
    EXPECT_THAT(failure(), HasSubstr("pass 'surfelize' draws patches of 1000 vertices"));
}

TEST_P(ExecutorCaptureTest, AfterAFailureWhileCapturingTheNextFrameIsFine) {
    begin();
    pass([](const Pass& d, PassContext& c) {
        RasterCommand command = c.raster({.vertex = "capture/number.vert"});
        command.state(points()).capture(d.numbers).draw(3);
        c.compute("common/none.comp"); // no such program
    });
    EXPECT_THAT(failure(), HasSubstr("'common/none.comp'"));
    begin();
    pass([](const Pass& d, PassContext& c) {
        RasterCommand command = c.raster({.vertex = "capture/number.vert"});
        command.state(points()).capture(d.numbers).draw(3);
        command.set("nothing", 1.0f); // thrown while transform feedback is active
    });
    EXPECT_THAT(failure(), HasSubstr("'nothing'"));
    begin();
    const Pass& made = captureNumbers(2, 1, 3 * sizeof(Number));
    run();
    EXPECT_EQ(valuesOf<Number>(made.numbers),
              (std::vector<Number>{numberOf(0), numberOf(1), numberOf(2)}));
}

} // namespace
} // namespace tyndall::fg
