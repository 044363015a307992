#pragma once
// The command line of `tyndall-editor`.

#include <optional>
#include <string>

#include "app/options.h"
#include "app/outcome.h"

namespace tyndall::editor {

struct EditorOptions {
    RenderOptions render;   // as `tyndall capture` has them; without --size the pane decides
    bool fixedSize = false; // --size was given
    bool hidden = false;    // no window appears and no layout is read or written
    bool converge = false;
    int frames = 0;         // > 0: quit after so many
    std::string screenshot; // PNG of the viewport at the end; empty: none
    std::string windowSize = "1600x950";
    int windowWidth = 0, windowHeight = 0;
};

/// A value says that all is done: --help or --version was printed, or the command line is wrong.
std::optional<Outcome> readOptions(int argc, char** argv, EditorOptions& options);

/// content/demo.scene.json beside the program, as built or as installed; empty where there is none.
std::string findDemoScene();

} // namespace tyndall::editor
