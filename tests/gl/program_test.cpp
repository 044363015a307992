#include "gl/program.h"

#include <gmock/gmock.h>

#include <cstddef>

#include "gl/buffer.h"
#include "gl/framebuffer.h"
#include "gl/gl_fixture.h"
#include "gl/read_back.h"
#include "gl/shader_library.h"
#include "gl/vertex_array.h"
#include "shared/light.h"
#include "shared/view.h"

namespace tyndall::gl {
namespace {

using ::testing::HasSubstr;

class ProgramTest : public test::GlTest {};
TYNDALL_GL_TESTS(ProgramTest);

/// A library of the texts given, under their paths, and of the engine's shaders.
ShaderLibrary libraryOf(std::initializer_list<std::pair<const char*, const char*>> sources) {
    ShaderLibrary library;
    for (const auto& [path, text] : sources) library.addSource(path, text);
    return library;
}

constexpr const char* kEverything = R"(
layout(local_size_x = 8, local_size_y = 4) in;
layout(std140) uniform Params { vec4 scale; uint count; } params;
layout(std430) readonly buffer Input { float head; float values[]; } source;
layout(std430) writeonly buffer Output { float results[]; };
uniform sampler2D table[2];
uniform sampler3D volume;
layout(r32f) uniform image2D picture;
uniform float factor;
uniform int offset;
void main() {
    uint i = gl_GlobalInvocationID.x + 8u * gl_GlobalInvocationID.y;
    if (i >= params.count) return;
    float sum = texelFetch(table[0], ivec2(0), 0).r + texelFetch(table[1], ivec2(0), 0).r + texelFetch(volume, ivec3(0), 0).r;
    results[i] = params.scale.x * source.values[i] * factor + source.head + float(offset) + sum;
    imageStore(picture, ivec2(int(i), 0), vec4(results.length()));
}
)";

TEST_P(ProgramTest, ReflectionFindsEveryResourceAndGivesEachItsOwnBinding) {
    ShaderLibrary library = libraryOf({{"t.comp", kEverything}});
    const Result<const Program*> program = library.compute("t.comp");
    ASSERT_TRUE(program.ok()) << program.message();
    const Program& p = **program;
    EXPECT_EQ(p.localSize(), uvec3(8, 4, 1));
    ASSERT_NE(p.find("Params"), nullptr);
    EXPECT_EQ(p.find("Params")->kind, ResourceKind::UniformBlock);
    EXPECT_EQ(p.find("Params")->bytes, 32);
    ASSERT_NE(p.find("Input"), nullptr);
    ASSERT_NE(p.find("Output"), nullptr);
    EXPECT_EQ(p.find("Input")->kind, ResourceKind::StorageBlock);
    EXPECT_NE(p.find("Input")->binding, p.find("Output")->binding);
    ASSERT_NE(p.find("table"), nullptr);
    EXPECT_EQ(p.find("table")->kind, ResourceKind::Sampler);
    EXPECT_EQ(p.find("table")->count, 2);
    ASSERT_NE(p.find("volume"), nullptr);
    const int first = p.find("table")->binding, third = p.find("volume")->binding;
    EXPECT_TRUE(third < first || third >= first + 2)
        << "an array takes as many units as it has elements";
    ASSERT_NE(p.find("picture"), nullptr);
    EXPECT_EQ(p.find("picture")->kind, ResourceKind::Image);
    ASSERT_NE(p.find("factor"), nullptr);
    EXPECT_EQ(p.find("factor")->kind, ResourceKind::Uniform);
    EXPECT_EQ(p.find("nothing"), nullptr);
    EXPECT_TRUE(p.mentions("params"));
    EXPECT_TRUE(p.mentions("gl_GlobalInvocationID"));
    EXPECT_FALSE(p.mentions("param"));
}

TEST_P(ProgramTest, WhatIsBoundByNameIsWhatTheShaderReads) {
    ShaderLibrary library = libraryOf({{"t.comp", kEverything}});
    const Result<const Program*> program = library.compute("t.comp");
    ASSERT_TRUE(program.ok()) << program.message();
    const Program& p = **program;

    struct {
        float scale[4] = {2, 0, 0, 0};
        uint32_t count = 32;
        uint32_t padding[3] = {};
    } params;
    std::vector<float> input(33);
    for (size_t i = 0; i < input.size(); ++i) input[i] = float(i) + 0.5f; // [0] is the head
    const Buffer paramsBuffer("params", std::as_bytes(std::span(&params, 1)));
    const Buffer inputBuffer("input", std::as_bytes(std::span(input)));
    const Buffer output("output", 32 * 4);
    Texture one("one", {.internalFormat = GL_R32F}), two("two", {.internalFormat = GL_R32F});
    Texture volume("volume", {.target = GL_TEXTURE_3D, .internalFormat = GL_R32F});
    one.clear(100.0f);
    two.clear(200.0f);
    volume.clear(400.0f);
    Texture picture("picture", {.internalFormat = GL_R32F, .width = 32});
    picture.clear(-1.0f);

    glUseProgram(p.id());
    glBindBufferBase(GL_UNIFORM_BUFFER, GLuint(p.find("Params")->binding), paramsBuffer.id());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, GLuint(p.find("Input")->binding), inputBuffer.id());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, GLuint(p.find("Output")->binding), output.id());
    glBindTextureUnit(GLuint(p.find("table")->binding), one.id());
    glBindTextureUnit(GLuint(p.find("table")->binding) + 1, two.id());
    glBindTextureUnit(GLuint(p.find("volume")->binding), volume.id());
    glBindImageTexture(GLuint(p.find("picture")->binding), picture.id(), 0, GL_FALSE, 0,
                       GL_WRITE_ONLY, GL_R32F);
    p.set("factor", 3.0f);
    p.set("offset", int32_t(10));
    p.set("unknown", 1.0f);
    glDispatchCompute(1, 1, 1);

    const std::vector<float> results = output.readAll<float>();
    for (size_t i = 0; i < 32; ++i)
        EXPECT_EQ(results[i], 2.0f * (float(i) + 1.5f) * 3.0f + 0.5f + 10.0f + 700.0f);
    EXPECT_EQ(readFloats(picture), std::vector<float>(32, 32.0f))
        << "length() of the unbounded array";
    glUseProgram(0);
}

constexpr const char* kSharedLayouts = R"(
#include "shared/view.h"
#include "shared/light.h"
layout(local_size_x = 1) in;
layout(std140) uniform View { ViewData view; };
layout(std430) readonly buffer Lights { LightData lights[]; };
layout(std430) readonly buffer ShadowViews { ShadowView shadowViews[]; };
layout(std430) buffer Out { float result; };
void main() {
    result = view.clipFromRender[0].x + view.size.x + float(view.frameIndex + view.seed + view.flags) + view.jitter.x
           + lights[1].position.x + lights[1].samplePoint.x + float(lights[1].type + lights[1].flags) + float(lights[1].shadowIndex)
           + shadowViews[2].shadowFromRender[3].w + shadowViews[2].bias.y + float(shadowViews[2].layer + shadowViews[2].count);
}
)";

int offsetOf(const ProgramResource& block, std::string_view member) {
    for (const BlockMember& m : block.members)
        if (m.name == member) return m.offset;
    return -1;
}

/// C++ and GLSL read the same headers; the driver's offsets must be those of the C++ compiler.
TEST_P(ProgramTest, SharedStructsHaveOneLayoutInBothLanguages) {
    ShaderLibrary library = libraryOf({{"t.comp", kSharedLayouts}});
    const Result<const Program*> program = library.compute("t.comp");
    ASSERT_TRUE(program.ok()) << program.message();
    const ProgramResource* view = (*program)->find("View");
    ASSERT_NE(view, nullptr);
    EXPECT_EQ(view->bytes, int64_t(sizeof(gpu::ViewData)));
    EXPECT_EQ(offsetOf(*view, "view.size"), int(offsetof(gpu::ViewData, size)));
    EXPECT_EQ(offsetOf(*view, "view.jitter"), int(offsetof(gpu::ViewData, jitter)));
    EXPECT_EQ(offsetOf(*view, "view.frameIndex"), int(offsetof(gpu::ViewData, frameIndex)));
    EXPECT_EQ(offsetOf(*view, "view.flags"), int(offsetof(gpu::ViewData, flags)));
    const ProgramResource* lights = (*program)->find("Lights");
    ASSERT_NE(lights, nullptr);
    ASSERT_FALSE(lights->members.empty());
    EXPECT_EQ(lights->members.front().topLevelStride, int(sizeof(gpu::LightData)));
    EXPECT_EQ(offsetOf(*lights, "lights[0].samplePoint"),
              int(offsetof(gpu::LightData, samplePoint)));
    EXPECT_EQ(offsetOf(*lights, "lights[0].shadowIndex"),
              int(offsetof(gpu::LightData, shadowIndex)));
    const ProgramResource* views = (*program)->find("ShadowViews");
    ASSERT_NE(views, nullptr);
    EXPECT_EQ(views->members.front().topLevelStride, int(sizeof(gpu::ShadowView)));
    EXPECT_EQ(offsetOf(*views, "shadowViews[0].bias"), int(offsetof(gpu::ShadowView, bias)));
    EXPECT_EQ(offsetOf(*views, "shadowViews[0].layer"), int(offsetof(gpu::ShadowView, layer)));
}

TEST_P(ProgramTest, ARasterProgramDraws) {
    ShaderLibrary library = libraryOf({
        {"t.vert",
         "void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, "
         "0.5, 1.0); }\n"},
        {"t.frag",
         "out vec4 color;\nvoid main() { color = vec4(gl_FragCoord.xy, gl_FragCoord.z, LEVEL); }\n"},
    });
    const Result<const Program*> program = library.raster("t.vert", "t.frag", {{"LEVEL", 7}});
    ASSERT_TRUE(program.ok()) << program.message();
    EXPECT_FALSE((*program)->isCompute());
    const Texture target("target", {.width = 3, .height = 2});
    FramebufferCache framebuffers;
    const Attachment colors[] = {{&target}};
    const VertexArray none("none", {});
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffers.get(colors));
    glViewport(0, 0, 3, 2);
    glBindVertexArray(none.id());
    glUseProgram((*program)->id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glUseProgram(0);
    glBindVertexArray(0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    const std::vector<float> pixels = readFloats(target);
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 3; ++x) {
            const float* pixel = pixels.data() + (y * 3 + x) * 4;
            EXPECT_EQ(pixel[0], float(x) + 0.5f);
            EXPECT_EQ(pixel[1], float(y) + 0.5f);
            EXPECT_EQ(pixel[2], 0.5f)
                << "clip-space depth 0.5 stays 0.5 where depth runs from zero to one";
            EXPECT_EQ(pixel[3], 7.0f);
        }
}

constexpr const char* kPlainVertex = "void main() { gl_Position = vec4(0); }\n";
constexpr const char* kLevels = "layout(vertices = 3) out;\nuniform float level;\nvoid main() {\n"
                                "  for (int i = 0; i < 3; ++i) gl_TessLevelOuter[i] = level;\n"
                                "  gl_TessLevelInner[0] = level; }\n";

TEST_P(ProgramTest, TessellationIsReflectedWithWhatItMakesAndCaptures) {
    ShaderLibrary library = libraryOf({
        {"t.vert", kPlainVertex},
        {"t.tesc", kLevels},
        {"points.tese",
         "layout(triangles, equal_spacing, point_mode) in;\n"
         "layout(std430) readonly buffer Scale { float scale; };\n"
         "layout(xfb_offset = 0) out Point { vec4 position; vec2 size; };\n"
         "void main() { position = vec4(scale); size = gl_TessCoord.xy; gl_Position = vec4(0); }\n"},
        {"lines.tese", "layout(isolines) in;\nvoid main() { gl_Position = vec4(0); }\n"},
        {"quads.tese", "layout(quads) in;\nvoid main() { gl_Position = vec4(0); }\n"},
        {"t.frag", "out vec4 color;\nvoid main() { color = vec4(1); }\n"},
    });
    const Program& points = *library.program({{"t.vert", "t.tesc", "points.tese"}, {}}).value();
    EXPECT_EQ(points.tessellatesTo(), GLenum(GL_POINTS));
    EXPECT_EQ(points.captureStride(), 24);
    EXPECT_FALSE(points.hasFragments());
    ASSERT_NE(points.find("level"), nullptr) << "a uniform of the control stage";
    ASSERT_NE(points.find("Scale"), nullptr) << "a block of the evaluation stage";
    EXPECT_TRUE(points.mentions("gl_TessCoord"));
    const Program& lines =
        *library.program({{"t.vert", "t.tesc", "lines.tese", "t.frag"}, {}}).value();
    EXPECT_EQ(lines.tessellatesTo(), GLenum(GL_LINES));
    EXPECT_EQ(lines.captureStride(), 0);
    EXPECT_TRUE(lines.hasFragments());
    const Program& quads =
        *library.program({{"t.vert", "t.tesc", "quads.tese", "t.frag"}, {}}).value();
    EXPECT_EQ(quads.tessellatesTo(), GLenum(GL_TRIANGLES));
    EXPECT_FALSE(library.raster("t.vert", "t.frag").value()->tessellatesTo());
    EXPECT_GE(context().capabilities().limits.patchVertices, 32) << "OpenGL 4.5, table 23.55";
}

TEST_P(ProgramTest, AMistakeInAStageOfTessellationIsReportedWithItsLine) {
    ShaderLibrary library =
        libraryOf({{"t.vert", kPlainVertex},
                   {"t.tesc", kLevels},
                   {"t.tese", "layout(triangles) in;\nvoid main() { gl_Position = nonsense; }\n"}});
    const Result<const Program*> program = library.program({{"t.vert", "t.tesc", "t.tese"}, {}});
    ASSERT_FALSE(program.ok());
    EXPECT_THAT(program.message(), HasSubstr("t.tese:2"));
}

TEST_P(ProgramTest, CapturesIntoSeveralBuffersAreRefused) {
    ShaderLibrary library =
        libraryOf({{"t.vert", "layout(xfb_buffer = 0, xfb_offset = 0) out vec4 a;\n"
                              "layout(xfb_buffer = 1, xfb_offset = 0) out vec4 b;\n"
                              "void main() { a = b = vec4(1); gl_Position = vec4(0); }\n"}});
    const Result<const Program*> program = library.program({{"t.vert"}, {}});
    ASSERT_FALSE(program.ok());
    EXPECT_THAT(program.message(), HasSubstr("shader 't.vert' captures into several buffers"));
}

TEST_P(ProgramTest, AMistakeInAnIncludeIsReportedWithItsFileAndLine) {
    ShaderLibrary library = libraryOf({
        {"t.comp",
         "layout(local_size_x = 1) in;\n#include \"lib/broken.glsl\"\nvoid main() { broken(); }\n"},
        {"lib/broken.glsl", "void fine() {}\n\nvoid broken() {\n    float x = nonsense;\n}\n"},
    });
    const Result<const Program*> program = library.compute("t.comp");
    ASSERT_FALSE(program.ok());
    EXPECT_THAT(program.message(), HasSubstr("shader 't.comp'"));
    EXPECT_THAT(program.message(), HasSubstr("lib/broken.glsl:4"));
    EXPECT_THAT(program.message(), HasSubstr("nonsense"));
}

TEST_P(ProgramTest, AMistakeAfterAnIncludeIsReportedWithItsOwnLine) {
    ShaderLibrary library = libraryOf({
        {"t.comp",
         "layout(local_size_x = 1) in;\n#include \"lib/fine.glsl\"\n\nvoid main() { nonsense(); }\n"},
        {"lib/fine.glsl", "void fine() {}\n// comment\n"},
    });
    const Result<const Program*> program = library.compute("t.comp", {{"A", 1}, {"B", 2}});
    ASSERT_FALSE(program.ok());
    EXPECT_THAT(program.message(), HasSubstr("t.comp:4"));
}

TEST_P(ProgramTest, StagesThatDoNotFitAreRefusedByTheLinker) {
    ShaderLibrary library = libraryOf({
        {"t.vert", "out vec2 uv;\nvoid main() { uv = vec2(0); gl_Position = vec4(0); }\n"},
        {"t.frag", "in vec4 uv;\nout vec4 color;\nvoid main() { color = uv; }\n"},
    });
    const Result<const Program*> program = library.raster("t.vert", "t.frag");
    ASSERT_FALSE(program.ok());
    EXPECT_THAT(program.message(), HasSubstr("does not link"));
    EXPECT_THAT(program.message(), HasSubstr("uv"));
}

TEST_P(ProgramTest, TooManyBindingsAreAnErrorAndNotACrash) {
    const int limit = context().capabilities().limits.computeStorageBlocks;
    std::string text = "layout(local_size_x = 1) in;\n";
    std::string body;
    for (int i = 0; i <= limit; ++i) {
        text += "layout(std430) buffer B" + std::to_string(i) + " { float v" + std::to_string(i) +
                "; };\n";
        body += "v" + std::to_string(i) + " = 1.0;\n";
    }
    ShaderLibrary library;
    library.addSource("t.comp", text + "void main() {\n" + body + "}\n");
    const Result<const Program*> program = library.compute("t.comp");
    ASSERT_FALSE(program.ok());
    EXPECT_THAT(program.message(), HasSubstr("t.comp"));
}

TEST_P(ProgramTest, WhatTheCompilerRemarksIsKeptWithFileAndLine) {
    ShaderLibrary library = libraryOf({
        {"t.comp",
         "layout(local_size_x = 1) in;\nlayout(std430) buffer Out { float result; };\n"
         "struct Pair { float a, b; };\nPair pair;\nfloat sum() {\n    return pair.a + pair.b;\n}\n"
         "void main() { result = sum(); }\n"},
        {"clean.comp",
         "layout(local_size_x = 1) in;\nlayout(std430) buffer Out { float result; };\n"
         "void main() { result = 1.0; }\n"},
    });
    EXPECT_EQ(library.compute("clean.comp").value()->warnings(), "");
    const std::string warnings = library.compute("t.comp").value()->warnings();
    if (warnings.empty()) GTEST_SKIP() << "this driver does not mind a variable without a value";
    EXPECT_THAT(warnings, HasSubstr("t.comp:6"));
}

TEST_P(ProgramTest, MovedFromIsEmpty) {
    const StageSource stage{
        GL_COMPUTE_SHADER,
        {"#version 450 core\nlayout(local_size_x = 2) in;\nvoid main() {}\n", {"t.comp"}}};
    Result<Program> built = Program::build("t.comp", {&stage, 1});
    ASSERT_TRUE(built.ok()) << built.message();
    Program moved = std::move(*built);
    EXPECT_FALSE(*built); // NOLINT: that is the point
    EXPECT_TRUE(moved);
    EXPECT_TRUE(moved.isCompute());
    EXPECT_EQ(context().liveObjects().count(ObjectKind::Program), 1);

    PendingProgram pending("t.comp", {&stage, 1});
    PendingProgram other = std::move(pending);
    EXPECT_THROW((void)pending.finish(), CheckFailure); // NOLINT: likewise
    EXPECT_TRUE(other.finish().ok());
    EXPECT_THROW((void)other.finish(), CheckFailure) << "a pending program is finished once";
}

} // namespace
} // namespace tyndall::gl
