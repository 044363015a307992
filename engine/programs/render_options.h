#pragma once
// The options that every command has which renders a scene.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/math.h"
#include "core/settings.h"
#include "gl/context.h"
#include "programs/outcome.h"
#include "transport/terms.h"

namespace CLI {
class App;
}

namespace tyndall {

/// As they stand on the command line.
struct RenderOptions {
    std::string scene;
    std::string size = "1280x720", backend = "auto", gi, terms, quality, camera, pose;
    std::vector<std::string> assignments, plugins;
    double time = 0; // seconds
    uint32_t seed = 0;
    int device = -1;
};

/// Where the camera is put instead of where its node has it; its lens stays unless `yfov` says otherwise.
struct PoseOption {
    dvec3 position{0};          // metres
    dquat rotation{1, 0, 0, 0}; // unit
    std::optional<double> yfov; // radians, perspective cameras
};

/// The same, understood.
struct RenderPlan {
    int width = 0, height = 0;
    gl::Backend backend = gl::Backend::Auto;
    TermSet terms = kAllTerms;
    std::optional<Quality> quality;
    std::optional<PoseOption> pose;
    std::vector<std::filesystem::path> plugins;
};

/// What to render with: --gi, --terms, --quality, --set, --plugin, --seed.
void addTechniqueOptions(CLI::App& command, RenderOptions& options);
/// Those, and the scene, the picture's size, where to look from, and where to render it.
void addRenderOptions(CLI::App& command, RenderOptions& options);
/// Errors name the option, what it says and what it takes.
Result<RenderPlan> understand(const RenderOptions& options);

/// "1280x720": each side 1 to 16384 pixels.
Result<void> parseSize(const std::string& text, int& width, int& height);
/// "x,y,z,qx,qy,qz,qw" or the same with ",yfov"; the quaternion is normalised. Errors say what is wrong with it.
Result<PoseOption> parsePose(const std::string& text);
/// What parsePose() reads back exactly.
std::string poseText(const PoseOption& pose);
/// The folders where shared-library plugins lie: beside the program in a build, ../lib/tyndall/plugins when installed.
std::vector<std::filesystem::path> pluginFolders();

} // namespace tyndall
