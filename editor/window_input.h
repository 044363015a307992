#pragma once
// Fills the queue from a window's callbacks.

#include "input_queue.h"

struct GLFWwindow;

namespace tyndall::editor {

class WindowInput {
public:
    WindowInput() = default;
    WindowInput(const WindowInput&) = delete; // the window keeps a pointer to it
    WindowInput& operator=(const WindowInput&) = delete;

    /// Takes the window's user pointer and its callbacks; outlives the window's events.
    void listen(GLFWwindow* window);
    [[nodiscard]] InputQueue& queue() { return queue_; }
    /// Was there anything since the last call, input or a need to draw again?
    [[nodiscard]] bool takeArrived();

private:
    static WindowInput& of(GLFWwindow* window);
    static void push(GLFWwindow* window, const InputEvent& event);

    InputQueue queue_;
    bool arrived_ = false;
};

} // namespace tyndall::editor
