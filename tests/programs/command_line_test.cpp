// What the programs say: help, versions, refusals.

#include <algorithm>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "programs/process.h"
#include "programs/scenes.h"
#include "support/content.h"

namespace tyndall::test {
namespace {
namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

TEST(CommandLine, HelpHasExamplesAndListsOnlyWhatThereIs) {
    const ProcessResult help = tyndall({"--help"});
    EXPECT_EQ(help.status, 0) << help.err;
    EXPECT_THAT(help.out, AllOf(HasSubstr("Examples:"), HasSubstr("capture"), HasSubstr("compare"),
                                HasSubstr("graph"), HasSubstr("info"), HasSubstr("reference")));
    for (const char* absent : {"bench", "stress"})
        EXPECT_THAT(help.out, Not(HasSubstr("\n  " + std::string(absent) + " ")));
    for (const char* command : {"capture", "compare", "graph", "info", "reference"}) {
        const ProcessResult each = tyndall({command, "--help"});
        EXPECT_EQ(each.status, 0) << each.err;
        EXPECT_THAT(each.out, HasSubstr("Examples:")) << command;
        EXPECT_EQ(each.err, "");
    }
}

TEST(CommandLine, ReferenceHelpHasEveryOptionOfTheInterface) {
    const std::string help = tyndall({"reference", "--help"}).out;
    for (const char* option :
         {"SCENE", "-o,", "--size", "--spp", "--seconds", "--time ", "--target-error", "--terms",
          "--max-depth", "--seed", "--threads", "--resume", "--camera", "--quiet"})
        EXPECT_THAT(help, HasSubstr(option));
}

TEST(CommandLine, CaptureHelpHasEveryOptionOfTheInterface) {
    const std::string help = tyndall({"capture", "--help"}).out;
    for (const char* option :
         {"SCENE",   "-o,",        "--size",   "--backend", "--gi",
          "--terms", "--quality",  "--set",    "--frames",  "--time-step",
          "--time ", "--converge", "--camera", "--seed",    "--device",
          "--aov",   "--report",   "--trace",  "--max-ms",  "--fail-on-nonfinite",
          "--quiet"})
        EXPECT_THAT(help, HasSubstr(option));
}

/// What the help says of an option, line breaks and columns aside.
std::string helpOf(const std::string& help, const std::string& option) {
    const size_t at = help.find("\n  " + option + " ");
    if (at == std::string::npos) return "";
    std::istringstream words(help.substr(at, help.find("\n  -", at + 3) - at));
    std::string text, word;
    while (words >> word) text += word + " ";
    return text;
}

TEST(CommandLine, SharedOptionsReadTheSameInEveryProgram) {
    const std::string capture = tyndall({"capture", "--help"}).out,
                      graph = tyndall({"graph", "--help"}).out,
                      reference = tyndall({"reference", "--help"}).out;
    const fs::path editor = binDir() / "tyndall-editor";
    const std::string window = fs::exists(editor) ? run({editor.string(), "--help"}).out : capture;
    for (const char* option : {"--size", "--camera", "--time", "--terms", "--seed"}) {
        EXPECT_NE(helpOf(capture, option), "") << option;
        EXPECT_EQ(helpOf(capture, option), helpOf(graph, option));
        EXPECT_EQ(helpOf(capture, option), helpOf(reference, option));
    }
    // All but --size, whose default is the viewport's.
    for (const char* option : {"--camera", "--time", "--terms", "--seed", "--gi", "--quality",
                               "--set", "--plugin", "--pose"}) {
        EXPECT_NE(helpOf(capture, option), "") << option;
        EXPECT_EQ(helpOf(capture, option), helpOf(graph, option));
        EXPECT_EQ(helpOf(capture, option), helpOf(window, option));
    }
}

TEST(CommandLine, CompareHelpHasEveryOption) {
    const std::string help = tyndall({"compare", "--help"}).out;
    for (const char* option :
         {"--terms",    "--layer",     "--ev100",          "--tone-curve",
          "--json",     "--heatmap ",  "--heatmap-metric", "--heatmap-max",
          "--reduce",   "--max-rmse",  "--max-relmse ",    "--max-relmse-trimmed",
          "--max-mrse", "--max-smape", "--max-p999",       "--max-energy-error",
          "--min-psnr", "--min-ssim",  "--max-flip",       "--quiet"})
        EXPECT_THAT(help, HasSubstr(option));
}

TEST(CommandLine, VersionIsTheProgramAndThreeNumbers) {
    for (const char* name : {"tyndall", "tyndall-editor"}) {
        if (!fs::exists(binDir() / name)) continue; // the editor can be left out of a build
        const ProcessResult result = run({(binDir() / name).string(), "--version"});
        EXPECT_EQ(result.status, 0) << result.err;
        EXPECT_THAT(result.out,
                    ::testing::MatchesRegex(std::string(name) + " [0-9]+\\.[0-9]+\\.[0-9]+\n"));
    }
}

struct Refusal {
    const char* what;
    std::vector<std::string> arguments;
    std::string sentence; // what the message must hold
};

/// SCENE and OUT stand for a good scene and a good output.
const Refusal kRefusals[] = {
    {"no command", {}, "capture, compare, graph, info or reference"},
    {"an unknown command", {"captur"}, "did you mean 'capture'?"},
    {"an unknown option",
     {"capture", "SCENE", "-o", "OUT", "--frame", "2"},
     "did you mean '--frames'?"},
    {"no output", {"capture", "SCENE"}, "--output"},
    {"no scene", {"capture", "-o", "OUT"}, "SCENE"},
    {"a wrong ending", {"capture", "SCENE", "-o", "a.jpg"}, ".exr or .png"},
    {"a missing folder", {"capture", "SCENE", "-o", "no/such/a.exr"}, "no folder 'no/such'"},
    {"a missing folder of the report",
     {"capture", "SCENE", "-o", "OUT", "--report", "no/a.json"},
     "--report no/a.json"},
    {"a size without height",
     {"capture", "SCENE", "-o", "OUT", "--size", "64"},
     "such as 1280x720"},
    {"a size of nothing", {"capture", "SCENE", "-o", "OUT", "--size", "0x10"}, "1 to 16384"},
    {"an absurd size", {"capture", "SCENE", "-o", "OUT", "--size", "99999x10"}, "1 to 16384"},
    {"an unknown back end", {"capture", "SCENE", "-o", "OUT", "--backend", "vulkan"}, "osmesa"},
    {"an unknown term", {"capture", "SCENE", "-o", "OUT", "--terms", "LE,LSF"}, "LSF"},
    {"an unknown quality", {"capture", "SCENE", "-o", "OUT", "--quality", "best"}, "ultra"},
    {"an unknown layer", {"capture", "SCENE", "-o", "OUT", "--aov", "depht"}, "transmittance"},
    {"layers in a PNG", {"capture", "SCENE", "-o", "a.png", "--aov", "depth"}, ".exr"},
    {"a reference that is no EXR", {"reference", "SCENE", "-o", "a.png"}, ".exr"},
    {"a negative depth",
     {"reference", "SCENE", "-o", "a.exr", "--max-depth", "-1"},
     "--max-depth -1"},
    {"an unknown integrator",
     {"reference", "SCENE", "-o", "a.exr", "--integrator", "fast"},
     "volume, simple and ir"},
    {"a clamp below nothing",
     {"reference", "SCENE", "-o", "a.exr", "--integrator", "ir", "--clamp", "-1"},
     "--clamp -1"},
    {"a depth with walks",
     {"reference", "SCENE", "-o", "a.exr", "--integrator", "ir", "--max-depth", "3"},
     "--max-depth does not go with --integrator ir"},
    {"an endless time", {"reference", "SCENE", "-o", "a.exr", "--time", "inf"}, "finite"},
    {"an endless budget", {"reference", "SCENE", "-o", "a.exr", "--seconds", "inf"}, "finite"},
    {"a time that was once a budget",
     {"reference", "SCENE", "-o", "a.exr", "--time", "30"},
     "--seconds"},
    {"a technique set that is not there",
     {"capture", "SCENE", "-o", "OUT", "--set", "gi.technique=octave"},
     "did you mean 'octaves'?"},
    {"a camera that is not there",
     {"reference", "SCENE", "-o", "a.exr", "--camera", "ey"},
     "did you mean 'eye'?"},
    {"no frames", {"capture", "SCENE", "-o", "OUT", "--frames", "0"}, "--frames"},
    {"a sequence that converges",
     {"capture", "SCENE", "-o", "a-%04d.exr", "--converge"},
     "--converge"},
    {"a plugin that is not there",
     {"capture", "SCENE", "-o", "OUT", "--plugin", "nosuch"},
     "nosuch.so"},
    {"a scene that is not there",
     {"capture", "nosuch.scene.json", "-o", "OUT"},
     "nosuch.scene.json"},
    {"an unknown kind of scene", {"capture", "scene.txt", "-o", "OUT"}, "scene.txt"},
    {"a camera that is not there",
     {"capture", "SCENE", "-o", "OUT", "--camera", "eie"},
     "did you mean 'eye'?"},
    {"an unknown setting",
     {"capture", "SCENE", "-o", "OUT", "--set", "no.such.setting=1"},
     "no.such.setting"},
    {"no assignment", {"capture", "SCENE", "-o", "OUT", "--set", "novalue"}, "KEY=VALUE"},
    {"a technique that is not there",
     {"capture", "SCENE", "-o", "OUT", "--gi", "photon-map"},
     "octaves"},
    {"no reference", {"compare", "a.exr"}, "B is required"},
    {"an image that is not there", {"compare", "nosuch.exr", "b.exr"}, "nosuch.exr"},
    {"an image of no known kind", {"compare", "a.tiff", "b.exr"}, ".exr, .hdr or .png"},
    {"terms and a layer at once",
     {"compare", "a.exr", "b.exr", "--terms", "LE", "--layer", "depth"},
     "--layer"},
    {"a limit that is no number",
     {"compare", "a.exr", "b.exr", "--max-flip", "small"},
     "--max-flip"},
    {"a misspelt limit",
     {"compare", "a.exr", "b.exr", "--max-relmsee", "1"},
     "did you mean '--max-relmse'?"},
    {"an unknown format", {"graph", "SCENE", "--format", "svg"}, "text"},
    {"an unknown kind of file", {"info", "scene.txt"}, "scene.txt"},
    {"a file that is not there", {"info", "nosuch.vdb"}, "nosuch.vdb"},
};

TEST(CommandLine, WhatIsWrongIsRefusedWithOneSentenceAndStatusTwo) {
    ProcessOptions options;
    options.folder = scratchDir("refusals");
    const std::string scene = writeClearScene(options.folder).filename().string();
    for (const Refusal& refusal : kRefusals) {
        std::vector<std::string> arguments = refusal.arguments;
        if (!arguments.empty()) arguments.push_back("--quiet");
        for (std::string& argument : arguments)
            argument = argument == "SCENE" ? scene : argument == "OUT" ? "out.exr" : argument;
        const ProcessResult result = tyndall(arguments, options);
        EXPECT_EQ(result.status, 2) << refusal.what << ": " << result.err;
        EXPECT_THAT(result.err, HasSubstr(refusal.sentence)) << refusal.what;
        EXPECT_EQ(result.out, "") << refusal.what;
        if (!refusal.arguments.empty()) {
            EXPECT_THAT(result.err, StartsWith("tyndall: ")) << refusal.what;
            EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1)
                << refusal.what << ": " << result.err;
        }
        EXPECT_FALSE(fs::exists(options.folder / "out.exr")) << refusal.what;
    }
}

TEST(CommandLine, DamagedFilesAreRefusedByInfo) {
    const fs::path folder = scratchDir("damaged");
    for (const char* name :
         {"a.scene.json", "a.gltf", "a.glb", "a.vdb", "a.nvdb", "a.exr", "a.hdr"}) {
        const fs::path file = folder / name;
        std::ofstream(file) << "this is not what the name promises";
        const ProcessResult result = tyndall({"info", file.string()});
        EXPECT_EQ(result.status, 2) << name << ": " << result.err;
        EXPECT_THAT(result.err, AllOf(StartsWith("tyndall: "), HasSubstr(name)));
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    }
}

TEST(Info, NamesTheBackEndThatItChoseAndTheTechniques) {
    const ProcessResult result = tyndall({"info"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_THAT(result.out,
                AllOf(HasSubstr("egl surfaceless"), HasSubstr("osmesa"), HasSubstr("Chosen: "),
                      HasSubstr("OpenGL 4."), HasSubstr("octaves")));
}

TEST(Info, ListsSettingsThatCaptureTakesBack) {
    const ProcessResult result = tyndall({"info", "--settings"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_THAT(result.out, AllOf(HasSubstr("; default "), HasSubstr("--quality low:"),
                                  HasSubstr("--quality ultra:"), HasSubstr("\ngi.technique\n"),
                                  HasSubstr("text; default auto")));
    // A key stands alone on its line.
    std::istringstream lines(result.out);
    std::string line, key;
    while (std::getline(lines, line))
        if (key.empty() && line.find('.') != std::string::npos &&
            line.find(' ') == std::string::npos)
            key = line;
    ASSERT_NE(key, "") << result.out;
    ProcessOptions options;
    options.folder = scratchDir("settings");
    const std::string scene = writeClearScene(options.folder).filename().string();
    const ProcessResult wrong = tyndall({"capture", scene, "-o", "a.exr", "--size", "8x8",
                                         "--quiet", "--set", key + "=not-a-value"},
                                        options);
    EXPECT_EQ(wrong.status, 2);
    EXPECT_THAT(wrong.err, HasSubstr("'" + key + "' = 'not-a-value'"));
}

TEST(Info, SaysWhatIsInASceneFile) {
    const fs::path scene = writeFoggyScene(scratchDir("info-scene"));
    const ProcessResult result = tyndall({"info", scene.string()});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_THAT(result.out,
                AllOf(HasSubstr("12 triangles"), HasSubstr("light 'lamp': point"),
                      HasSubstr("medium 'haze': height"), HasSubstr("camera 'eye': perspective")));
}

TEST(Info, SaysWhatIsInAVolume) {
    const auto smoke = REQUIRE_CONTENT("vdb/smoke1.vdb");
    const ProcessResult result = tyndall({"info", smoke.string()});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_THAT(result.out, AllOf(HasSubstr("OpenVDB"), HasSubstr("grid 'density': float"),
                                  HasSubstr("active voxels"), HasSubstr("understood")));
}

TEST(Info, SaysWhatParticlesBecome) {
    const fs::path folder = scratchDir("info-particles");
    std::ofstream(folder / "two.csv") << "x,y,z,radius,density,temperature\n"
                                         "0,0,0,1,2,900\n4,0,0,1,2,1500\n";
    std::ofstream(folder / "s.scene.json")
        << R"({"tyndall": 1, "nodes": [{"name": "two", "medium": {"type": "particles", "file": "two.csv"}}]})";
    // The peak lies on a voxel: 105/16 times 2.
    const std::string line =
        "medium 'two': particles from 'two.csv'\n    2 particles in (-1, -1, -1) to (5, 1, 1) m; "
        "voxels of 0.25 m in ";
    for (const char* file : {"two.csv", "s.scene.json"}) {
        const ProcessResult result = tyndall({"info", (folder / file).string()});
        ASSERT_EQ(result.status, 0) << result.err;
        EXPECT_THAT(result.out, HasSubstr(line)) << file;
        EXPECT_THAT(result.out, HasSubstr("density 0 to 13.125, up to 1500 K")) << file;
    }
    std::ofstream(folder / "bad.csv") << "x,y,z,radius,density\n0,0,0,-1,2\n";
    const ProcessResult bad = tyndall({"info", (folder / "bad.csv").string()});
    EXPECT_EQ(bad.status, 2);
    EXPECT_THAT(bad.err, HasSubstr("line 2: radius is -1; it must be greater than 0"));
}

TEST(Graph, ComesInThreeFormats) {
    const fs::path folder = scratchDir("graph");
    const std::string scene = writeFoggyScene(folder).string();
    const ProcessResult text = tyndall({"graph", scene, "--size", "32x32", "--quiet"});
    ASSERT_EQ(text.status, 0) << text.err;
    EXPECT_THAT(text.out, HasSubstr("gbuffer"));
    const ProcessResult dot =
        tyndall({"graph", scene, "--size", "32x32", "--quiet", "--format", "dot"});
    EXPECT_THAT(dot.out, StartsWith("digraph")) << dot.err;
    const ProcessResult json = tyndall({"graph", scene, "--size", "32x32", "--quiet", "--format",
                                        "json", "-o", (folder / "g.json").string()});
    EXPECT_EQ(json.status, 0) << json.err;
    EXPECT_EQ(json.out, "");
    EXPECT_TRUE(fs::exists(folder / "g.json"));
}

} // namespace
} // namespace tyndall::test
