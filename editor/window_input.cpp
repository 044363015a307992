#include "window_input.h"

#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace tyndall::editor {

WindowInput& WindowInput::of(GLFWwindow* window) {
    return *static_cast<WindowInput*>(glfwGetWindowUserPointer(window));
}

void WindowInput::push(GLFWwindow* window, const InputEvent& event) {
    of(window).queue_.push(event);
    of(window).arrived_ = true;
}

bool WindowInput::takeArrived() { return std::exchange(arrived_, false); }

void WindowInput::listen(GLFWwindow* window) {
    using Kind = InputKind;
    glfwSetWindowUserPointer(window, this);
    glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
        push(w, {.kind = Kind::Cursor, .at = {x, y}});
    });
    glfwSetCursorEnterCallback(window, [](GLFWwindow* w, int entered) {
        if (!entered) push(w, {.kind = Kind::CursorLeft});
    });
    glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int) {
        push(w, {.kind = Kind::Button, .code = button, .down = action == GLFW_PRESS});
    });
    glfwSetScrollCallback(window, [](GLFWwindow* w, double x, double y) {
        push(w, {.kind = Kind::Wheel, .at = {x, y}});
    });
    glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int) {
        of(w).arrived_ =
            true; // repeated, too: ImGui counts the time itself, and needs frames for it
        if (action != GLFW_REPEAT)
            push(w, {.kind = Kind::Key, .code = key, .down = action == GLFW_PRESS});
    });
    glfwSetCharCallback(window, [](GLFWwindow* w, unsigned character) {
        push(w, {.kind = Kind::Text, .code = int32_t(character)});
    });
    glfwSetWindowFocusCallback(window, [](GLFWwindow* w, int focused) {
        push(w, {.kind = Kind::Focus, .down = focused == GLFW_TRUE});
    });
    glfwSetFramebufferSizeCallback(window, [](GLFWwindow* w, int, int) { of(w).arrived_ = true; });
    glfwSetWindowRefreshCallback(window, [](GLFWwindow* w) { of(w).arrived_ = true; });
    glfwSetWindowCloseCallback(window, [](GLFWwindow* w) { of(w).arrived_ = true; });
}

} // namespace tyndall::editor
