#pragma once
// Dear ImGui's life: context, look, font, back ends, and where the layout is kept.

#include <string>

#include "core/math.h"
#include "gl/window.h"
#include "input_feed.h"
#include "layout.h"

namespace tyndall::editor {

class UserInterface {
public:
    /// `keepLayout`: read it from and write it to layoutFile(). Window and layout outlive this.
    UserInterface(gl::Window& window, Layout& layout, bool keepLayout);
    ~UserInterface();
    UserInterface(const UserInterface&) = delete;
    UserInterface& operator=(const UserInterface&) = delete;

    /// Takes one frame's events from the queue.
    void beginFrame(InputQueue& queue);
    /// Draws over a cleared window of this many pixels.
    void endFrame(ivec2 framebufferSize);
    /// Instead of endFrame(), where more input waits: nothing is drawn.
    void endFrameUnseen();

private:
    InputFeed feed_;
    double lastFrame_ = 0; // seconds of GLFW's clock
    bool moreWaited_ = false;
    std::string layoutFile_; // ImGui keeps a pointer to it
};

/// $XDG_CONFIG_HOME/tyndall/imgui.ini, else ~/.config/tyndall/imgui.ini; the folder is made. Empty where there is no home.
std::string layoutFile();

} // namespace tyndall::editor
