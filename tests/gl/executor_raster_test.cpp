// Raster passes: targets, reversed depth, blending, geometry.
#include "executor_fixture.h"

namespace tyndall::fg {
namespace {

class ExecutorRasterTest : public ExecutorTest {
protected:
    void SetUp() override {
        ExecutorTest::SetUp();
        if (IsSkipped()) return;
        // One triangle over the whole target at a depth.
        library().addSource(
            "test/cover.vert",
            "uniform float depth;\nvoid main() {\n"
            "  vec2 p = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);\n"
            "  gl_Position = vec4(p, depth, 1.0); }\n");
        library().addSource(
            "test/color.frag",
            "uniform float value;\nlayout(location = 0) out vec4 color;\nvoid main() { color = vec4(value); }\n");
        library().addSource(
            "test/place.vert",
            "layout(location = 0) in vec2 position;\nlayout(location = 3) in uint kind;\nflat out uint kindOfVertex;\n"
            "void main() { kindOfVertex = kind; gl_Position = vec4(position, 0.5, 1.0); }\n");
        library().addSource("test/kind.frag",
                            "flat in uint kindOfVertex;\nlayout(location = 0) out vec4 color;\n"
                            "void main() { color = vec4(kindOfVertex); }\n");
    }
};
TYNDALL_GL_TESTS(ExecutorRasterTest);

struct Scene {
    TextureHandle color, depth;
};
constexpr float kBlack[4] = {0, 0, 0, 0};

void cover(const Scene& d, PassContext& c, float depth, float value, const RasterState& state) {
    const Target target[] = {{d.color}};
    const Target depthTarget{d.depth};
    c.raster("test/cover.vert", "test/color.frag")
        .colors(target, &depthTarget)
        .state(state)
        .set("depth", depth)
        .set("value", value)
        .draw(3);
}

TEST_P(ExecutorRasterTest, TheNearerSurfaceStaysInReversedDepth) {
    begin();
    const Scene& pass = graph().addPass<Scene>(
        "scene",
        [](Builder& b, Scene& d) {
            d.color = b.create("color", color(), Access::ColorTarget);
            d.depth = b.create("depth", texture2D(Format::Depth32F, 16, 8), Access::DepthTarget);
        },
        [](const Scene& d, PassContext& c) {
            c.clearTexture(d.color, kBlack);
            c.clearTexture(d.depth, kBlack);
            RasterState state;
            state.depth = DepthMode::TestAndWrite;
            cover(d, c, 0.25f, 1, state);
            cover(d, c, 0.75f, 2, state); // nearer: 1 is at the near plane
            cover(d, c, 0.50f, 3, state); // behind
        });
    graph().markOutput(pass.color);
    graph().markOutput(pass.depth);
    run();
    EXPECT_EQ(everywhere(pass.color), 2);
    EXPECT_EQ(everywhere(pass.depth), 0.75f) << "depth runs from 0 to 1 without being remapped";
}

TEST_P(ExecutorRasterTest, DepthThatIsOnlyReadTestsAndStays) {
    begin();
    const Scene& first = graph().addPass<Scene>(
        "depth",
        [](Builder& b, Scene& d) {
            d.depth = b.create("depth", texture2D(Format::Depth32F, 16, 8), Access::DepthTarget);
        },
        [](const Scene& d, PassContext& c) {
            const float half[4] = {0.5f, 0, 0, 0};
            c.clearTexture(d.depth, half);
        });
    const Scene& second = graph().addPass<Scene>(
        "test",
        [&](Builder& b, Scene& d) {
            d.color = b.create("color", color(), Access::ColorTarget);
            d.depth = b.read(first.depth, Access::DepthRead);
        },
        [](const Scene& d, PassContext& c) {
            c.clearTexture(d.color, kBlack);
            RasterState state;
            state.depth = DepthMode::Test;
            cover(d, c, 0.25f, 1, state);
            state.blend = BlendMode::Add;
            cover(d, c, 0.75f, 4, state);
            cover(d, c, 0.60f, 8, state);
        });
    graph().markOutput(second.color);
    graph().markOutput(first.depth);
    run();
    EXPECT_EQ(everywhere(second.color), 12);
    EXPECT_EQ(everywhere(first.depth), 0.5f);
}

TEST_P(ExecutorRasterTest, DrawingWithDepthWritesNeedsADepthTarget) {
    begin();
    const Scene& first = graph().addPass<Scene>(
        "depth",
        [](Builder& b, Scene& d) {
            d.depth = b.create("depth", texture2D(Format::Depth32F, 16, 8), Access::DepthTarget);
        },
        [](const Scene& d, PassContext& c) { c.clearTexture(d.depth, kBlack); });
    graph().addPass<Scene>(
        "writer",
        [&](Builder& b, Scene& d) {
            d.color = b.create("color", color(), Access::ColorTarget);
            d.depth = b.read(first.depth, Access::DepthRead);
            b.sideEffect();
        },
        [](const Scene& d, PassContext& c) {
            RasterState state;
            state.depth = DepthMode::TestAndWrite;
            cover(d, c, 0.5f, 1, state);
        });
    try {
        (void)executor().execute();
        FAIL() << "the write was not declared";
    } catch (const CheckFailure& failure) {
        EXPECT_THAT(
            failure.what(),
            ::testing::HasSubstr(
                "pass 'writer' binds 'depth' to 'depth target', which needs a write as depth target"));
    }
}

TEST_P(ExecutorRasterTest, ViewportsAndBlendingCoverTheirPart) {
    begin();
    const Scene& pass = graph().addPass<Scene>(
        "scene",
        [](Builder& b, Scene& d) {
            d.color = b.create("color", color(16, 8), Access::ColorTarget);
        },
        [](const Scene& d, PassContext& c) {
            c.clearTexture(d.color, kBlack);
            const Target target[] = {{d.color}};
            RasterState over;
            over.blend = BlendMode::Premultiplied; // 0.25 + (1 − 0.25) · old
            c.raster("test/cover.vert", "test/color.frag")
                .colors(target)
                .viewport(0, 0, 4, 2)
                .set("depth", 0.5f)
                .set("value", 0.5f)
                .draw(3);
            c.raster("test/cover.vert", "test/color.frag")
                .colors(target)
                .state(over)
                .set("depth", 0.5f)
                .set("value", 0.25f)
                .draw(3);
        });
    graph().markOutput(pass.color);
    run();
    const Image image = executor().readImage(pass.color);
    EXPECT_EQ(image.at(0, 7)[0], 0.625f) << "the viewport counts from the lower left";
    EXPECT_EQ(image.at(3, 6)[0], 0.625f);
    EXPECT_EQ(image.at(4, 7)[0], 0.25f);
    EXPECT_EQ(image.at(0, 5)[0], 0.25f);
}

TEST_P(ExecutorRasterTest, GeometryHasItsAttributesAndIndices) {
    struct Vertex {
        float x, y;
        uint32_t kind;
    };
    // Two rectangles of the lower half: kind 7 on the left, kind 9 on the right.
    const Vertex vertices[] = {{-1, -1, 7}, {0, -1, 7}, {0, 0, 7}, {-1, 0, 7},
                               {0, -1, 9},  {1, -1, 9}, {1, 0, 9}, {0, 0, 9}};
    const uint32_t indices[] = {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7};
    const StaticBuffer vertexBuffer = executor().registerBuffer(
        "vertices", gl::Buffer("vertices", std::as_bytes(std::span(vertices))));
    const StaticBuffer indexBuffer = executor().registerBuffer(
        "indices", gl::Buffer("indices", std::as_bytes(std::span(indices))));
    const VertexAttribute attributes[] = {{0, 2, AttributeType::Float32, 0},
                                          {3, 1, AttributeType::UInt32, 8}};
    GeometryDesc desc;
    desc.vertices = vertexBuffer;
    desc.strideBytes = sizeof(Vertex);
    desc.attributes = attributes;
    desc.indices = indexBuffer;
    struct Draw {
        TextureHandle color;
        StaticGeometry geometry;
    };
    begin();
    const Draw& pass = graph().addPass<Draw>(
        "draw",
        [&](Builder& b, Draw& d) {
            d.color = b.create("color", color(16, 8), Access::ColorTarget);
            d.geometry = executor().registerGeometry("rectangles", desc);
        },
        [](const Draw& d, PassContext& c) {
            c.clearTexture(d.color, kBlack);
            const Target target[] = {{d.color}};
            RasterState state;
            state.cull = CullMode::Back; // counter-clockwise faces the viewer
            auto command = c.raster("test/place.vert", "test/kind.frag");
            command.colors(target).state(state);
            command.drawGeometry(d.geometry, 0, 6);
            command.drawGeometry(d.geometry, 6, 6);
            state.frontFaceClockwise = true;
            command.state(state).drawGeometry(d.geometry, 0, 12); // mirrored: everything faces away
        });
    graph().markOutput(pass.color);
    run();
    const Image image = executor().readImage(pass.color);
    EXPECT_EQ(image.at(3, 6)[0], 7);
    EXPECT_EQ(image.at(12, 6)[0], 9);
    EXPECT_EQ(image.at(3, 1)[0], 0);
    executor().release(pass.geometry);
    executor().release(vertexBuffer);
    EXPECT_THROW((void)executor().buffer(vertexBuffer), CheckFailure);
}

TEST_P(ExecutorRasterTest, LayersOfAnArrayAreDrawnOneByOne) {
    begin();
    const Scene& pass = graph().addPass<Scene>(
        "layers",
        [](Builder& b, Scene& d) {
            d.depth =
                b.create("atlas", texture2DArray(Format::Depth32F, 8, 8, 2), Access::DepthTarget);
        },
        [](const Scene& d, PassContext& c) {
            c.clearTexture(d.depth, kBlack);
            RasterState state;
            state.depth = DepthMode::TestAndWrite;
            for (int layer = 0; layer < 2; ++layer)
                c.raster("test/cover.vert", "test/color.frag")
                    .depthOnly({d.depth, layer})
                    .state(state)
                    .set("depth", layer == 0 ? 0.25f : 0.75f)
                    .set("value", 0.0f)
                    .draw(3);
        });
    graph().markOutput(pass.depth);
    run();
    EXPECT_EQ(executor().readImage(pass.depth, 0).at(3, 3)[0], 0.25f);
    EXPECT_EQ(executor().readImage(pass.depth, 1).at(3, 3)[0], 0.75f);
}

} // namespace
} // namespace tyndall::fg
