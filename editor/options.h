#pragma once
// The command line of `tyndall-editor`.

#include <optional>
#include <string>

#include "programs/outcome.h"
#include "programs/render_options.h"

namespace tyndall::editor {

struct EditorOptions {
    RenderOptions render;   // as `tyndall capture` has them
    RenderPlan plan;        // the same, understood; without --size the pane decides
    bool fixedSize = false; // --size was given
    bool hidden = false;    // no window appears and no layout is read or written
    bool converge = false;
    int frames = 0;         // > 0: quit after so many
    std::string screenshot; // PNG of the viewport at the end; empty: none
    std::string windowSize = "1600x950";
    int windowWidth = 0, windowHeight = 0;
};

/// Without a value: --help or --version was printed, all is done. The outcome says what is wrong with the command line.
std::optional<EditorOptions> readCommandLine(int argc, char** argv, Outcome& outcome);

/// content/demo.scene.json beside the program, as built or as installed; empty where there is none.
std::string findDemoScene();

} // namespace tyndall::editor
