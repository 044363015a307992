#include "programs/reference_options.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "programs/output_file.h"
#include "programs/render_options.h"

namespace tyndall {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  tyndall reference smoke.scene.json -o truth.exr --size 320x180 --spp 1024\n"
    "  tyndall reference smoke.scene.json -o truth.exr --target-error 1e-4 --time 3600\n"
    "      whichever is reached first\n"
    "  tyndall reference smoke.scene.json -o truth.exr --spp 4096 --resume\n"
    "      goes on where a run that was stopped or killed left off: give the other options as before\n"
    "  tyndall reference smoke.scene.json -o direct.exr --terms LE,LSE,LVE\n"
    "\nThe EXR holds the picture (R G B), each transport term and the variance of the mean. While it works, the picture so\n"
    "far is in OUT.exr and all that is needed to go on in OUT.exr.resume, both saved about every half minute.";

Error wrong(std::string sentence) { return Error{std::move(sentence)}; }

Result<void> checkNumbers(const ReferenceOptions& options, reference::RenderSettings& settings) {
    if (Result<void> size = parseSize(options.size, settings.width, settings.height); !size.ok())
        return Error{size.error().message};
    Result<TermSet> terms = parseTerms(options.terms);
    if (!terms.ok()) return Error{"--terms: " + terms.message()};
    settings.path.terms = *terms;
    if (options.spp < 0 || options.spp > (int64_t(1) << 31))
        return wrong(
            fmt::format("--spp {}: it takes 1 to 2147483648 samples a pixel", options.spp));
    const auto negative = [](const char* name, double value) {
        return wrong(fmt::format("{} {}: it must be a finite number above 0", name, value));
    };
    if (!(options.seconds >= 0) || std::isinf(options.seconds))
        return negative("--time", options.seconds);
    if (!(options.targetError >= 0) || std::isinf(options.targetError))
        return negative("--target-error", options.targetError);
    if (!(options.checkpointSeconds >= 0))
        return negative("--checkpoint", options.checkpointSeconds);
    if (options.maxDepth < 0)
        return wrong(
            fmt::format("--max-depth {}: 0 is unlimited, 1 direct light alone", options.maxDepth));
    if (options.threads < 0 || options.threads > 1024)
        return wrong(
            fmt::format("--threads {}: 0 is all cores, and no more than 1024", options.threads));
    settings.path.maxScatterings = options.maxDepth == 0 ? -1 : options.maxDepth;
    static constexpr std::pair<const char*, reference::Integrator> kIntegrators[] = {
        {"volume", reference::Integrator::Volume},
        {"simple", reference::Integrator::Simple},
        {"ir", reference::Integrator::InstantRadiosity}};
    const auto named = std::find_if(std::begin(kIntegrators), std::end(kIntegrators),
                                    [&](const auto& i) { return options.integrator == i.first; });
    if (named == std::end(kIntegrators))
        return wrong(
            fmt::format("--integrator {}: there are volume, simple and ir", options.integrator));
    settings.integrator = named->second;
    if (settings.integrator == reference::Integrator::InstantRadiosity && options.maxDepth > 0)
        return wrong("--max-depth does not go with --integrator ir: its walks end by chance");
    if (!(options.clamp >= 0) || std::isinf(options.clamp))
        return wrong(fmt::format("--clamp {}: it must be a finite number of metres, 0 or more",
                                 options.clamp));
    settings.clampDistance = options.clamp;
    if (options.transmittance != "exact" && options.transmittance != "ratio")
        return wrong(
            fmt::format("--transmittance {}: there are exact and ratio", options.transmittance));
    settings.path.transmittance = options.transmittance == "ratio"
                                      ? tracing::TransmittanceMode::Ratio
                                      : tracing::TransmittanceMode::Exact;
    settings.seed = options.seed;
    settings.threads = options.threads;
    return {};
}

} // namespace

Result<void> checkReferenceOptions(const ReferenceOptions& options,
                                   reference::RenderSettings& settings) {
    if (options.output.empty() && options.cache.empty())
        return wrong("-o OUT.exr is needed, or --cache FOLDER: where should the picture go?");
    if (!options.cache.empty() && (options.integrator != "volume" || options.resume))
        return wrong(
            "--cache keeps finished pictures of the volume integrator: it does not go with --integrator or --resume");
    if (options.output.empty()) return checkNumbers(options, settings);
    if (!options.output.ends_with(".exr"))
        return wrong(fmt::format("-o {}: the reference writes layers, so its name must end in .exr",
                                 options.output));
    if (Result<void> folder = checkOutputFolder("-o", options.output); !folder.ok())
        return Error{folder.error().message};
    return checkNumbers(options, settings);
}

void addReferenceOptions(CLI::App& command, ReferenceOptions& options) {
    command.add_option("SCENE", options.scene, "A scene file, or a .gltf, .glb, .vdb or .nvdb")
        ->required();
    command.add_option("-o,--output", options.output, "The EXR to write")->type_name("OUT.exr");
    command.add_option("--size", options.size, "Width and height in pixels (1280x720)")
        ->type_name("WxH");
    command.add_option("--spp", options.spp, "Samples a pixel (64, where no other goal is given)")
        ->type_name("N");
    command.add_option("--time", options.seconds, "Render for so long")->type_name("SECONDS");
    command
        .add_option("--target-error", options.targetError,
                    "Render until the estimated relmse is no more")
        ->type_name("RELMSE");
    command
        .add_option("--terms", options.terms,
                    "Transport terms, comma-separated: LE,LSE,LVE ... (all)")
        ->type_name("LIST");
    command
        .add_option("--max-depth", options.maxDepth, "Most scatterings of a path; 0: unlimited (0)")
        ->type_name("N");
    command.add_option("--camera", options.camera, "The camera, by node name (the scene's own)")
        ->type_name("NAME");
    command.add_option("--seed", options.seed, "Seed of everything random (0)")->type_name("N");
    command.add_option("--threads", options.threads, "Threads; 0: one a core (0)")->type_name("N");
    command.add_flag("--resume", options.resume,
                     "Go on where the last run of this picture stopped");
    command.add_flag("--keep-checkpoint", options.keep,
                     "Leave OUT.exr.resume when done, for more samples later");
    command.add_option("--checkpoint", options.checkpointSeconds, "Save at least this often (30)")
        ->type_name("SECONDS");
    command
        .add_option(
            "--integrator", options.integrator,
            "volume; simple: slow, short, without aiming at lights, so that lights without extent stay dark; or ir: virtual point lights of a walk for each "
            "sample, and what their bound takes away")
        ->type_name("NAME");
    command
        .add_option(
            "--clamp", options.clamp,
            "With ir: virtual lights nearer than this count as this near, and paths bring the rest (0.1)")
        ->type_name("METRES");
    command
        .add_option("--transmittance", options.transmittance,
                    "Of grids: ratio, unbiased estimates, or exact, slower (ratio)")
        ->type_name("NAME");
    command
        .add_option(
            "--cache", options.cache,
            "Keep the picture in this folder, by scene, size and version, and take it from there when it is good enough")
        ->type_name("FOLDER");
    command.add_flag("--half", options.half, "Write 16-bit floats");
    command.add_option("--report", options.report, "Write what it took as JSON")->type_name("FILE");
    command.footer(kExamples);
}

} // namespace tyndall
