#include "scene/scene_writer.h"

#include <gtest/gtest.h>

#include "core/image.h"
#include "scene/scene_edit.h"
#include "scene/scene_file.h"
#include "support/content.h"
#include "support/scene_text.h"

namespace tyndall {
namespace {

namespace fs = std::filesystem;

TEST(SceneWriter, WritesOnlyWhatIsNotTheDefaultInStableOrder) {
    const char* text = R"({
  "tyndall": 1,
  "name": "small",
  "nodes": [
    {"name": "lamp", "light": {"type": "point", "intensity": 0.1, "radius": 0.05}, "translation": [0, 2, 0.3]},
    {
      "name": "child",
      "parent": "lamp",
      "primitive": {"shape": "sphere", "size": [1, 1, 2]},
      "material": {"baseColor": [0.7, 0.2, 0.1]}
    },
    {"name": "eye", "camera": {"type": "perspective"}}
  ],
  "camera": "eye",
  "environment": {"radiance": [0.1, 0.2, 0.3]},
  "exposure": {"ev100": -1.5},
  "settings": {"a.b": 0.25, "c": true, "d": "text", "e": 3}
}
)";
    const auto loaded = test::loadSceneText(text);
    ASSERT_TRUE(loaded.ok()) << loaded.message();
    const auto written = sceneFileText(loaded->scene, loaded->scene.path.parent_path());
    ASSERT_TRUE(written.ok()) << written.message();
    EXPECT_EQ(*written, text);
}

TEST(SceneWriter, EveryKeySurvivesTheRoundTrip) {
    // All values differ from their defaults, so that a key that is lost makes the second text differ from this one.
    const char* nodes[] = {
        R"({"name": "a", "light": {"type": "directional", "color": [1, 0.5, 0], "intensity": 20, "radius": 0.004, "castsShadows": false}, "animate": [{"property": "translation", "times": [0, 1], "values": [0, 0, 0, 1, 1, 1], "interpolation": "STEP"}, {"property": "light.intensity", "times": [0.5], "values": [1, 2, 3], "interpolation": "CUBICSPLINE"}]})",
        R"({"light": {"type": "spot", "intensity": 7, "radius": 0.1, "range": 9, "innerConeAngle": 0.2, "outerConeAngle": 0.5}})",
        R"({"light": {"type": "rect", "size": [2, 3], "radiance": [10, 11, 12]}})",
        R"({"medium": {"type": "homogeneous", "shape": "height", "scaleHeight": 20, "scattering": [0.05, 0.06, 0.07], "absorption": [0.005, 0, 0], "anisotropy": 0.3, "phase": "rayleigh", "emission": [1, 2, 3]}})",
        R"({"medium": {"type": "homogeneous", "shape": "sphere", "size": [1, 2, 3]}, "visible": false})",
        R"({"medium": {"type": "particles", "generate": {"kind": "cloud", "count": 10, "seed": 3, "radius": 2}, "scattering": [9, 9, 9]}})",
        R"({"primitive": {"shape": "cylinder", "size": [1, 2, 3]}, "material": {"baseColor": [0.1, 0.2, 0.3, 0.4], "metallic": 0.5, "roughness": 0.25, "specular": 0.75, "emissive": [3, 4, 5], "alphaMode": "MASK", "alphaCutoff": 0.125, "doubleSided": true, "unlit": true, "normalScale": 2, "occlusionStrength": 0.5}})",
        R"({"name": "eye", "camera": {"type": "orthographic", "ymag": 3, "znear": 0.5}, "translation": [1, 2, 3], "rotation": [0, 0.6, 0, 0.8], "scale": [1, 1, -2]})",
        R"({"name": "m", "parent": "a", "matrix": [1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 4, 5, 6, 1]})",
    };
    std::string all;
    for (const char* node : nodes) all += (all.empty() ? "" : ",\n") + std::string(node);
    const auto first = test::loadSceneText(R"({"tyndall": 1, "camera": "eye", "nodes": [)" + all + "]}");
    ASSERT_TRUE(first.ok()) << first.message();
    const auto written = sceneFileText(first->scene, first->scene.path.parent_path());
    ASSERT_TRUE(written.ok()) << written.message();
    const auto without = [](std::string text) { // layout apart
        text.erase(
            std::remove_if(text.begin(), text.end(), [](char c) { return c == ' ' || c == '\n'; }),
            text.end());
        return text;
    };
    for (const char* node : nodes)
        EXPECT_NE(without(*written).find(without(node)), std::string::npos) << node << "\n"
                                                                            << *written;
    const auto second = test::loadSceneText(*written);
    ASSERT_TRUE(second.ok()) << second.message();
    EXPECT_EQ(sceneFileText(second->scene, second->scene.path.parent_path()).value(), *written);
}

TEST(SceneWriter, FileNamesFollowTheSceneToAnotherFolder) {
    const fs::path folder = test::scratchDir("scene-move");
    fs::create_directories(folder / "a");
    fs::create_directories(folder / "b");
    ASSERT_TRUE(
        writeFileAtomically(folder / "a/model.gltf",
                            R"({"asset": {"version": "2.0"}, "nodes": [{"name": "inside"}]})")
            .ok());
    ASSERT_TRUE(
        writeFileAtomically(folder / "a/s.scene.json",
                            R"({"tyndall": 1, "nodes": [{"name": "n", "gltf": "model.gltf"}]})")
            .ok());
    const auto loaded = loadScene(folder / "a/s.scene.json");
    ASSERT_TRUE(loaded.ok()) << loaded.message();
    ASSERT_EQ(loaded->scene.nodes.size(), 3u)
        << "the mounting node, the glTF's node, the supplied camera";
    ASSERT_TRUE(writeSceneFile(loaded->scene, folder / "b/s.scene.json").ok());
    EXPECT_NE(readFile(folder / "b/s.scene.json").value().find(R"("gltf": "../a/model.gltf")"),
              std::string::npos);
    const auto moved = loadScene(folder / "b/s.scene.json");
    ASSERT_TRUE(moved.ok()) << moved.message();
    EXPECT_EQ(moved->scene.nodes.size(), 3u) << "what the glTF file holds is not written twice";
}

TEST(SceneWriter, BareFileCanBeSavedWithWhatWasSupplied) {
    const fs::path folder = test::scratchDir("scene-bare");
    ASSERT_TRUE(
        writeFileAtomically(folder / "model.gltf",
                            R"({"asset": {"version": "2.0"}, "nodes": [{"name": "inside"}]})")
            .ok());
    const auto bare = loadScene(folder / "model.gltf");
    ASSERT_TRUE(bare.ok()) << bare.message();
    EXPECT_EQ(bare->supplied.size(), 3u) << "a camera, a light, an exposure";
    ASSERT_TRUE(writeSceneFile(bare->scene, folder / "model.scene.json").ok());
    const auto saved = loadScene(folder / "model.scene.json");
    ASSERT_TRUE(saved.ok()) << saved.message();
    EXPECT_TRUE(saved->supplied.empty());
    EXPECT_EQ(saved->scene.nodes.size(), bare->scene.nodes.size());
    EXPECT_EQ(saved->scene.lights.at(0).intensity, bare->scene.lights.at(0).intensity);
    EXPECT_EQ(saved->scene.ev100, bare->scene.ev100);
    EXPECT_EQ(saved->scene.environment.radiance, bare->scene.environment.radiance);
}

// --- content ----------------------------------------------------------------------------------------------------

TEST(Content, EverySceneLoadsHasItsCameraAndSurvivesTheRoundTrip) {
    size_t count = 0;
    for (const auto& entry : fs::directory_iterator(test::sourceDir() / "content")) {
        if (entry.path().extension() != ".json") continue;
        SCOPED_TRACE(entry.path().string());
        ++count;
        const auto loaded = loadScene(entry.path());
        ASSERT_TRUE(loaded.ok()) << loaded.message();
        EXPECT_TRUE(loaded->supplied.empty()) << "our own scenes are complete";
        EXPECT_TRUE(loaded->notes.empty()) << loaded->notes.front();
        const fs::path folder = test::scratchDir("content-copy");
        ASSERT_TRUE(writeSceneFile(loaded->scene, folder / "copy.scene.json").ok());
        const auto again = loadScene(folder / "copy.scene.json");
        ASSERT_TRUE(again.ok()) << again.message();
        Scene back = again->scene;
        EXPECT_EQ(sceneFileText(back, folder).value(),
                  readFile(folder / "copy.scene.json").value());
        EXPECT_EQ(back.nodes.size(), loaded->scene.nodes.size());
        EXPECT_EQ(back.worldTransforms(), loaded->scene.worldTransforms());
    }
    EXPECT_GE(count, 8u);
}

} // namespace
} // namespace tyndall
