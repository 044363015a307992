#include "gl/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <fmt/format.h>

#include <utility>

namespace tyndall::gl {
namespace {

std::string lastGlfwError() {
    const char* description = nullptr;
    glfwGetError(&description);
    return description != nullptr ? description : "GLFW gives no reason";
}

/// GLFW as long as a window needs it.
class GlfwLibrary {
public:
    static Result<std::shared_ptr<GlfwLibrary>> open() {
        static std::weak_ptr<GlfwLibrary> shared;
        if (std::shared_ptr<GlfwLibrary> library = shared.lock()) return library;
        if (!glfwInit()) return Error{fmt::format("no window can be opened: {}", lastGlfwError())};
        std::shared_ptr<GlfwLibrary> library(new GlfwLibrary);
        shared = library;
        return library;
    }
    ~GlfwLibrary() { glfwTerminate(); }
    GlfwLibrary(const GlfwLibrary&) = delete;
    GlfwLibrary& operator=(const GlfwLibrary&) = delete;

private:
    GlfwLibrary() = default;
};

class GlfwPlatform final : public ContextPlatform {
public:
    GlfwPlatform(std::shared_ptr<GlfwLibrary> library, GLFWwindow* window)
        : library_(std::move(library)), window_(window) {}
    ~GlfwPlatform() override { glfwDestroyWindow(window_); }

    [[nodiscard]] const char* name() const override { return "glfw"; }
    [[nodiscard]] Result<void> makeCurrent() override {
        glfwMakeContextCurrent(window_);
        if (glfwGetCurrentContext() == window_) return {};
        return Error{
            fmt::format("glfw: the window's context cannot be made current: {}", lastGlfwError())};
    }
    void releaseCurrent() override { glfwMakeContextCurrent(nullptr); }
    [[nodiscard]] void* getProcAddress(const char* function) override {
        return reinterpret_cast<void*>(glfwGetProcAddress(function));
    }

private:
    std::shared_ptr<GlfwLibrary> library_;
    GLFWwindow* window_;
};

GLFWwindow* openWindow(const WindowOptions& options) {
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_CLIENT_API, GLFW_OPENGL_API);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT,
                   options.context.debug == DebugMode::Off ? GLFW_FALSE : GLFW_TRUE);
    glfwWindowHint(GLFW_VISIBLE,
                   options.visibility == WindowVisibility::Hidden ? GLFW_FALSE : GLFW_TRUE);
    glfwWindowHint(GLFW_DEPTH_BITS, 0); // the frame is drawn elsewhere and copied here
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    return glfwCreateWindow(options.size.x, options.size.y, options.title.c_str(), nullptr,
                            nullptr);
}

} // namespace

Result<Window> Window::create(const WindowOptions& options) {
    Result<std::shared_ptr<GlfwLibrary>> library = GlfwLibrary::open();
    if (!library) return library.error();
    GLFWwindow* handle = openWindow(options);
    if (handle == nullptr)
        return Error{fmt::format("no window with an OpenGL 4.5 core context can be opened: {}",
                                 lastGlfwError())};
    Result<Context> context = Context::adopt(
        std::make_unique<GlfwPlatform>(std::move(*library), handle), options.context);
    if (!context) return context.error();
    glfwSwapInterval(int(options.swapInterval));
    Window window;
    window.handle_ = handle;
    window.context_ = std::move(*context);
    return window;
}

Window::Window(Window&& other) noexcept
    : handle_(std::exchange(other.handle_, nullptr)), context_(std::move(other.context_)) {}

Window& Window::operator=(Window&& other) noexcept {
    if (this == &other) return *this;
    context_ = std::move(other.context_);
    handle_ = std::exchange(other.handle_, nullptr);
    return *this;
}

ivec2 Window::framebufferSize() const {
    CHECK(handle_ != nullptr, "the Window is empty");
    ivec2 size{0};
    glfwGetFramebufferSize(handle_, &size.x, &size.y);
    return size;
}

bool Window::shouldClose() const {
    CHECK(handle_ != nullptr, "the Window is empty");
    return glfwWindowShouldClose(handle_) != 0;
}

void Window::swapBuffers() {
    CHECK(handle_ != nullptr, "the Window is empty");
    glfwSwapBuffers(handle_);
}

void Window::pollEvents() { glfwPollEvents(); }

} // namespace tyndall::gl
