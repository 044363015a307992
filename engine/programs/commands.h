#pragma once
// The subcommands of `tyndall`. Each adds itself to the command line; `run` is set when it was chosen.

#include <functional>

#include "app/outcome.h"
#include "core/progress.h"

namespace CLI {
class App;
}

namespace tyndall {

/// What every subcommand sees of the options before it.
struct GlobalOptions {
    bool quiet = false;
    [[nodiscard]] ProgressStyle progress() const {
        return quiet ? ProgressStyle::Quiet : detectProgressStyle();
    }
};

using Run = std::function<Outcome(const GlobalOptions&)>;

void addCaptureCommand(CLI::App& program, Run& run);
void addCompareCommand(CLI::App& program, Run& run);
void addGraphCommand(CLI::App& program, Run& run);
void addInfoCommand(CLI::App& program, Run& run);
void addReferenceCommand(CLI::App& program, Run& run);

} // namespace tyndall
