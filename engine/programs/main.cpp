// `tyndall`: everything without a window. One file a subcommand; this one puts them together.

#include <algorithm>
#include <cstdio>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/program.h"
#include "core/log.h"
#include "core/settings.h"
#include "programs/commands.h"
#include "programs/interrupt.h"

namespace tyndall {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  tyndall capture content/demo.scene.json -o out/demo.png\n"
    "  tyndall reference content/demo.scene.json -o out/reference.exr --size 320x180 --spp 256\n"
    "  tyndall compare out/fast.exr out/reference.exr --heatmap out/where.png\n"
    "  tyndall graph content/demo.scene.json --format dot | dot -Tsvg -o graph.svg\n"
    "  tyndall info smoke.vdb\n"
    "\n'tyndall COMMAND --help' tells more.";

/// A first word that is no option and no command: CLI11 would only say that a command is missing.
Outcome checkCommandName(const CLI::App& program, std::string_view word) {
    std::vector<std::string> names;
    for (const CLI::App* command : program.get_subcommands({}))
        names.push_back(command->get_name());
    if (word.starts_with("-") || std::find(names.begin(), names.end(), word) != names.end())
        return {};
    const std::string nearest =
        nearestName(word, std::vector<std::string_view>(names.begin(), names.end()));
    return wrongInput(fmt::format("'{}' is not a command: {}", word,
                                  nearest.empty()
                                      ? "there are capture, compare, graph, info and reference"
                                      : "did you mean '" + nearest + "'?"));
}

Outcome run(int argc, char** argv) {
    CLI::App program("Renders scenes with smoke, fog and clouds in them, without a window.",
                     "tyndall");
    prepareCommandLine(program, kExamples);
    program.require_subcommand(1);
    program.fallthrough();
    GlobalOptions options;
    Run chosen;
    addCaptureCommand(program, chosen);
    addCompareCommand(program, chosen);
    addGraphCommand(program, chosen);
    addInfoCommand(program, chosen);
    addReferenceCommand(program, chosen);
    for (CLI::App* place : program.get_subcommands({}))
        place->add_flag("-q,--quiet", options.quiet, "Say nothing but warnings and errors");
    program.add_flag("-q,--quiet", options.quiet, "Say nothing but warnings and errors");

    if (argc == 1) {
        std::fputs(program.help().c_str(), stderr);
        return wrongInput("say what to do: capture, compare, graph, info or reference");
    }
    if (Outcome known = checkCommandName(program, argv[1]); !known.ok()) return known;
    if (std::optional<Outcome> done = readCommandLine(program, argc, argv)) return *done;
    if (options.quiet) log::setLevel(log::Level::Warning);
    catchInterrupts();
    return chosen(options);
}

} // namespace
} // namespace tyndall

int main(int argc, char** argv) {
    return tyndall::runProgram("tyndall", [&] { return tyndall::run(argc, argv); });
}
