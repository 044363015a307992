#include "app/program.h"

#include <algorithm>
#include <cstdio>
#include <new>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/settings.h"

namespace tyndall {
namespace {

/// The option of this command that is nearest to the word; empty where none is near.
std::string nearestOption(const CLI::App& command, const std::string& word) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    const std::vector<std::string_view> candidates(names.begin(), names.end());
    return nearestName(word.substr(0, word.find('=')), candidates);
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
        const std::string nearest = nearestOption(*command, word);
        message = fmt::format("'{}' is not known here{}", word,
                              nearest.empty() ? "" : ": did you mean '" + nearest + "'?");
    }
    const std::string place = command == &program ? "" : " " + command->get_name();
    return wrongInput(
        fmt::format("{} ('{}{} --help' lists what there is)", message, program.get_name(), place));
}

int finish(const char* name, const Outcome& outcome) {
    if (!outcome.ok()) std::fprintf(stderr, "%s: %s\n", name, outcome.message.c_str());
    return int(outcome.status);
}

} // namespace

const char* programVersion() { return TYNDALL_VERSION; }

void prepareCommandLine(CLI::App& program, const char* examples) {
    program.set_version_flag("--version", program.get_name() + " " + programVersion());
    program.set_help_flag("-h,--help", "Print this and exit");
    program.footer(examples);
    program.get_formatter()->column_width(34);
}

std::optional<Outcome> readCommandLine(CLI::App& program, int argc, char** argv) {
    try {
        program.parse(argc, argv);
    } catch (const CLI::Success& wanted) { // --help, --version
        program.exit(wanted);
        return Outcome{};
    } catch (const CLI::ParseError& error) {
        return wrongCommandLine(program, error);
    }
    return {};
}

int runProgram(const char* name, const std::function<Outcome()>& body) {
    try {
        return finish(name, body());
    } catch (const std::bad_alloc&) {
        return finish(name, failed("there is not enough memory for this"));
    } catch (const std::exception& failure) { // CheckFailure among them
        return finish(name, failed(fmt::format("this is a bug: {}", failure.what())));
    }
}

} // namespace tyndall
