#pragma once
// The editor's window and loop: what happens, in which order, and when nothing needs to happen.

#include <memory>

#include "gl/window.h"
#include "layout.h"
#include "messages.h"
#include "options.h"
#include "save_dialog.h"
#include "session.h"
#include "user_interface.h"
#include "window_input.h"

namespace tyndall::editor {

class App {
public:
    explicit App(EditorOptions options) : options_(std::move(options)) {}
    /// Opens scene and window and runs until the window is closed or the frames of the command line are done.
    Outcome run();

private:
    Outcome openScene(Scene& scene);
    Outcome openWindow();
    Outcome openSession(Scene scene);
    Outcome loop();
    /// Waits for something to happen, if nothing is to be done meanwhile.
    void waitForEvents();
    /// All input that waits, in order, and then one frame of the interface that is seen.
    void drawInterface();
    void interfaceFrame(ivec2 size);
    void drawPanes();
    /// Says that a frame is being made before it is, and that it is done once it is.
    void announceRendering();
    void drawMenu();
    void drawFileMenu();
    void drawEditMenu();
    void handleKeys();
    void screenshot(const char* ending);
    void copyCommandLine();
    void updateTitle();
    [[nodiscard]] bool done() const;

    EditorOptions options_;
    Messages messages_;
    gl::Window window_; // outlives what is made in its context
    std::unique_ptr<RenderSession> rendering_;
    std::unique_ptr<Session> session_;
    Layout layout_; // outlives the interface, which writes it down at its end
    std::unique_ptr<UserInterface> interface_;

    WindowInput input_;
    double lastDrawn_ = 0;    // seconds of GLFW's clock
    int interfaceFrames_ = 3; // still to draw: ImGui needs a few to settle after an event
    int beforeFirstPicture_ = 3;
    bool timingsKnown_ = true; // of the last picture
    SaveDialog saveDialog_;
    std::string title_;
};

} // namespace tyndall::editor
