#include <CLI/CLI.hpp>

#include "app/options.h"

namespace tyndall {

void addViewOptions(CLI::App& command, ViewOptions& options, const OptionDefaults& defaults) {
    std::string sceneHelp = "A scene file, or a .gltf, .glb, .vdb or .nvdb";
    if (defaults.scene) sceneHelp += std::string(" (") + defaults.scene + ")";
    command.add_option("SCENE", options.scene, sceneHelp)->required(defaults.scene == nullptr);
    command
        .add_option(
            "--grid", options.grid,
            "Of a bare .vdb or .nvdb: the grid that is density, by name (by its usual names)")
        ->type_name("NAME");
    command
        .add_option("--size", options.size,
                    std::string("Width and height of the picture in pixels (") + defaults.size +
                        ")")
        ->type_name("WxH");
    command
        .add_option("--camera", options.camera,
                    "The camera to look through, by node name (the scene's own)")
        ->type_name("NAME");
    command.add_option("--time", options.time, "Where the scene's clock starts (0)")
        ->type_name("SECONDS");
    command
        .add_option("--terms", options.terms,
                    "Transport terms to render, comma-separated: LE,LSE,LVE ... (all)")
        ->type_name("LIST");
    command.add_option("--seed", options.seed, "Seed of everything random (0)")->type_name("N");
}

void addRenderOptions(CLI::App& command, RenderOptions& options, const OptionDefaults& defaults) {
    addViewOptions(command, options, defaults);
    command
        .add_option(
            "--pose", options.pose,
            "Put the camera there instead: x,y,z,qx,qy,qz,qw in metres and as a quaternion, perhaps ,yfov in radians")
        ->type_name("NUMBERS")
        ->allow_extra_args(false);
    command
        .add_option("--gi", options.gi,
                    "Technique for indirect light: auto, none, a name, or TERM=NAME,... (auto); "
                    "short for --set gi.technique=NAME")
        ->type_name("NAME");
    command.add_option("--quality", options.quality, "Preset: low, medium, high or ultra")
        ->type_name("NAME");
    command
        .add_option("--set", options.assignments,
                    "Any setting, repeatable; 'tyndall info --settings' lists them")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    command
        .add_option("--plugin", options.plugins,
                    "A shared-library plugin, by name or file, repeatable")
        ->type_name("PLUGIN")
        ->allow_extra_args(false);
}

void addContextOptions(CLI::App& command, RenderOptions& options) {
    command
        .add_option("--backend", options.backend,
                    "How to get an OpenGL context: auto, egl or osmesa (auto)")
        ->type_name("NAME");
    command
        .add_option("--device", options.device,
                    "The EGL device to render on; 'tyndall info' lists them")
        ->type_name("N");
}

} // namespace tyndall
