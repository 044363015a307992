#pragma once
// The options that programs share, each declared once: what it is called, what it means, how its help reads.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/math.h"
#include "core/settings.h"
#include "gl/context.h"
#include "transport/terms.h"

namespace CLI {
class App;
}

namespace tyndall {

/// What is looked at, from where, when: the same for the renderer and for the reference. As on the command line.
struct ViewOptions {
    std::string scene, grid, size = "1280x720", camera, terms;
    double time = 0; // seconds of the scene's clock
    uint64_t seed = 0;
};

/// Those, and what the renderer is to do.
struct RenderOptions : ViewOptions {
    std::string pose, gi, quality, backend = "auto";
    std::vector<std::string> assignments, plugins;
    int device = -1;
};

/// Where the camera is put instead of where its node has it; its lens stays unless `yfov` says otherwise.
struct PoseOption {
    dvec3 position{0};          // metres
    dquat rotation{1, 0, 0, 0}; // unit
    std::optional<double> yfov; // radians, perspective cameras
};

/// ViewOptions, understood.
struct ViewPlan {
    int width = 0, height = 0;
    TermSet terms = kAllTerms;
};

/// RenderOptions, understood.
struct RenderPlan : ViewPlan {
    gl::Backend backend = gl::Backend::Auto;
    std::optional<Quality> quality;
    std::optional<PoseOption> pose;
    std::vector<std::filesystem::path> plugins;
};

/// What stands in for an option that is not given, in words for the help.
struct OptionDefaults {
    const char* scene = nullptr; // null: there must be one
    const char* size = "1280x720";
};

/// SCENE, --grid, --size, --camera, --time, --terms, --seed.
void addViewOptions(CLI::App& command, ViewOptions& options, const OptionDefaults& defaults = {});
/// Those, and --pose, --gi, --quality, --set, --plugin.
void addRenderOptions(CLI::App& command, RenderOptions& options,
                      const OptionDefaults& defaults = {});
/// --backend, --device: for programs that make an OpenGL context of their own.
void addContextOptions(CLI::App& command, RenderOptions& options);

/// Errors name the option, what it says and what it takes.
Result<ViewPlan> understandView(const ViewOptions& options);
Result<RenderPlan> understand(const RenderOptions& options);

/// "1280x720": each side 1 to 16384 pixels. Errors name `option`.
Result<void> parseSize(const char* option, const std::string& text, int& width, int& height);
/// "x,y,z,qx,qy,qz,qw" or the same with ",yfov"; the quaternion is normalised. Errors say what is wrong with it.
Result<PoseOption> parsePose(const std::string& text);
/// What parsePose() reads back exactly.
std::string poseText(const PoseOption& pose);
/// The folders where shared-library plugins lie: beside the program in a build, ../lib/tyndall/plugins when installed.
std::vector<std::filesystem::path> pluginFolders();

} // namespace tyndall
