#include "app/reference_options.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "app/options.h"
#include "app/output_file.h"

namespace tyndall {
namespace {

constexpr int64_t kDefaultSamples = 64; // a pixel

Error wrong(std::string sentence) { return Error{std::move(sentence)}; }

Result<void> checkNumbers(const ReferenceOptions& options, reference::RenderSettings& settings) {
    const Result<ViewPlan> view = understandView(options);
    if (!view.ok()) return view.error();
    settings.width = view->width;
    settings.height = view->height;
    settings.path.terms = view->terms;
    const ReferenceGoals& goals = options.goals;
    if (goals.spp < 0 || goals.spp > (int64_t(1) << 31))
        return wrong(fmt::format("--spp {}: it takes 1 to 2147483648 samples a pixel", goals.spp));
    const auto negative = [](const char* name, double value) {
        return wrong(fmt::format("{} {}: it must be a finite number above 0", name, value));
    };
    if (!(goals.seconds >= 0) || std::isinf(goals.seconds))
        return negative("--seconds", goals.seconds);
    if (!(goals.targetError >= 0) || std::isinf(goals.targetError))
        return negative("--target-error", goals.targetError);
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

Result<void> checkOutput(const ReferenceOptions& options) {
    if (options.output.empty() && options.cache.empty())
        return wrong("-o OUT.exr is needed, or --cache FOLDER: where should the picture go?");
    if (!options.cache.empty() && (options.integrator != "volume" || options.resume))
        return wrong(
            "--cache keeps finished pictures of the volume integrator: it does not go with --integrator or --resume");
    if (options.output.empty()) return {};
    if (!options.output.ends_with(".exr"))
        return wrong(fmt::format("-o {}: the reference writes layers, so its name must end in .exr",
                                 options.output));
    return checkOutputFolder("-o", options.output);
}

} // namespace

Result<void> understandReference(ReferenceOptions& options, reference::RenderSettings& settings) {
    if (Result<void> output = checkOutput(options); !output.ok()) return output;
    if (Result<void> numbers = checkNumbers(options, settings); !numbers.ok()) return numbers;
    if (options.goals.any()) return {};
    if (options.time != 0) // which was once how long to render
        return wrong(fmt::format(
            "--time {}: it sets the scene's clock; say with --seconds how long to render, or with --spp or --target-error how well",
            options.time));
    options.goals.spp = kDefaultSamples;
    return {};
}

} // namespace tyndall
