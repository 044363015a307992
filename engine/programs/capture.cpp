// `tyndall capture`: the real-time renderer, headless.

#include <CLI/CLI.hpp>

#include "app/capture_run.h"
#include "programs/commands.h"
#include "programs/console_job.h"

namespace tyndall {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  tyndall capture room.gltf -o room.png\n"
    "      a camera and a light are supplied where the file has none\n"
    "  tyndall capture smoke.scene.json -o smoke.exr --size 1920x1080 --aov depth,transmittance,terms\n"
    "  tyndall capture smoke.vdb -o smoke.png --grid density\n"
    "  tyndall capture smoke.scene.json -o still.exr --converge --frames 1024 --report still.json\n"
    "  tyndall capture smoke.scene.json -o fast.png --quality low --set gi.octaves.count=3 --max-ms 33\n"
    "\nExit status: 0 done; 1 it failed or a threshold was not met; 2 the command line or a file is wrong.";

void addOptions(CLI::App& command, CaptureOptions& options) {
    addRenderOptions(command, options.render);
    addContextOptions(command, options.render);
    command
        .add_option("-o,--output", options.output,
                    "The picture: .exr (linear) or .png (exposed, tone-mapped)")
        ->type_name("OUT")
        ->required();
    command
        .add_option("--frames", options.frames,
                    "Frames to render; the last is written, or each with %04d in OUT (1)")
        ->type_name("N")
        ->check(CLI::Range(1, 1000000));
    command.add_option("--time-step", options.timeStep, "Seconds from frame to frame (1/60)")
        ->type_name("SECONDS");
    command.add_flag("--converge", options.converge,
                     "Average frames of the still scene until the noise is gone, at most --frames");
    command
        .add_option(
            "--aov", options.aovs,
            "More layers for an EXR, comma-separated: depth, normal, albedo, transmittance, terms")
        ->type_name("LIST")
        ->delimiter(',')
        ->allow_extra_args(false);
    command.add_flag("--half", options.half, "Write the EXR in 16-bit instead of 32-bit floats");
    command
        .add_option("--report", options.report, "Write a report as JSON: times, passes, statistics")
        ->type_name("FILE.json");
    command.add_option("--trace", options.trace, "Write Chrome trace events, for ui.perfetto.dev")
        ->type_name("FILE.json");
    command.add_option("--max-ms", options.maxMs, "Fail when the median frame takes longer")
        ->type_name("X")
        ->check(CLI::PositiveNumber);
    command.add_flag("--fail-on-nonfinite", options.failOnNonFinite,
                     "Fail when a pixel is not finite");
}

Outcome runCapture(const CaptureOptions& options, const GlobalOptions& global) {
    if (const Result<void> checked = checkCaptureOptions(options); !checked.ok())
        return wrongInput(checked.message());
    ConsoleJob job(global.progress());
    return CaptureRun(options).run(job.control());
}

} // namespace

void addCaptureCommand(CLI::App& program, Run& run) {
    auto options = std::make_shared<CaptureOptions>();
    CLI::App* command = program.add_subcommand("capture", "Render a scene to a picture");
    addOptions(*command, *options);
    command->footer(kExamples);
    command->callback([options, &run] {
        run = [options](const GlobalOptions& global) { return runCapture(*options, global); };
    });
}

} // namespace tyndall
