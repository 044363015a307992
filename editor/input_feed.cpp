#include "input_feed.h"

#include <algorithm>
#include <cfloat>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace tyndall::editor {
namespace {
constexpr double kShortestFrame = 1e-4; // seconds: ImGui divides by it
}

void InputFeed::releaseAll(ImGuiIO& io) {
    buttons_.fill(false);
    std::fill(std::begin(io.KeysDown), std::end(io.KeysDown), false);
}

void InputFeed::set(const InputEvent& event, ImGuiIO& io) {
    const auto code = size_t(event.code);
    switch (event.kind) {
    case InputKind::Cursor: cursor_ = {float(event.at.x), float(event.at.y)}; break;
    case InputKind::CursorLeft: // who drags goes on outside
        if (std::none_of(buttons_.begin(), buttons_.end(), [](bool down) { return down; }))
            cursor_ = {-FLT_MAX, -FLT_MAX};
        break;
    case InputKind::Button:
        if (event.code >= 0 && code < buttons_.size()) buttons_[code] = event.down;
        break;
    case InputKind::Wheel:
        io.MouseWheelH += float(event.at.x);
        io.MouseWheel += float(event.at.y);
        break;
    case InputKind::Key:
        if (event.code >= 0 && code < std::size(io.KeysDown)) io.KeysDown[code] = event.down;
        break;
    case InputKind::Text: io.AddInputCharacter(unsigned(event.code)); break;
    case InputKind::Focus:
        io.AddFocusEvent(event.down);
        if (!event.down) releaseAll(io); // nobody will say when they are released
        break;
    }
}

void InputFeed::apply(std::span<const InputEvent> events, double seconds) {
    ImGuiIO& io = ImGui::GetIO();
    for (const InputEvent& event : events) set(event, io);
    const auto either = [&](int left, int right) {
        return io.KeysDown[left] || io.KeysDown[right];
    };
    io.KeyCtrl = either(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL);
    io.KeyShift = either(GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT);
    io.KeyAlt = either(GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT);
    io.KeySuper = either(GLFW_KEY_LEFT_SUPER, GLFW_KEY_RIGHT_SUPER);
    std::copy(buttons_.begin(), buttons_.end(), io.MouseDown);
    io.MousePos = cursor_;
    io.DeltaTime = float(std::max(seconds, kShortestFrame));
}

} // namespace tyndall::editor
