// `tyndall graph`: the frame graph of one frame, as text, for Graphviz or for scripts.

#include <cstdio>

#include <CLI/CLI.hpp>

#include "app/render_session.h"
#include "framegraph/dump.h"
#include "programs/commands.h"
#include "programs/console_job.h"

namespace tyndall {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  tyndall graph smoke.scene.json\n"
    "  tyndall graph smoke.scene.json --format dot | dot -Tsvg -o graph.svg\n"
    "  tyndall graph smoke.scene.json --gi none --format json -o graph.json";

struct GraphOptions {
    RenderOptions render;
    std::string format = "text", output;
};

Outcome runGraph(const GraphOptions& options, const GlobalOptions& global) {
    const Result<fg::DumpFormat> format = fg::parseDumpFormat(options.format);
    if (!format.ok()) return wrongInput("--format: " + format.message());
    std::unique_ptr<RenderSession> session;
    ConsoleJob job(global.progress());
    if (Outcome opened = RenderSession::open(options.render, job.control(), nullptr, session);
        !opened.ok())
        return opened;
    if (const Result<FrameResult> frame = session->renderer().renderFrame(session->request());
        !frame.ok())
        return failed(frame.message());
    const std::string text = fg::dump(session->renderer().graph(), *format);
    if (!options.output.empty())
        return outcomeOf(writeFileAtomically(options.output, text), ExitStatus::Failed);
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
        return failed("cannot write to standard output");
    return {};
}

} // namespace

void addGraphCommand(CLI::App& program, Run& run) {
    auto options = std::make_shared<GraphOptions>();
    CLI::App* command = program.add_subcommand(
        "graph", "Print the frame graph: passes, resources, barriers, what is skipped and why");
    addRenderOptions(*command, options->render);
    addContextOptions(*command, options->render);
    command->add_option("--format", options->format, "text, dot or json (text)")->type_name("NAME");
    command->add_option("-o,--output", options->output, "A file instead of standard output")
        ->type_name("FILE");
    command->footer(kExamples);
    command->callback([options, &run] {
        run = [options](const GlobalOptions& global) { return runGraph(*options, global); };
    });
}

} // namespace tyndall
