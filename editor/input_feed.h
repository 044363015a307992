#pragma once
// Gives Dear ImGui the events of one of its frames. It keeps no queue of its own in this version.

#include <array>
#include <span>

#include <imgui.h>

#include "input_queue.h"

namespace tyndall::editor {

class InputFeed {
public:
    /// Right before ImGui::NewFrame(), after a back end, whose polled mouse it replaces. `seconds` since the frame before.
    void apply(std::span<const InputEvent> events, double seconds);

private:
    void set(const InputEvent& event, ImGuiIO& io);
    void releaseAll(ImGuiIO& io);

    std::array<bool, ImGuiMouseButton_COUNT> buttons_{};
    ImVec2 cursor_{-FLT_MAX, -FLT_MAX};
};

} // namespace tyndall::editor
