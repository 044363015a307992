// Virtual point lights in scenes of media alone, and of fire alone, against the path tracer, which renders its pictures here and now.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/content.h"
#include "vpl_truth.h"

namespace tyndall::test {
namespace {

TEST(VplMediaAlone, ABallLitFromOutside) {
    expectTheTruth({"a ball of coloured fog", R"(
        {"name": "ball", "medium": {"type": "homogeneous", "shape": "sphere", "size": [3, 3, 3], "scattering": [1.2, 1, 0.8],
            "absorption": [0, 0.1, 0.3], "anisotropy": 0.3}},
        {"name": "lamp", "light": {"type": "spot", "intensity": 10, "outerConeAngle": 0.9, "innerConeAngle": 0.7}, "translation": [0, 2.5, 0],
            "rotation": [-0.7071067811865476, 0, 0, 0.7071067811865476]},)",
                    0.005, 0.035});
}

TEST(VplMediaAlone, ThreeMediaOverEachOtherAroundALamp) {
    // Three phase functions. All lights at every point: more rounds of loops than llvmpipe grants, were they not divided.
    Case about{"three media in a box", R"(
        {"name": "lamp", "light": {"type": "point", "intensity": 10, "radius": 0.05}, "translation": [0.4, 0.3, -0.5]},)",
               0.02, 0.045};
    for (const char* phase :
         {R"("phase": "rayleigh")", R"("anisotropy": 0.3)", R"("anisotropy": -0.2)"})
        about.nodes += fmt::format(
            R"({{"medium": {{"type": "homogeneous", "shape": "box", "size": [3, 2, 3], "scattering": [0.4, 0.3, 0.3],
                "absorption": [0, 0.05, 0.1], {}}}}},)",
            phase);
    about.settings.emplace_back("gi.vpl.classes=1");
    expectTheTruth(about);
}

TEST(VplMediaAlone, AWhiteBallInTheSun) {
    expectTheTruth({"a ball without absorption", R"(
        {"name": "ball", "medium": {"type": "homogeneous", "shape": "sphere", "size": [3, 3, 3], "scattering": [1, 1, 1]}},
        {"name": "sun", "light": {"type": "directional", "intensity": 3, "radius": 0.2}, "rotation": [-0.479, 0, 0, 0.878]},)",
                    0.005, 0.055});
}

const std::string kCampfire = (sourceDir() / "content/campfire.vdb").string();

TEST(VplMediaAlone, UnevenSmokeInTheSun) {
    // Light from infinity is aimed at a ball around the smoke, most of which is empty.
    expectTheTruth({"smoke in the sun",
                    fmt::format(R"(
        {{"name": "smoke", "medium": {{"type": "grid", "file": "{}", "grid": "density", "scattering": [2.5, 2.2, 2], "absorption": [0.1, 0.2, 0.4]}},
            "scale": [2, 2, 2], "translation": [0, -1.5, 0]}},
        {{"name": "sun", "light": {{"type": "directional", "intensity": 10}}, "rotation": [-0.479, 0, 0, 0.878]}},)",
                                kCampfire),
                    0.005,
                    0.06,
                    kIndirectInMedia,
                    {"gi.vpl.walks=4096"}});
}

const std::vector<std::string> kFewerWalks = {
    "gi.vpl.walks=256"}; // in a room all meet something, again and again

TEST(VplFireAlone, AGlowingBallLightsARoom) {
    const std::string nodes = kDarkRoom + R"(
        {"name": "fire", "medium": {"type": "homogeneous", "shape": "sphere", "size": [0.8, 0.8, 0.8], "scattering": [1.5, 1.5, 1.5],
            "absorption": [1, 1.2, 1.5], "emission": [30, 12, 3]}, "translation": [0.2, -0.4, 0]},)";
    expectTheTruth({"a glowing ball, media", nodes, 0.006, 0.06, kIndirectInMedia, kFewerWalks});
    expectTheTruth(
        {"a glowing ball, surfaces", nodes, 0.008, 0.08, kIndirectOnSurfaces, kFewerWalks});
}

TEST(VplFireAlone, HotSmokeLightsARoom) {
    const std::string nodes = kDarkRoom + fmt::format(R"(
        {{"name": "fire", "medium": {{"type": "grid", "file": "{}", "grid": "density", "scattering": [2.5, 2.5, 2.5], "absorption": [1.5, 1.5, 1.5],
            "emission": {{"temperatureGrid": "temperature", "scale": 0.02}}}}, "translation": [0, -0.95, 0]}},)",
                                                      kCampfire);
    // Flames are narrower than a texel of the maps of optical depth, 13 degrees: what is even in it lets more light through.
    expectTheTruth({"hot smoke, media", nodes, 0.03, 0.1, kIndirectInMedia, kFewerWalks});
    expectTheTruth({"hot smoke, surfaces", nodes, 0.008, 0.06, kIndirectOnSurfaces, kFewerWalks});
}

} // namespace
} // namespace tyndall::test
