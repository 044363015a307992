#include "options.h"

#include <filesystem>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/program.h"

namespace tyndall::editor {
namespace fs = std::filesystem;
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  tyndall-editor\n"
    "      opens the demo scene\n"
    "  tyndall-editor room.gltf\n"
    "  tyndall-editor smoke.scene.json --gi octaves --set octaves.count=3\n"
    "  tyndall-editor smoke.scene.json --converge --frames 64 --size 640x360 --screenshot smoke.png --hidden\n"
    "\nExit status: 0 done; 1 it failed, or there is no display; 2 the command line or a file is wrong.";

void addOptions(CLI::App& program, EditorOptions& options) {
    addRenderOptions(program, options.render, {"the demo scene", "as the viewport has room"});
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
    if (const Result<RenderPlan> plan = understand(options.render); !plan.ok()) return plan.error();
    if (Result<void> window =
            parseSize("--window", options.windowSize, options.windowWidth, options.windowHeight);
        !window.ok())
        return window;
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

std::optional<Outcome> readOptions(int argc, char** argv, EditorOptions& options) {
    options.render.size.clear();
    CLI::App program("A window to look around in a scene with smoke, fog and clouds in it.",
                     "tyndall-editor");
    prepareCommandLine(program, kExamples);
    addOptions(program, options);
    if (std::optional<Outcome> done = readCommandLine(program, argc, argv)) return done;
    if (Result<void> checked = check(options); !checked.ok()) return wrongInput(checked.message());
    return {};
}

} // namespace tyndall::editor
