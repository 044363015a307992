#include "gl/window.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "gl/buffer.h"

namespace tyndall::gl {
namespace {

using ::testing::HasSubstr;

bool hasDisplay() {
    return std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
}

WindowOptions hidden() {
    WindowOptions options;
    options.size = {64, 48};
    options.visibility = WindowVisibility::Hidden;
    options.swapInterval = SwapInterval::Immediate;
    return options;
}

TEST(Windows, AHiddenOneHasAnOpenGl45CoreContext) {
    if (!hasDisplay()) GTEST_SKIP() << "there is no display";
    Result<Window> window = Window::create(hidden());
    ASSERT_TRUE(window.ok()) << window.message();
    EXPECT_EQ(window->context().backendName(), "glfw");
    EXPECT_TRUE(window->context().isCurrent());
    EXPECT_EQ(window->framebufferSize(), ivec2(64, 48));
    EXPECT_FALSE(window->shouldClose());
    GLint profile = 0, depthMode = 0;
    glGetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
    glGetIntegerv(GL_CLIP_DEPTH_MODE, &depthMode);
    EXPECT_EQ(profile & GL_CONTEXT_CORE_PROFILE_BIT, GL_CONTEXT_CORE_PROFILE_BIT);
    EXPECT_EQ(depthMode, GL_ZERO_TO_ONE);
    window->swapBuffers();
    Window::pollEvents();
    EXPECT_EQ(window->context().debugLog().count(Severity::High), 0u);
}

TEST(Windows, AShownOneShowsWhatIsDrawn) {
    if (!hasDisplay()) GTEST_SKIP() << "there is no display";
    WindowOptions options = hidden();
    options.visibility = WindowVisibility::Shown;
    Result<Window> window = Window::create(options);
    ASSERT_TRUE(window.ok()) << window.message();
    for (int frame = 0; frame < 3; ++frame) {
        glClearColor(1.0f, 0.0f, 1.0f, 1.0f);
        glClear(GL_COLOR_BUFFER_BIT);
        window->swapBuffers();
        Window::pollEvents();
    }
    glClear(GL_COLOR_BUFFER_BIT);
    uint8_t pixel[4] = {};
    glReadPixels(10, 10, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
    EXPECT_EQ(pixel[0], 255);
    EXPECT_EQ(pixel[1], 0);
    EXPECT_EQ(pixel[2], 255);
}

TEST(Windows, MovedFromIsEmpty) {
    if (!hasDisplay()) GTEST_SKIP() << "there is no display";
    Result<Window> made = Window::create(hidden());
    ASSERT_TRUE(made.ok()) << made.message();
    Window first = std::move(*made);
    Window second = std::move(first);
    EXPECT_FALSE(first); // NOLINT: that is the point
    EXPECT_THROW((void)first.framebufferSize(), CheckFailure);
    EXPECT_EQ(second.framebufferSize(), ivec2(64, 48));
    first = std::move(second);
    EXPECT_TRUE(first.context().isCurrent());
}

TEST(Windows, TwoOfThemAndAContextWithoutWindowTakeTurns) {
    if (!hasDisplay()) GTEST_SKIP() << "there is no display";
    Result<Window> one = Window::create(hidden());
    ASSERT_TRUE(one.ok()) << one.message();
    Result<Window> two = Window::create(hidden());
    ASSERT_TRUE(two.ok()) << two.message();
    Result<Context> headless = Context::createEglSurfaceless();
    ASSERT_TRUE(headless.ok()) << headless.message();
    for (Context* context : {&one->context(), &*headless, &two->context(), &one->context()}) {
        context->makeCurrent();
        Buffer buffer("buffer", 4);
        buffer.clear(42);
        EXPECT_EQ(buffer.readAll<uint32_t>()[0], 42u);
        EXPECT_EQ(context->debugLog().count(Severity::High), 0u);
    }
}

TEST(Windows, WithoutADisplayThereIsASentence) {
    const char* displayBefore = std::getenv("DISPLAY");
    const std::string display = displayBefore != nullptr ? displayBefore : "";
    setenv("DISPLAY", ":4711", 1);
    const Result<Window> window = Window::create(hidden());
    if (displayBefore != nullptr)
        setenv("DISPLAY", display.c_str(), 1);
    else
        unsetenv("DISPLAY");
    ASSERT_FALSE(window.ok());
    EXPECT_THAT(window.message(), HasSubstr("no window"));
    EXPECT_EQ(window.message().find('\n'), std::string::npos);
}

} // namespace
} // namespace tyndall::gl
