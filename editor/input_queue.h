#pragma once
// What was done with mouse and keys, in order, until the interface takes it. A slow frame of the picture then loses nothing: each click acts where
// it was made, and a key that is released before anybody looked was still pressed.

#include <cstdint>
#include <deque>
#include <vector>

#include "core/math.h"

namespace tyndall::editor {

enum class InputKind : int32_t {
    Cursor = 0,     // it moved to `at`
    CursorLeft = 1, // the window
    Button = 2,     // `code` of the mouse, `down`
    Wheel = 3,      // `at`: notches to the right and up
    Key = 4,        // `code` as GLFW counts keys, `down`
    Text = 5,       // `code`: a Unicode code point
    Focus = 6,      // `down`: the window has it
};

struct InputEvent {
    InputKind kind = InputKind::Cursor;
    int32_t code = 0;
    bool down = false;
    dvec2 at{0};
};

class InputQueue {
public:
    void push(const InputEvent& event) { waiting_.push_back(event); }
    [[nodiscard]] bool empty() const { return waiting_.empty(); }

    /// The events of one frame of the interface, which knows one position and one state of each key in a frame: movements of the cursor, or one change.
    /// A change is a button, a key with the text that it makes, notches of the wheel, or the focus. Movements have a frame of
    /// their own, because some widgets take a click only where the cursor was over them in the frame before.
    [[nodiscard]] std::vector<InputEvent> takeFrame();

private:
    std::deque<InputEvent> waiting_;
};

} // namespace tyndall::editor
