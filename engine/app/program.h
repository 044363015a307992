#pragma once
// What every program's main() does: the command line, its refusals, and the exit status.

#include <functional>
#include <optional>

#include "app/outcome.h"

namespace CLI {
class App;
}

namespace tyndall {

/// "0.1.0".
[[nodiscard]] const char* programVersion();

/// --version, --help, and a help text that ends with these examples.
void prepareCommandLine(CLI::App& program, const char* examples);

/// Reads the command line. A value says that the program is done: --help or --version was printed, or something is wrong; the
/// sentence then names the word, and for one that is not known the nearest that is.
[[nodiscard]] std::optional<Outcome> readCommandLine(CLI::App& program, int argc, char** argv);

/// Runs `body` and turns what became of it, thrown bugs included, into a sentence on stderr and the exit status.
[[nodiscard]] int runProgram(const char* name, const std::function<Outcome()>& body);

} // namespace tyndall
