// `tyndall reference`: the picture as it ought to be, from the CPU path tracer, with how far it may still be off.

#include <cstdio>

#include <CLI/CLI.hpp>

#include "app/reference_run.h"
#include "programs/commands.h"
#include "programs/console_job.h"

namespace tyndall {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  tyndall reference smoke.scene.json -o reference.exr --size 320x180 --spp 1024\n"
    "  tyndall reference smoke.scene.json -o reference.exr --target-error 1e-4 --seconds 3600\n"
    "      whichever is reached first\n"
    "  tyndall reference smoke.scene.json -o reference.exr --spp 4096 --resume\n"
    "      continues a run that was stopped or killed: give the other options as before\n"
    "  tyndall reference smoke.scene.json -o direct.exr --terms LE,LSE,LVE\n"
    "\nThe EXR holds the picture (R G B), each transport term and the variance of the mean. While it works, the picture so\n"
    "far is in OUT.exr and the state to continue from in OUT.exr.resume, both saved about every half minute.";

void addOptions(CLI::App& command, ReferenceOptions& options) {
    addViewOptions(command, options);
    command.add_option("-o,--output", options.output, "The EXR to write")->type_name("OUT.exr");
    command
        .add_option("--spp", options.goals.spp,
                    "Samples a pixel (64, where no other goal is given)")
        ->type_name("N");
    command.add_option("--seconds", options.goals.seconds, "Render for this long")
        ->type_name("SECONDS");
    command
        .add_option("--target-error", options.goals.targetError,
                    "Render until the estimated relmse is at most this")
        ->type_name("RELMSE");
    command
        .add_option("--max-depth", options.maxDepth, "Most scatterings of a path; 0: unlimited (0)")
        ->type_name("N");
    command.add_option("--threads", options.threads, "Threads; 0: one a core (0)")->type_name("N");
    command.add_flag("--resume", options.resume, "Continue the last run of this picture");
    command.add_flag("--keep-checkpoint", options.keep,
                     "Leave OUT.exr.resume when done, for more samples later");
    command.add_option("--checkpoint", options.checkpointSeconds, "Save at least this often (30)")
        ->type_name("SECONDS");
    command
        .add_option(
            "--integrator", options.integrator,
            "volume; simple: short and slow, without next-event estimation, so that lights without extent stay dark; or ir: unbiased virtual point lights (volume)")
        ->type_name("NAME");
    command
        .add_option(
            "--clamp", options.clamp,
            "With ir: clamping distance of virtual lights; the mean does not depend on it (0.1)")
        ->type_name("METRES");
    command
        .add_option("--transmittance", options.transmittance,
                    "In grids: ratio (unbiased estimates) or exact (slower) (ratio)")
        ->type_name("NAME");
    command
        .add_option(
            "--cache", options.cache,
            "Keep pictures in this folder by scene, size and version, and reuse one that is good enough")
        ->type_name("FOLDER");
    command.add_flag("--half", options.half, "Write 16-bit floats");
    command.add_option("--report", options.report, "Write a report as JSON")->type_name("FILE");
}

Outcome runReference(const ReferenceOptions& options, const GlobalOptions& global) {
    ConsoleJob job(global.progress());
    ReferenceRun run(options);
    Outcome outcome = run.run(job.control());
    if (outcome.ok() &&
        !options.cache.empty()) // under a name of its own, which scripts want to know
        std::printf("%s\n", run.pictureFile().c_str());
    return outcome;
}

} // namespace

void addReferenceCommand(CLI::App& program, Run& run) {
    auto options = std::make_shared<ReferenceOptions>();
    CLI::App* command = program.add_subcommand(
        "reference", "Render the reference picture of a scene by path tracing");
    addOptions(*command, *options);
    command->footer(kExamples);
    command->callback([options, &run] {
        run = [options](const GlobalOptions& global) { return runReference(*options, global); };
    });
}

} // namespace tyndall
