#include "options.h"

#include <algorithm>
#include <filesystem>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace tyndall::editor {
namespace fs = std::filesystem;
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  tyndall-editor\n"
    "      opens the demo scene\n"
    "  tyndall-editor room.gltf\n"
    "  tyndall-editor smoke.scene.json --gi octaves --set media.octaves.count=3\n"
    "  tyndall-editor smoke.scene.json --converge --frames 64 --size 640x360 --screenshot smoke.png --hidden\n"
    "\nExit status: 0 done; 1 it failed, or there is no display; 2 the command line or a file is wrong.";

void addOptions(CLI::App& program, EditorOptions& options) {
    RenderOptions& render = options.render;
    program.add_option("SCENE", render.scene,
                       "A scene file, or a .gltf, .glb, .vdb or .nvdb (the demo scene)");
    program
        .add_option("--size", render.size,
                    "Width and height of the picture in pixels (as the viewport has room)")
        ->type_name("WxH");
    addTechniqueOptions(program, render);
    program
        .add_option("--camera", render.camera,
                    "The camera to look through first, by node name (the scene's own)")
        ->type_name("NAME");
    program
        .add_option(
            "--pose", render.pose,
            "Where to look from first: x,y,z,qx,qy,qz,qw in metres and as a quaternion, perhaps ,yfov in radians")
        ->type_name("NUMBERS")
        ->allow_extra_args(false);
    program.add_option("--time", render.time, "Seconds on the scene's clock (0)")
        ->type_name("SECONDS");
    program.add_flag("--converge", options.converge,
                     "Average frames of the still scene until the noise is gone");
    program.add_option("--window", options.windowSize, "Width and height of the window (1600x950)")
        ->type_name("WxH");
    program.add_option("--frames", options.frames, "Render so many frames, then quit")
        ->type_name("N")
        ->check(CLI::Range(1, 1000000));
    program
        .add_option("--screenshot", options.screenshot,
                    "With --frames: write the viewport's picture at the end")
        ->type_name("OUT.png");
    program.add_flag("--hidden", options.hidden,
                     "Let no window appear, and leave the layout alone; a display is still needed");
}

Result<void> check(EditorOptions& options) {
    options.fixedSize = !options.render.size.empty();
    if (!options.fixedSize) options.render.size = RenderOptions{}.size;
    Result<RenderPlan> plan = understand(options.render);
    if (!plan.ok()) return plan.error();
    options.plan = std::move(*plan);
    if (Result<void> window =
            parseSize(options.windowSize, options.windowWidth, options.windowHeight);
        !window.ok())
        return Error{fmt::format("--window {}: it takes WIDTHxHEIGHT, such as 1600x950",
                                 options.windowSize)};
    if (!options.screenshot.empty() && options.frames == 0)
        return Error{
            "--screenshot: say with --frames how many frames to render before it is taken"};
    if (!options.screenshot.empty() && !options.screenshot.ends_with(".png"))
        return Error{fmt::format("--screenshot {}: the name must end in .png", options.screenshot)};
    if (options.hidden && options.frames == 0)
        return Error{"--hidden: nobody could close the window; say with --frames when to quit"};
    if (options.render.scene.empty()) options.render.scene = findDemoScene();
    if (options.render.scene.empty())
        return Error{"content/demo.scene.json is not beside the program; say which scene to open"};
    return {};
}

} // namespace

std::string findDemoScene() {
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
    const fs::path scene = "content/demo.scene.json";
    if (fs::exists(program / "../share/tyndall" / scene, error))
        return (program / "../share/tyndall" / scene).lexically_normal().string();
    // A build folder lies in the folder of its sources.
    for (fs::path folder = program; folder.has_relative_path(); folder = folder.parent_path())
        if (fs::exists(folder / scene, error)) {
            const fs::path nearby = fs::proximate(folder / scene, error);
            return nearby.string().size() < (folder / scene).string().size()
                       ? nearby.string()
                       : (folder / scene).string();
        }
    return {};
}

std::optional<EditorOptions> readCommandLine(int argc, char** argv, Outcome& outcome) {
    EditorOptions options;
    options.render.size.clear();
    CLI::App program("A window to look around in a scene with smoke, fog and clouds in it.",
                     "tyndall-editor");
    program.set_version_flag("--version", "tyndall-editor " TYNDALL_VERSION);
    program.set_help_flag("-h,--help", "Print this and exit");
    program.footer(kExamples);
    program.get_formatter()->column_width(34);
    addOptions(program, options);
    try {
        program.parse(argc, argv);
    } catch (const CLI::Success& wanted) { // --help, --version
        program.exit(wanted);
        return std::nullopt;
    } catch (const CLI::ParseError& error) {
        std::string message = error.what();
        std::replace(message.begin(), message.end(), '\n', ' ');
        outcome = wrongInput(message + " ('tyndall-editor --help' lists what there is)");
        return std::nullopt;
    }
    if (Result<void> checked = check(options); !checked.ok()) {
        outcome = wrongInput(checked.message());
        return std::nullopt;
    }
    return options;
}

} // namespace tyndall::editor
