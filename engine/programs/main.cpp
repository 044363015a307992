// `tyndall`: everything without a window. One file a subcommand; this one reads the command line and turns what became of
// it into an exit status and a sentence.

#include <algorithm>
#include <cstdio>
#include <new>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/check.h"
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

int finish(const Outcome& outcome) {
    if (!outcome.ok()) std::fprintf(stderr, "tyndall: %s\n", outcome.message.c_str());
    return int(outcome.status);
}

/// CLI11's sentence without its line breaks; for a word that it does not know, the nearest that it does.
Outcome wrongCommandLine(const CLI::App& program, const CLI::ParseError& error) {
    std::string message = error.what();
    std::replace(message.begin(), message.end(), '\n', ' ');
    const CLI::App* command =
        program.get_subcommands().empty() ? &program : program.get_subcommands().front();
    if (dynamic_cast<const CLI::ExtrasError*>(&error)) {
        const std::vector<std::string> extras = program.remaining(true);
        const std::string word = extras.empty() ? "" : extras.front();
        std::vector<std::string> names;
        for (const CLI::Option* option : command->get_options())
            for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
        const std::vector<std::string_view> candidates(names.begin(), names.end());
        const std::string nearest = nearestName(word.substr(0, word.find('=')), candidates);
        message = fmt::format("'{}' is not known here{}", word,
                              nearest.empty() ? "" : ": did you mean '" + nearest + "'?");
    }
    const std::string place = command == &program ? "" : " " + command->get_name();
    return wrongInput(fmt::format("{} ('tyndall{} --help' lists what there is)", message, place));
}

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
                                  nearest.empty() ? "there are capture, compare, graph, info and reference"
                                                  : "did you mean '" + nearest + "'?"));
}

int run(int argc, char** argv) {
    CLI::App program("Renders scenes with smoke, fog and clouds in them, without a window.",
                     "tyndall");
    program.set_version_flag("--version", "tyndall " TYNDALL_VERSION);
    program.set_help_flag("-h,--help", "Print this and exit");
    program.require_subcommand(1);
    program.fallthrough();
    program.footer(kExamples);
    program.get_formatter()->column_width(34);
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
        return finish(wrongInput("say what to do: capture, compare, graph, info or reference"));
    }
    if (const Outcome known = checkCommandName(program, argv[1]); !known.ok()) return finish(known);
    try {
        program.parse(argc, argv);
    } catch (const CLI::Success& wanted) { // --help, --version
        return program.exit(wanted);
    } catch (const CLI::ParseError& error) {
        return finish(wrongCommandLine(program, error));
    }
    if (options.quiet) log::setLevel(log::Level::Warning);
    catchInterrupts();
    return finish(chosen(options));
}

} // namespace
} // namespace tyndall

int main(int argc, char** argv) {
    try {
        return tyndall::run(argc, argv);
    } catch (const tyndall::CheckFailure& failure) {
        std::fprintf(stderr, "tyndall: this is a bug: %s\n", failure.what());
    } catch (const std::bad_alloc&) {
        std::fprintf(stderr, "tyndall: there is not enough memory for this\n");
    } catch (const std::exception& failure) {
        std::fprintf(stderr, "tyndall: this is a bug: %s\n", failure.what());
    }
    return int(tyndall::ExitStatus::Failed);
}
