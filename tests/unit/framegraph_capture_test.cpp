// Captures and indirect arguments as the graph sees them: accesses, barriers, and sentences for what was not declared.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "framegraph/dump.h"
#include "framegraph_null_executor.h"

namespace tyndall::fg {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct Surfels {
    BufferHandle points, arguments;
    TextureHandle color;
};
constexpr auto kNothing = [](const Surfels&, PassContext&) {};
constexpr uint32_t GL_COMMAND = 0x40, GL_SHADER_STORAGE = 0x2000, GL_TRANSFORM_FEEDBACK = 0x800,
                   GL_QUERY_BUFFER = 0x8000; // OpenGL 4.5 registry

struct FrameGraphCapture : ::testing::Test {
    NullExecutor executor;
    FrameGraphImpl& graph = executor.beginFrame();

    /// Captures points and their number.
    Surfels capture() {
        return graph.addPass<Surfels>(
            "capture",
            [](Builder& b, Surfels& d) {
                d.points = b.create("points", BufferDesc{3200}, Access::Capture);
                d.arguments =
                    b.create("arguments", BufferDesc{sizeof(DrawArguments)}, Access::Capture);
            },
            [](const Surfels& d, PassContext& c) {
                c.raster({.vertex = "a.vert", .tessControl = "a.tesc", .tessEvaluation = "a.tese"})
                    .capture(d.points, d.arguments, 4)
                    .draw(12);
            });
    }
    /// Draws as many of them as there are.
    Surfels splat(const Surfels& in) {
        return graph.addPass<Surfels>(
            "splat",
            [&](Builder& b, Surfels& d) {
                d.points = b.read(in.points);
                d.arguments = b.read(in.arguments, Access::Indirect);
                d.color = b.create("color", texture2D(Format::RGBA32F, 8, 4), Access::ColorTarget);
            },
            [](const Surfels& d, PassContext& c) {
                c.raster("b.vert", "b.frag").bind("Points", d.points).drawIndirect(d.arguments);
            });
    }
    std::string touch(uint32_t pass, BufferHandle handle, Touch touch, const char* place) {
        return checkTouch(graph, pass, handle.resource, handle.version, touch, place);
    }
    uint32_t barriers(const char* pass) { return passNamed(executor.compiled, pass).barriers; }
};

TEST_F(FrameGraphCapture, ACapturedBufferIsProducedAndReadLikeAnyOther) {
    const Surfels drawn = splat(capture());
    graph.markOutput(drawn.color);
    executor.execute();
    EXPECT_EQ(statusOf(executor.compiled, "capture"), PassStatus::Ran);
    EXPECT_THAT(executor.calls,
                ElementsAre("capture: raster a.vert a.tesc a.tese", "capture: capture, count at 4",
                            "capture: draw", "splat: raster b.vert b.frag", "splat: bind Points",
                            "splat: draw indirect at 0"));
    EXPECT_EQ(barriers("capture"), 0u);
    EXPECT_EQ(barriers("splat"), 0u) << "GL orders transform feedback and query results itself";
    EXPECT_THAT(dump(executor.compiled, DumpFormat::Text), HasSubstr("[capture]"));
}

TEST_F(FrameGraphCapture, NobodyCapturesForNobody) {
    capture();
    executor.execute();
    EXPECT_EQ(statusOf(executor.compiled, "capture"), PassStatus::Culled);
    EXPECT_EQ(passNamed(executor.compiled, "capture").reason, "nobody reads points");
}

TEST_F(FrameGraphCapture, ABarrierStandsBetweenShaderWritesAndTheCaptureOverThem) {
    const Surfels& filled = graph.addPass<Surfels>(
        "fill", [](Builder& b, Surfels& d) { d.points = b.create("points", BufferDesc{64}); },
        kNothing);
    const Surfels& captured = graph.addPass<Surfels>(
        "capture",
        [&](Builder& b, Surfels& d) { d.points = b.write(filled.points, Access::Capture); },
        kNothing);
    const Surfels& moved = graph.addPass<Surfels>(
        "move", [&](Builder& b, Surfels& d) { d.points = b.write(captured.points); }, kNothing);
    graph.markOutput(moved.points);
    executor.execute();
    EXPECT_EQ(barriers("capture"), GL_TRANSFORM_FEEDBACK | GL_QUERY_BUFFER);
    EXPECT_EQ(barriers("move"), GL_SHADER_STORAGE) << "a shader's writes wait for what is there";
    EXPECT_EQ(barrierNames(GL_TRANSFORM_FEEDBACK | GL_QUERY_BUFFER),
              "transform-feedback query-buffer");
}

TEST_F(FrameGraphCapture, ABarrierStandsBetweenArgumentsOfAShaderAndTheirDraw) {
    const Surfels& counted = graph.addPass<Surfels>(
        "count",
        [](Builder& b, Surfels& d) {
            d.points = b.create("points", BufferDesc{64});
            d.arguments = b.create("arguments", BufferDesc{16});
        },
        kNothing);
    graph.markOutput(splat(counted).color);
    executor.execute();
    EXPECT_EQ(barriers("splat"), GL_COMMAND | GL_SHADER_STORAGE);
}

TEST_F(FrameGraphCapture, TexturesAreNotCaptured) {
    graph.addPass<Surfels>(
        "capture",
        [](Builder& b, Surfels& d) {
            d.color = b.create("color", texture2D(Format::RGBA32F, 8, 4), Access::Capture);
        },
        kNothing);
    executor.compile();
    ASSERT_EQ(executor.compiled.errors.size(), 1u);
    EXPECT_THAT(executor.compiled.errors[0],
                AllOf(HasSubstr("pass 'capture' declares 'color' as capture"),
                      HasSubstr("needs a buffer, and this is a texture"),
                      HasSubstr("framegraph_capture_test.cpp")));
}

TEST_F(FrameGraphCapture, ReadingIsNoCapture) {
    const Surfels captured = capture();
    graph.addPass<Surfels>(
        "reader",
        [&](Builder& b, Surfels& d) { d.points = b.read(captured.points, Access::Capture); },
        kNothing);
    executor.compile();
    ASSERT_EQ(executor.compiled.errors.size(), 1u);
    EXPECT_THAT(executor.compiled.errors[0],
                HasSubstr("pass 'reader' declares 'points' as capture"));
}

TEST_F(FrameGraphCapture, ACaptureIntoWhatWasNotDeclaredIsNamed) {
    const Surfels captured = capture();
    const Surfels& user = graph.addPass<Surfels>(
        "user",
        [&](Builder& b, Surfels& d) {
            d.points = b.create("own", BufferDesc{64}, Access::Capture);
            d.arguments = b.read(captured.arguments, Access::Indirect);
        },
        kNothing);
    EXPECT_EQ(touch(1, user.points, Touch::Capture, "capture"), "");
    EXPECT_EQ(touch(1, user.arguments, Touch::Indirect, "draw arguments"), "");
    EXPECT_EQ(
        touch(1, captured.points, Touch::Capture, "capture"),
        "pass 'user' binds 'points' to 'capture' without having declared it: its setup needs a write as capture");
    EXPECT_EQ(
        touch(1, user.arguments, Touch::Capture, "capture count"),
        "pass 'user' binds 'arguments' to 'capture count', which needs a write as capture, but declared it otherwise");
    EXPECT_THAT(touch(1, user.points, Touch::ReadStorage, "Points"),
                HasSubstr("needs a read as storage read"));
}

TEST_F(FrameGraphCapture, APassMayDrawFromTheCountThatItCaptures) {
    const Surfels captured = capture();
    EXPECT_EQ(touch(0, captured.arguments, Touch::Indirect, "draw arguments"), "");
    EXPECT_EQ(touch(0, captured.arguments, Touch::TransferWrite, "upload"), "")
        << "the other arguments come from the processor";
}

} // namespace
} // namespace tyndall::fg
