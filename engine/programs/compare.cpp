// `tyndall compare`: how far one image is from another, in numbers and as a picture of where.

#include <charconv>
#include <cmath>
#include <cstdio>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/compare_report.h"
#include "app/output_file.h"
#include "core/display_metrics.h"
#include "core/heat_map.h"
#include "core/log.h"
#include "programs/commands.h"

namespace tyndall {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  tyndall compare fast.exr reference.exr\n"
    "      every metric; docs/compare.md says when to look at each\n"
    "  tyndall compare fast.exr reference.exr --max-relmse 0.01 --max-energy-error 0.02 --json result.json\n"
    "      for scripts: exit status 1 if a limit is exceeded\n"
    "  tyndall compare fast.exr reference.exr --heatmap where.png --heatmap-metric signed\n"
    "      blue where fast.exr is too dark, red where it is too bright\n"
    "  tyndall compare fast.exr reference.exr --terms LVE,LSVE\n"
    "      the sum of these layers in both files: the error of the technique that renders these terms\n"
    "  tyndall compare shot.png golden.png --min-ssim 0.98\n"
    "      8-bit pictures: psnr, ssim and flip alone\n"
    "\nExit status: 0 done; 1 invalid values or a limit exceeded; 2 the command line or a file is wrong.";

struct CompareOptions {
    std::string image, reference;
    std::string terms, layer, toneCurve = "agx", json, heatMap, heatMapMetric;
    double heatMapMax = 1;
    std::optional<double> ev100;
    bool reduce = false;
    std::vector<Threshold> thresholds = compareThresholds();
};

Result<ComparedPart> parsePart(const CompareOptions& options) {
    ComparedPart part;
    part.layer = options.layer;
    if (options.terms.empty()) return part;
    const Result<TermSet> terms = parseTerms(options.terms);
    if (!terms.ok()) return Error{"--terms: " + terms.message()};
    part.terms = *terms;
    return part;
}

/// The heat map's metric, which for PNGs can only be flip.
Result<std::string> parseHeatMapMetric(const CompareOptions& options, const ComparedImage& image,
                                       const ComparedPart& part) {
    const std::string& name = options.heatMapMetric;
    if (name.empty()) return std::string(image.displayReferred ? "flip" : "relative");
    if (name == "flip" && !part.isLight())
        return Error{fmt::format(
            "--heatmap-metric flip: {} is not light; it takes relative and signed", part.text())};
    if (name != "flip" && image.displayReferred)
        return Error{
            fmt::format("--heatmap-metric {}: a PNG is not linear light; it takes flip", name)};
    return name;
}

Result<void> checkOptions(const CompareOptions& options) {
    const std::string& metric = options.heatMapMetric;
    if (!metric.empty() && metric != "relative" && metric != "flip" && metric != "signed")
        return Error{fmt::format("--heatmap-metric {}: it takes relative, flip or signed", metric)};
    if (!metric.empty() && options.heatMap.empty())
        return Error{fmt::format(
            "--heatmap-metric {}: say with --heatmap FILE.png where to write it", metric)};
    if (!options.heatMap.empty() && !options.heatMap.ends_with(".png"))
        return Error{fmt::format("--heatmap {}: the name must end in .png", options.heatMap)};
    if (Result<void> folder = checkOutputFolder("--heatmap", options.heatMap); !folder.ok())
        return folder;
    return checkOutputFolder("--json", options.json);
}

Result<void> checkPair(const ComparedImage& image, const ComparedImage& reference) {
    if (image.displayReferred != reference.displayReferred)
        return Error{fmt::format(
            "'{}' is a PNG and '{}' is not: linear images are needed (.exr or .hdr), or two PNGs",
            image.displayReferred ? image.file : reference.file,
            image.displayReferred ? reference.file : image.file)};
    const Image &a = image.image, &b = reference.image;
    if (a.width != b.width || a.height != b.height)
        return Error{fmt::format("'{}' is {}x{} pixels and '{}' {}x{}: they must be of one size",
                                 image.file, a.width, a.height, reference.file, b.width, b.height)};
    if (a.channels != b.channels)
        return Error{fmt::format("'{}' has {} colour channels and '{}' {}: they must have as many",
                                 image.file, a.channels, reference.file, b.channels)};
    return {};
}

std::optional<double> exposureOf(const ComparedImage& image) {
    const auto found = image.metadata.find("tyndall.ev100");
    if (found == image.metadata.end()) return {};
    const std::string& text = found->second;
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
        log::warning(fmt::format("'{}': its key tyndall.ev100 is '{}', which is no exposure",
                                 image.file, text));
        return {};
    }
    return value;
}

Result<CompareDisplay> chooseDisplay(const CompareOptions& options, const ComparedImage& image,
                                     const ComparedImage& reference) {
    CompareDisplay display;
    const Result<ToneCurve> curve = parseToneCurve(options.toneCurve);
    if (!curve.ok()) return Error{"--tone-curve: " + curve.message()};
    display.curve = *curve;
    if (options.ev100) {
        display.ev100 = *options.ev100;
        display.origin = "--ev100";
        return display;
    }
    display.origin = "neither file says";
    for (const ComparedImage* from : {&image, &reference}) // the reference has the last word
        if (const std::optional<double> ev100 = exposureOf(*from)) {
            display.ev100 = *ev100;
            display.origin = "of " + from->file;
        }
    return display;
}

/// What a person should know before reading the numbers.
std::vector<std::string> notesAbout(const ComparedImage& image, const ComparedImage& reference,
                                    const ComparedPart& part) {
    const auto terms = [](const ComparedImage& from) {
        const auto found = from.metadata.find("tyndall.terms");
        return found == from.metadata.end() ? std::string() : found->second;
    };
    const std::string has = terms(image), wants = terms(reference);
    if (part.terms != 0 || !part.isLight() || has.empty() || wants.empty() || has == wants)
        return {};
    return {fmt::format(
        "'{}' has the terms {} and '{}' {}: what one lacks counts as error; --terms compares sums of layers",
        image.file, has, reference.file, wants)};
}

Outcome writeHeatMap(const CompareOptions& options, const std::string& metric,
                     const ComparedImage& image, const ComparedImage& reference,
                     const CompareDisplay& display) {
    Image errors;
    if (metric == "flip") {
        errors = flipMap(shownImage(image, display), shownImage(reference, display));
        const size_t channels = size_t(image.image.channels);
        for (size_t i = 0; i < image.image.pixels.size(); ++i) // shown as black, but not black
            if (!std::isfinite(image.image.pixels[i]) || !std::isfinite(reference.image.pixels[i]))
                errors.pixels[i / channels] = NAN;
    } else {
        errors = metric == "signed" ? signedErrorMap(image.image, reference.image)
                                    : relativeErrorMap(image.image, reference.image);
    }
    const HeatScale scale = metric == "signed" ? HeatScale::Signed : HeatScale::Magnitude;
    const Result<void> written = writePng(options.heatMap, errors.width, errors.height, 3,
                                          heatMap(errors, options.heatMapMax, scale));
    if (!written.ok()) return failed(written.message());
    log::info(fmt::format(
        "wrote {}: {} error, {}, green where a value is not finite", options.heatMap, metric,
        scale == HeatScale::Signed
            ? fmt::format("blue at -{0:g}, white at 0, red at {0:g}", options.heatMapMax)
            : fmt::format("black at 0, pale yellow at {:g} and above", options.heatMapMax)));
    return {};
}

/// A limit on what these files cannot have is a wrong command line; the counts may still spoil what they can have.
Outcome checkThresholdsApply(const CompareReport& report) {
    if (report.image.counts.nonFinite + report.reference.counts.nonFinite > 0) return {};
    for (const Threshold& threshold : report.thresholds)
        if (const Metric& m = report.metric(threshold.metric); !m.value)
            return wrongInput(
                fmt::format("{}: {} cannot be told: {}", threshold.option, m.name, m.note));
    return {};
}

Outcome writeReport(const CompareOptions& options, const GlobalOptions& global,
                    const CompareReport& report) {
    if (!options.json.empty())
        if (const Result<void> written = writeFileAtomically(options.json, report.toJson());
            !written.ok())
            return failed(written.message());
    if (global.quiet) return {};
    const std::string text = report.toText();
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
        return failed("cannot write to standard output");
    return {};
}

Outcome runCompare(const CompareOptions& options, const GlobalOptions& global) {
    if (const Result<void> checked = checkOptions(options); !checked.ok())
        return wrongInput(checked.message());
    const Result<ComparedPart> part = parsePart(options);
    if (!part.ok()) return wrongInput(part.message());
    Result<ComparedImage> image = readCompared(options.image, *part);
    if (!image.ok()) return wrongInput(image.message());
    const Result<ComparedImage> reference = readCompared(options.reference, *part);
    if (!reference.ok()) return wrongInput(reference.message());
    if (options.reduce)
        if (const Result<void> reduced = reduceTo(*reference, *image); !reduced.ok())
            return wrongInput(reduced.message());
    if (const Result<void> pair = checkPair(*image, *reference); !pair.ok())
        return wrongInput(pair.message());
    const Result<std::string> heatMapMetric = parseHeatMapMetric(options, *image, *part);
    if (!heatMapMetric.ok()) return wrongInput(heatMapMetric.message());
    const Result<CompareDisplay> display = chooseDisplay(options, *image, *reference);
    if (!display.ok()) return wrongInput(display.message());

    CompareReport report{
        *image, *reference, *part, *display, {}, {}, notesAbout(*image, *reference, *part)};
    report.metrics = measure(*image, *reference, *part, *display);
    for (const Threshold& threshold : options.thresholds)
        if (threshold.limit) report.thresholds.push_back(threshold);
    if (Outcome applies = checkThresholdsApply(report); !applies.ok()) return applies;
    if (Outcome written = writeReport(options, global, report); !written.ok()) return written;
    if (!options.heatMap.empty())
        if (Outcome written = writeHeatMap(options, *heatMapMetric, *image, *reference, *display);
            !written.ok())
            return written;
    const std::string failure = report.failure();
    return failure.empty() ? Outcome{} : failed(failure);
}

void addOptions(CLI::App& command, CompareOptions& options) {
    command.add_option("A", options.image, "The image: .exr, .hdr, or .png where both are")
        ->required();
    command.add_option("B", options.reference, "The reference that it is compared with")
        ->required();
    CLI::Option* terms =
        command
            .add_option(
                "--terms", options.terms,
                "Compare the sum of these layers, comma-separated: LE, LSE, LVE ... or all, direct")
            ->type_name("LIST");
    command.add_option("--layer", options.layer, "Compare this layer instead of the picture")
        ->type_name("NAME")
        ->excludes(terms);
    command.add_flag("--reduce", options.reduce,
                     "A is a whole number of times as large as B: compare averages of its pixels");
    command
        .add_option("--ev100", options.ev100,
                    "Exposure for psnr, ssim and flip (as in B's metadata, else A's, else 0)")
        ->type_name("EV")
        ->check(CLI::Range(-40.0, 40.0));
    command
        .add_option("--tone-curve", options.toneCurve,
                    "Tone curve for them: linear, aces, agx or neutral (agx)")
        ->type_name("NAME");
    command.add_option("--json", options.json, "Write the metrics as JSON")->type_name("FILE");
    command.add_option("--heatmap", options.heatMap, "Write a picture of the error of each pixel")
        ->type_name("FILE.png");
    command
        .add_option("--heatmap-metric", options.heatMapMetric,
                    "relative, signed or flip (relative; flip for PNGs)")
        ->type_name("NAME");
    command
        .add_option("--heatmap-max", options.heatMapMax, "The error that gets the last colour (1)")
        ->type_name("X")
        ->check(CLI::PositiveNumber);
    for (Threshold& threshold : options.thresholds)
        command.add_option(threshold.option, threshold.limit, threshold.help)
            ->type_name("X")
            ->check(CLI::Number);
}

} // namespace

void addCompareCommand(CLI::App& program, Run& run) {
    auto options = std::make_shared<CompareOptions>();
    CLI::App* command =
        program.add_subcommand("compare", "Measure the difference of an image from a reference");
    addOptions(*command, *options);
    command->footer(kExamples);
    command->callback([options, &run] {
        run = [options](const GlobalOptions& global) { return runCompare(*options, global); };
    });
}

} // namespace tyndall
