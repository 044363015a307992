// Ownership, driver messages, framebuffers, samplers and vertex arrays.

#include <gmock/gmock.h>

#include <utility>

#include "gl/buffer.h"
#include "gl/debug.h"
#include "gl/framebuffer.h"
#include "gl/gl_fixture.h"
#include "gl/read_back.h"
#include "gl/sampler.h"
#include "gl/texture.h"
#include "gl/vertex_array.h"

namespace tyndall::gl {
namespace {

using ::testing::HasSubstr;

class ObjectTest : public test::GlTest {};
TYNDALL_GL_TESTS(ObjectTest);

std::string labelOf(GLenum identifier, GLuint id) {
    char text[256] = {};
    glGetObjectLabel(identifier, id, sizeof text, nullptr, text);
    return text;
}

TEST_P(ObjectTest, MovedFromIsEmptyAndOneNameIsDeletedOnce) {
    Buffer first("one", 64);
    const GLuint name = first.id();
    Buffer second(std::move(first));
    EXPECT_FALSE(first); // NOLINT: that is the point
    EXPECT_EQ(first.id(), 0u);
    EXPECT_EQ(first.bytes(), 0u);
    EXPECT_EQ(second.id(), name);
    EXPECT_EQ(context().liveObjects().count(ObjectKind::Buffer), 1);

    Buffer third("two", 32);
    EXPECT_EQ(context().liveObjects().bytes, 96);
    third = std::move(second);
    EXPECT_EQ(third.id(), name);
    EXPECT_EQ(context().liveObjects().count(ObjectKind::Buffer), 1);
    EXPECT_EQ(context().liveObjects().bytes, 64);
    third = std::move(*&third);
    EXPECT_EQ(third.id(), name) << "moving to itself keeps the object";
    third = {};
    EXPECT_FALSE(glIsBuffer(name));
}

TEST_P(ObjectTest, EveryKindIsCountedWhileItLives) {
    {
        const Buffer buffer("buffer", 4);
        const Texture texture("texture", {.width = 2, .height = 2});
        SamplerCache samplers;
        samplers.get(linearClamp());
        FramebufferCache framebuffers;
        const Attachment color{&texture};
        framebuffers.get({&color, 1});
        const VertexArray vertices("vertices", {});
        const Fence fence = Fence::insert();
        for (ObjectKind kind :
             {ObjectKind::Buffer, ObjectKind::Texture, ObjectKind::Sampler, ObjectKind::Framebuffer,
              ObjectKind::VertexArray, ObjectKind::Fence})
            EXPECT_EQ(context().liveObjects().count(kind), 1) << objectKindName(kind);
        EXPECT_EQ(context().liveObjects().describe(),
                  "1 buffer, 1 texture, 1 sampler, 1 framebuffer, 1 vertex array, 1 fence");
        EXPECT_EQ(context().liveObjects().bytes, 4 + 2 * 2 * 16);
    }
    EXPECT_EQ(context().liveObjects().describe(), "none");
}

TEST_P(ObjectTest, NamesReachTheDriver) {
    const Buffer buffer("gi.lpv.sh", 4);
    const Texture texture("gbuffer.depth", {.internalFormat = GL_DEPTH_COMPONENT32F});
    EXPECT_EQ(labelOf(GL_BUFFER, buffer.id()), "gi.lpv.sh");
    EXPECT_EQ(labelOf(GL_TEXTURE, texture.id()), "gbuffer.depth");
    const std::string longName(size_t(context().capabilities().limits.labelLength) + 100, 'x');
    const Buffer buffer2(longName, 4);
    EXPECT_THAT(labelOf(GL_BUFFER, buffer2.id()), HasSubstr("xxxx"));
}

TEST_P(ObjectTest, AnErrorOfTheDriverIsRecordedWithTheGroupsAroundIt) {
    {
        const DebugGroup outer("frame");
        const DebugGroup inner("gi.lpv.inject");
        glBindBuffer(GL_TEXTURE_2D, 0); // no buffer target: GL_INVALID_ENUM
    }
    const std::vector<std::string> messages = takeHighSeverityMessages();
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_THAT(messages[0], HasSubstr("frame > gi.lpv.inject"));
    EXPECT_THAT(messages[0], HasSubstr("GL error"));
    while (glGetError() != GL_NO_ERROR) {
    }
}

TEST_P(ObjectTest, DebugGroupsAloneSayNothing) {
    { const DebugGroup group("quiet"); }
    for (Severity severity :
         {Severity::Notification, Severity::Low, Severity::Medium, Severity::High})
        EXPECT_EQ(context().debugLog().count(severity), 0u) << severityName(severity);
    EXPECT_GE(context().debugLog().dropped(), 2u) << "the driver reports both ends of a group";
}

TEST(DebugTable, DropsNothingWithoutAReason) {
    for (const HarmlessMessage& row : harmlessMessages()) {
        EXPECT_GT(std::string_view(row.reason).size(), 10u);
        EXPECT_TRUE(row.id != 0 || row.source != GL_DONT_CARE || row.text[0] != '\0')
            << "a row may not match everything";
        if (row.source != GL_DEBUG_SOURCE_SHADER_COMPILER) {
            EXPECT_NE(row.type, GLenum(GL_DEBUG_TYPE_ERROR));
            EXPECT_NE(row.type, GLenum(GL_DONT_CARE));
        }
    }
}

TEST_P(ObjectTest, AFenceIsPassedAfterItWasWaitedFor) {
    Fence fence = Fence::insert();
    fence.wait();
    EXPECT_TRUE(fence.passed());
    Fence moved = std::move(fence);
    EXPECT_FALSE(fence); // NOLINT: that is the point
    EXPECT_TRUE(fence.passed()) << "an empty fence is no hindrance";
    EXPECT_TRUE(moved);
}

TEST_P(ObjectTest, AFramebufferIsMadeOncePerSetOfAttachments) {
    const Texture color("color",
                        {.internalFormat = GL_RGBA16F, .width = 4, .height = 4, .mips = 2});
    const Texture depth("depth",
                        {.internalFormat = GL_DEPTH_COMPONENT32F, .width = 4, .height = 4});
    FramebufferCache cache;
    const Attachment colors[] = {{&color}}, smaller[] = {{&color, 1}};
    const Attachment depthAttachment{&depth};
    const GLuint both = cache.get(colors, &depthAttachment);
    EXPECT_EQ(cache.get(colors, &depthAttachment), both);
    EXPECT_NE(cache.get(colors), both);
    EXPECT_NE(cache.get(smaller), cache.get(colors));
    EXPECT_EQ(cache.size(), 3u);
    cache.forget(depth);
    EXPECT_EQ(cache.size(), 2u);
    for (int frame = 0; frame < 40; ++frame) {
        cache.get(colors);
        cache.endFrame();
    }
    EXPECT_EQ(cache.size(), 1u) << "what is not used is dropped";
    FramebufferCache moved = std::move(cache);
    EXPECT_EQ(moved.size(), 1u);
}

TEST_P(ObjectTest, WithoutAttachmentsAFramebufferIsCompleteNevertheless) {
    FramebufferCache cache;
    const GLuint none = cache.get({});
    EXPECT_EQ(cache.get({}), none);
    EXPECT_EQ(glCheckNamedFramebufferStatus(none, GL_DRAW_FRAMEBUFFER),
              GLenum(GL_FRAMEBUFFER_COMPLETE));
    const Texture color("color", {.internalFormat = GL_RGBA8});
    cache.forget(color);
    EXPECT_EQ(cache.size(), 1u) << "it has no texture to lose";
}

TEST_P(ObjectTest, ClearingAFramebufferReachesTheAttachedMipAndLayerAlone) {
    Texture array("array", {.target = GL_TEXTURE_2D_ARRAY,
                            .internalFormat = GL_R32F,
                            .width = 4,
                            .height = 4,
                            .depth = 3,
                            .mips = 2});
    array.clear(7.0f);
    FramebufferCache cache;
    const Attachment target[] = {{&array, 1, 2}};
    const float value[4] = {3.5f, 0, 0, 0};
    glClearNamedFramebufferfv(cache.get(target), GL_COLOR, 0, value);
    const std::vector<float> top = readFloats(array, 0), second = readFloats(array, 1);
    EXPECT_EQ(top, std::vector<float>(4 * 4 * 3, 7.0f));
    std::vector<float> expected(2 * 2 * 3, 7.0f);
    std::fill(expected.begin() + 8, expected.end(), 3.5f);
    EXPECT_EQ(second, expected);
}

TEST_P(ObjectTest, AFramebufferThatCannotBeIsRefusedWithTheAttachments) {
    const Texture color("color", {.internalFormat = GL_RGBA8, .width = 4, .height = 4});
    FramebufferCache cache;
    const Attachment wrong{&color}; // a colour where depth should be
    try {
        cache.get({}, &wrong);
        FAIL() << "an impossible framebuffer was made";
    } catch (const CheckFailure& failure) {
        EXPECT_THAT(failure.what(), HasSubstr("RGBA8 4x4x1"));
    }
    EXPECT_EQ(cache.size(), 0u);
    takeHighSeverityMessages();
    while (glGetError() != GL_NO_ERROR) {
    }
}

TEST_P(ObjectTest, ASamplerIsMadeOncePerSpec) {
    SamplerCache cache;
    SamplerSpec shadow = linearClamp();
    shadow.compare = GL_GEQUAL;
    EXPECT_EQ(cache.get(linearClamp()), cache.get(linearClamp()));
    EXPECT_NE(cache.get(shadow), cache.get(linearClamp()));
    EXPECT_EQ(cache.size(), 2u);
    GLint value = 0;
    glGetSamplerParameteriv(cache.get(shadow), GL_TEXTURE_COMPARE_FUNC, &value);
    EXPECT_EQ(value, GL_GEQUAL);
    glGetSamplerParameteriv(cache.get(nearestClamp()), GL_TEXTURE_MIN_FILTER, &value);
    EXPECT_EQ(value, GL_NEAREST);
}

TEST_P(ObjectTest, AnisotropyIsClampedToTheDriversMostAndUnusedWhereItDoesNotEnd) {
    SamplerCache cache;
    SamplerSpec spec;
    spec.anisotropy = 1e6f;
    const GLuint sampler = cache.get(spec);
    if (!context().capabilities().has("GL_EXT_texture_filter_anisotropic"))
        GTEST_SKIP() << "this driver has no anisotropic filter";
    GLfloat value = 0;
    glGetSamplerParameterfv(sampler, GL_TEXTURE_MAX_ANISOTROPY_EXT, &value);
    if (context().capabilities().needs(Workaround::NoAnisotropy)) {
        EXPECT_EQ(value, 1.0f);
        return;
    }
    EXPECT_EQ(value, context().capabilities().limits.anisotropy);
    EXPECT_GE(value, 2.0f);
}

TEST_P(ObjectTest, AVertexArrayKnowsItsBuffersAndStrides) {
    const Buffer vertices("vertices", 1024);
    const Buffer indices("indices", 64);
    const VertexAttribute attributes[] = {
        {.location = 0, .components = 3, .buffer = vertices.id(), .offset = 0, .stride = 32},
        {.location = 3,
         .components = 1,
         .type = GL_UNSIGNED_INT,
         .buffer = vertices.id(),
         .offset = 12,
         .stride = 32,
         .divisor = 1,
         .integer = true}};
    VertexArray array("mesh", attributes, indices.id());
    GLint value = 0;
    glGetVertexArrayiv(array.id(), GL_ELEMENT_ARRAY_BUFFER_BINDING, &value);
    EXPECT_EQ(GLuint(value), indices.id());
    glGetVertexArrayIndexediv(array.id(), 3, GL_VERTEX_ATTRIB_ARRAY_STRIDE, &value);
    EXPECT_EQ(value, 0) << "the attribute's own stride is not the binding's";
    glGetVertexArrayIndexediv(array.id(), 3, GL_VERTEX_ATTRIB_ARRAY_INTEGER, &value);
    EXPECT_EQ(value, GL_TRUE);
    glGetVertexArrayIndexediv(array.id(), 3, GL_VERTEX_ATTRIB_ARRAY_DIVISOR, &value);
    EXPECT_EQ(value, 1);
    GLint64 offset = 0;
    glGetVertexArrayIndexed64iv(array.id(), 1, GL_VERTEX_BINDING_OFFSET, &offset);
    EXPECT_EQ(offset, 12);
    const VertexArray moved = std::move(array);
    EXPECT_FALSE(array); // NOLINT: that is the point
    EXPECT_TRUE(moved);
}

} // namespace
} // namespace tyndall::gl
