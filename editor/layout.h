#pragma once
// Where the panes are: three columns, the middle one with the picture above and reports below. The bars between them can be
// dragged; their places are kept in imgui.ini.

#include "session.h"

namespace tyndall::editor {

/// Sizes as shares of the window, so that they hold for any size of it.
struct Layout {
    float left = 0.19f, right = 0.23f, bottom = 0.3f;
    float leftUpper = 0.58f, rightUpper = 0.46f; // of the columns
};

/// Adds the layout to what ImGui writes to imgui.ini and reads from it. Once, after ImGui's context was made.
void rememberLayout();
/// All panes, in the room below the menu bar.
void drawPanes(Session& session);
/// The arrangement as it is at first.
void resetLayout();

} // namespace tyndall::editor
