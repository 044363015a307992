#include "gl/context.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <vector>

#include "core/log.h"
#include "gl/buffer.h"
#include "gl/gl_fixture.h"

namespace tyndall::gl {
namespace {

using ::testing::HasSubstr;

using Factory = Result<Context> (*)(const ContextOptions&);
struct Kind {
    const char* name;
    Factory make;
};
std::string kindName(const ::testing::TestParamInfo<Kind>& kind) {
    return std::string_view(kind.param.name) == "osmesa" ? "Osmesa" : "EglSurfaceless";
}
class ContextTest : public ::testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(On, ContextTest,
                         ::testing::Values(Kind{"egl-surfaceless", Context::createEglSurfaceless},
                                           Kind{"osmesa", Context::createOsmesa}),
                         kindName);

/// Collects what is logged while it lives.
struct LogCapture {
    std::vector<std::string> lines;
    log::Sink before =
        log::setSink([this](log::Level, std::string_view line) { lines.emplace_back(line); });
    ~LogCapture() { log::setSink(before); }
};

TEST_P(ContextTest, IsOpenGl45CoreAndSaysWhichBackendItIs) {
    const Result<Context> context = GetParam().make({});
    ASSERT_TRUE(context.ok()) << context.message();
    EXPECT_EQ(context->backendName(), GetParam().name);
    EXPECT_THAT(context->choice(), HasSubstr(GetParam().name));
    GLint major = 0, minor = 0, profile = 0;
    glGetIntegerv(GL_MAJOR_VERSION, &major);
    glGetIntegerv(GL_MINOR_VERSION, &minor);
    glGetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
    EXPECT_GE(major * 10 + minor, 45);
    EXPECT_EQ(profile & GL_CONTEXT_CORE_PROFILE_BIT, GL_CONTEXT_CORE_PROFILE_BIT);
    EXPECT_FALSE(context->capabilities().renderer.empty());
}

TEST_P(ContextTest, DepthRunsFromZeroToOneFromTheLowerLeft) {
    const Result<Context> context = GetParam().make({});
    ASSERT_TRUE(context.ok()) << context.message();
    GLint origin = 0, depth = 0;
    glGetIntegerv(GL_CLIP_ORIGIN, &origin);
    glGetIntegerv(GL_CLIP_DEPTH_MODE, &depth);
    EXPECT_EQ(origin, GL_LOWER_LEFT);
    EXPECT_EQ(depth, GL_ZERO_TO_ONE);
}

/// The least that the specification allows (OpenGL 4.5 core, tables 23.53 to 23.74), and what the engine relies on.
TEST_P(ContextTest, LimitsReachThoseThatTheSpecificationGuarantees) {
    const Result<Context> context = GetParam().make({});
    ASSERT_TRUE(context.ok()) << context.message();
    const Limits& limits = context->capabilities().limits;
    EXPECT_GE(limits.textureSize, 16384);
    EXPECT_GE(limits.texture3DSize, 2048);
    EXPECT_GE(limits.textureLayers, 2048);
    EXPECT_GE(limits.textureUnitsPerStage, 16);
    EXPECT_GE(limits.imageUnits, 8);
    EXPECT_GE(limits.uniformBlockBytes, 16384);
    EXPECT_GE(limits.computeStorageBlocks, 8);
    EXPECT_GE(limits.storageBlockBytes, int64_t(1) << 27);
    EXPECT_GE(limits.computeSharedBytes, 32768);
    EXPECT_GE(limits.computeInvocations, 1024);
    EXPECT_GE(limits.colorAttachments, 8);
    EXPECT_GE(limits.labelLength, 256);
    EXPECT_GT(limits.uniformBufferAlignment, 0);
    EXPECT_GT(limits.storageBufferAlignment, 0);
}

TEST_P(ContextTest, MovedFromIsEmptyAndTheContextLivesOn) {
    Result<Context> made = GetParam().make({});
    ASSERT_TRUE(made.ok()) << made.message();
    Context first = std::move(*made);
    Context second = std::move(first);
    EXPECT_FALSE(first); // NOLINT: that is the point
    EXPECT_TRUE(second.isCurrent());
    EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
    Context third;
    third = std::move(second);
    EXPECT_FALSE(second);
    EXPECT_TRUE(third.isCurrent());
    third = {};
    EXPECT_FALSE(hasCurrentContext());
}

TEST_P(ContextTest, AnExtensionThatIsSwitchedOffIsAbsent) {
    ContextOptions options;
    std::string present;
    {
        const Result<Context> context = GetParam().make(options);
        ASSERT_TRUE(context.ok()) << context.message();
        ASSERT_FALSE(context->capabilities().extensions().empty());
        present = *context->capabilities().extensions().begin();
        ASSERT_TRUE(context->capabilities().has(present));
    }
    options.disabledExtensions = {present};
    const Result<Context> context = GetParam().make(options);
    ASSERT_TRUE(context.ok()) << context.message();
    EXPECT_FALSE(context->capabilities().has(present));
}

TEST_P(ContextTest, ExtensionsAreSwitchedOffByTheEnvironmentToo) {
    setenv("TYNDALL_GL_DISABLE",
           "GL_EXT_texture_filter_anisotropic, GL_KHR_parallel_shader_compile", 1);
    const Result<Context> context = GetParam().make({});
    unsetenv("TYNDALL_GL_DISABLE");
    ASSERT_TRUE(context.ok()) << context.message();
    EXPECT_FALSE(context->capabilities().has("GL_EXT_texture_filter_anisotropic"));
    EXPECT_FALSE(context->capabilities().has("GL_KHR_parallel_shader_compile"));
    EXPECT_EQ(context->capabilities().limits.anisotropy, 1.0f);
}

TEST_P(ContextTest, ObjectsThatAreLeftAreLoggedAndDoNotCrash) {
    LogCapture log;
    Buffer survivor;
    {
        Result<Context> context = GetParam().make({});
        ASSERT_TRUE(context.ok()) << context.message();
        survivor = Buffer("survivor", 16);
        EXPECT_EQ(context->liveObjects().count(ObjectKind::Buffer), 1);
        EXPECT_EQ(context->liveObjects().bytes, 16);
    }
    ASSERT_EQ(log.lines.size(), 1u);
    EXPECT_THAT(log.lines[0], HasSubstr("1 buffer"));
    survivor = {};
    EXPECT_EQ(log.lines.size(), 1u);
}

TEST(Contexts, OfTwoKindsTakeTurnsInOneProcess) {
    Result<Context> egl = Context::createEglSurfaceless();
    ASSERT_TRUE(egl.ok()) << egl.message();
    Buffer inEgl("in egl", 4, BufferAccess::CpuUpdates);
    Result<Context> osmesa = Context::createOsmesa();
    if (!osmesa) GTEST_SKIP() << osmesa.message();
    EXPECT_TRUE(osmesa->isCurrent());
    EXPECT_FALSE(egl->isCurrent());
    Buffer inOsmesa("in osmesa", 4, BufferAccess::CpuUpdates);

    for (uint32_t round = 0; round < 5; ++round) {
        const uint32_t eglValue = 100 + round, osmesaValue = 200 + round;
        egl->makeCurrent();
        inEgl.write(0, &eglValue, 4);
        osmesa->makeCurrent();
        inOsmesa.write(0, &osmesaValue, 4);
        egl->makeCurrent();
        EXPECT_EQ(inEgl.readAll<uint32_t>()[0], eglValue);
        osmesa->makeCurrent();
        EXPECT_EQ(inOsmesa.readAll<uint32_t>()[0], osmesaValue);
    }
    inOsmesa = {};
    egl->makeCurrent();
    inEgl = {};
    EXPECT_EQ(egl->liveObjects().total(), 0);
    EXPECT_EQ(osmesa->liveObjects().total(), 0);
    EXPECT_EQ(egl->debugLog().count(Severity::High), 0u);
    EXPECT_EQ(osmesa->debugLog().count(Severity::High), 0u);
}

TEST(Contexts, AnObjectReleasedUnderAnotherContextIsLeftAloneAndLogged) {
    Result<Context> first = Context::createEglSurfaceless();
    ASSERT_TRUE(first.ok()) << first.message();
    Buffer ofFirst("of first", 8);
    const GLuint name = ofFirst.id();
    Result<Context> second = Context::createEglSurfaceless();
    ASSERT_TRUE(second.ok()) << second.message();
    LogCapture log;
    ofFirst = {};
    ASSERT_EQ(log.lines.size(), 1u);
    EXPECT_THAT(log.lines[0], HasSubstr("not current"));
    first->makeCurrent();
    EXPECT_TRUE(glIsBuffer(name));
    glDeleteBuffers(1, &name);
}

TEST(Contexts, AutoTakesTheFirstBackendThatWorksAndSaysWhyOthersDidNot) {
    const Result<Context> context = Context::create();
    ASSERT_TRUE(context.ok()) << context.message();
    const std::string name(context->backendName());
    EXPECT_THAT(context->choice(), HasSubstr(name));
    if (name != "egl-device") {
        EXPECT_THAT(context->choice(), HasSubstr("egl-device ("));
    }
    EXPECT_EQ(context->choice().find('\n'), std::string::npos);
}

TEST(Contexts, OsmesaOnRequestOnly) {
    ContextOptions options;
    options.backend = Backend::Osmesa;
    const Result<Context> context = Context::create(options);
    if (!context) GTEST_SKIP() << context.message();
    EXPECT_EQ(context->backendName(), "osmesa");
}

TEST(Contexts, ADeviceThatIsNotThereIsRefusedWithItsNumber) {
    ContextOptions options;
    options.device = 4711;
    const Result<Context> context = Context::create(options);
    ASSERT_FALSE(context.ok());
    EXPECT_THAT(context.message(), HasSubstr("4711"));
}

/// Every device that EGL lists gives a context on that device, or a sentence.
TEST(Contexts, EveryListedDeviceIsOpenedOrRefusedWithASentence) {
    const Result<std::vector<EglDevice>> devices = eglDevices();
    ASSERT_TRUE(devices.ok()) << devices.message();
    for (const EglDevice& device : *devices) {
        const Result<Context> context = Context::createEglDevice(device.index);
        if (context) {
            EXPECT_EQ(context->backendName(), "egl-device");
            EXPECT_EQ(context->capabilities().isSoftware(), device.software)
                << context->capabilities().renderer;
        } else {
            EXPECT_FALSE(context.message().empty());
        }
    }
}

TEST(Contexts, BackendsAreParsedByName) {
    EXPECT_EQ(parseBackend("auto").value(), Backend::Auto);
    EXPECT_EQ(parseBackend("egl").value(), Backend::Egl);
    EXPECT_EQ(parseBackend("osmesa").value(), Backend::Osmesa);
    const Result<Backend> unknown = parseBackend("vulkan");
    ASSERT_FALSE(unknown.ok());
    EXPECT_THAT(unknown.message(), HasSubstr("vulkan"));
    EXPECT_THAT(unknown.message(), HasSubstr("osmesa"));
}

} // namespace
} // namespace tyndall::gl
