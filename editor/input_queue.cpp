#include "input_queue.h"

namespace tyndall::editor {
namespace {

bool moves(InputKind kind) { return kind == InputKind::Cursor || kind == InputKind::CursorLeft; }

/// May `next` come in one frame with `last`?
bool belongsTo(InputKind last, InputKind next) {
    if (next == InputKind::Text) return last == InputKind::Key || last == InputKind::Text;
    return (moves(last) && moves(next)) || (next == InputKind::Wheel && last == InputKind::Wheel);
}

} // namespace

std::vector<InputEvent> InputQueue::takeFrame() {
    std::vector<InputEvent> frame;
    while (!waiting_.empty()) {
        if (!frame.empty() && !belongsTo(frame.back().kind, waiting_.front().kind)) break;
        frame.push_back(waiting_.front());
        waiting_.pop_front();
    }
    return frame;
}

} // namespace tyndall::editor
