#include "programs/scenes.h"

#include <fstream>

namespace tyndall::test {
namespace {

constexpr const char* kHead = R"({
  "tyndall": 1,
  "name": "a lamp over a floor",
  "nodes": [
    {"name": "floor", "primitive": {"shape": "box", "size": [4, 0.1, 4]}, "material": {"baseColor": [0.7, 0.6, 0.5], "metallic": 0, "roughness": 1}},
    {"name": "lamp", "light": {"type": "point", "color": [1, 1, 1], "intensity": 50}, "translation": [0, 2, 0]},
)";
constexpr const char* kFog =
    R"(    {"name": "haze", "medium": {"type": "homogeneous", "shape": "height", "scaleHeight": 2, "scattering": [0.1, 0.1, 0.1], "absorption": [0.01, 0.01, 0.01]}},
)";
constexpr const char* kTail =
    R"(    {"name": "eye", "camera": {"type": "perspective", "yfov": 0.8, "znear": 0.05}, "translation": [0, 1, 5]}
  ],
  "camera": "eye"
}
)";

std::filesystem::path write(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path) << text;
    return path;
}

} // namespace

std::filesystem::path writeFoggyScene(const std::filesystem::path& folder) {
    return write(folder / "foggy.scene.json", std::string(kHead) + kFog + kTail);
}
std::filesystem::path writeClearScene(const std::filesystem::path& folder) {
    return write(folder / "clear.scene.json", std::string(kHead) + kTail);
}

} // namespace tyndall::test
