#pragma once
// A window with an OpenGL context, by GLFW: the target tyndall_gl_window, apart from tyndall_gl, so that programs
// without a window need no GLFW.

#include <memory>
#include <string>

#include "core/math.h"
#include "core/result.h"
#include "gl/context.h"

struct GLFWwindow;

namespace tyndall::gl {

enum class WindowVisibility : int32_t { Shown = 0, Hidden = 1 };
enum class SwapInterval : int32_t {
    Immediate = 0,
    Display = 1
}; // Display: a frame waits for the screen

struct WindowOptions {
    std::string title = "Tyndall";
    ivec2 size{1280, 720}; // screen coordinates
    WindowVisibility visibility = WindowVisibility::Shown;
    SwapInterval swapInterval = SwapInterval::Display;
    ContextOptions context{}; // back end and device are the window system's choice
};

/// A window and its context, current on the thread that made it. Empty when moved from. All windows belong to one
/// thread.
class Window {
public:
    /// Errors: no display, or a driver without OpenGL 4.5 core.
    static Result<Window> create(const WindowOptions& options = {});

    Window() = default;
    Window(Window&& other) noexcept;
    Window& operator=(Window&& other) noexcept;
    ~Window() = default;

    explicit operator bool() const { return handle_ != nullptr; }
    [[nodiscard]] Context& context() { return context_; }
    /// For input callbacks and for the user interface's back end.
    [[nodiscard]] GLFWwindow* handle() const { return handle_; }
    /// Pixels of the default framebuffer; 0×0 while minimised.
    [[nodiscard]] ivec2 framebufferSize() const;
    /// True once the user asked to close it.
    [[nodiscard]] bool shouldClose() const;
    void swapBuffers();
    /// Handles what happened to all windows since the last call.
    static void pollEvents();

private:
    GLFWwindow* handle_ = nullptr; // owned by the context's platform
    Context context_;
};

} // namespace tyndall::gl
