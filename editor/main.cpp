// `tyndall-editor`: reads the command line and turns what became of it into an exit status and a sentence.

#include <cstdio>
#include <new>

#include "app.h"
#include "core/check.h"

namespace tyndall::editor {
namespace {

int run(int argc, char** argv) {
    Outcome outcome;
    if (std::optional<EditorOptions> options = readCommandLine(argc, argv, outcome)) {
        App app(std::move(*options));
        outcome = app.run();
    }
    if (!outcome.ok()) std::fprintf(stderr, "tyndall-editor: %s\n", outcome.message.c_str());
    return int(outcome.status);
}

} // namespace
} // namespace tyndall::editor

int main(int argc, char** argv) {
    try {
        return tyndall::editor::run(argc, argv);
    } catch (const tyndall::CheckFailure& failure) {
        std::fprintf(stderr, "tyndall-editor: this is a bug: %s\n", failure.what());
    } catch (const std::bad_alloc&) {
        std::fprintf(stderr, "tyndall-editor: there is not enough memory for this\n");
    } catch (const std::exception& failure) {
        std::fprintf(stderr, "tyndall-editor: this is a bug: %s\n", failure.what());
    }
    return int(tyndall::ExitStatus::Failed);
}
