// `tyndall-editor`: reads the command line and runs the window.

#include "app.h"
#include "app/program.h"

namespace tyndall::editor {
namespace {

Outcome run(int argc, char** argv) {
    EditorOptions options;
    if (std::optional<Outcome> done = readOptions(argc, argv, options)) return *done;
    return App(std::move(options)).run();
}

} // namespace
} // namespace tyndall::editor

int main(int argc, char** argv) {
    return tyndall::runProgram("tyndall-editor", [&] { return tyndall::editor::run(argc, argv); });
}
