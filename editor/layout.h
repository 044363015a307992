#pragma once
// Where the panes are: three columns, the middle one with the picture above and reports below. The bars between them can be
// dragged; their places are kept in imgui.ini.

#include <imgui.h>

#include "session.h"

namespace tyndall::editor {

class Layout {
public:
    Layout() = default;
    Layout(const Layout&) = delete; // ImGui keeps a pointer to it
    Layout& operator=(const Layout&) = delete;

    /// Adds the layout to what ImGui writes to imgui.ini and reads from it. Once, after ImGui's context was made, which must go first.
    void remember();
    /// All panes, in the room below the menu bar.
    void draw(Session& session);
    /// The arrangement as it is at first.
    void reset();

private:
    /// Sizes as shares of the window, so that they hold for any size of it.
    struct Shares {
        float left = 0.19f, right = 0.23f, bottom = 0.3f;
        float leftUpper = 0.58f, rightUpper = 0.46f; // of the columns
    };
    struct Room {
        float width, height, bar;
    };
    void read(const char* line);
    void write(const char* section, ImGuiTextBuffer& text) const;
    void drawLeft(Session& session, const Room& room, float width);
    void drawMiddle(Session& session, const Room& room, float width);
    void drawRight(Session& session, const Room& room, float width);

    Shares shares_;
    ImVec2 paneSpacing_; // inside panes, where draw() has none between them
};

} // namespace tyndall::editor
