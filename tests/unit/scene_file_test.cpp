#include "scene/scene_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/image.h"
#include "scene/scene_edit.h"
#include "scene/scene_writer.h"
#include "support/content.h"
#include "support/scene_text.h"

namespace tyndall {
namespace {

namespace fs = std::filesystem;

Result<LoadedScene> loadNode(const std::string& node) {
    return test::loadSceneText(R"({"tyndall": 1, "nodes": [)" + node + "]}");
}

/// The sentence after the file's name.
std::string refusal(const Result<LoadedScene>& result) {
    if (result.ok()) return "(loaded)";
    const std::string& message = result.message();
    const size_t name = message.find("test.scene.json: ");
    return name == std::string::npos ? message : message.substr(name + 17);
}

TEST(SceneFile, CornellBoxLoads) {
    const auto loaded = loadScene(test::sourceDir() / "content/cornell.scene.json");
    ASSERT_TRUE(loaded.ok()) << loaded.message();
    const Scene& scene = loaded->scene;
    EXPECT_EQ(scene.name, "Cornell box");
    EXPECT_EQ(scene.nodes[size_t(scene.activeCamera)].name, "eye");
    // Floor to ceiling, wall to wall; the walls face inwards.
    const Bounds bounds = scene.worldBounds();
    EXPECT_NEAR(glm::distance(bounds.minimum, dvec3(-1, 0, -1)), 0, 1e-6);
    EXPECT_NEAR(glm::distance(bounds.maximum, dvec3(1, 2, 1)), 0, 1e-6);
    const auto world = scene.worldTransforms();
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        if (!scene.nodes[i].primitive || scene.nodes[i].primitive->shape != PrimitiveShape::Plane)
            continue;
        const dvec3 normal = dmat3(world[i]) * dvec3(0, 1, 0);
        EXPECT_GT(glm::dot(normal, dvec3(0, 1, 0) - dvec3(world[i][3])), 0) << scene.nodes[i].name;
    }
}

TEST(SceneFile, ContentIsWhatStandsInALandscape) {
    const auto contentOf = [](const std::string& nodes) {
        const auto loaded = test::loadSceneText(R"({"tyndall": 1, "camera": "eye", "nodes": [)" + nodes +
                                     R"({"name": "eye", "camera": {"type": "perspective"}}]})");
        EXPECT_TRUE(loaded.ok()) << loaded.message();
        return loaded->scene.contentBounds();
    };
    const auto box = [](const char* name, double x, double y, double z) {
        return fmt::format(
            R"({{"name": "{}", "primitive": {{"shape": "box", "size": [{}, {}, {}]}}, "translation": [0, {}, 0]}},)",
            name, x, y, z, y / 2);
    };
    const std::string hut = box("hut", 4, 3, 5), stone = box("stone", 0.2, 0.1, 0.2);
    const std::string meadow = box("meadow", 200, 0.001, 200), sea = box("sea", 300, 0.001, 300);
    EXPECT_NEAR(contentOf(hut + meadow).extent().x, 4, 1e-6);
    EXPECT_NEAR(contentOf(hut + sea + stone + meadow).extent().z, 5, 1e-6);
    // A yard is not a landscape, nor is a room around a ball, nor one box alone.
    EXPECT_NEAR(contentOf(hut + box("yard", 20, 0.001, 20)).extent().x, 20, 1e-6);
    EXPECT_NEAR(contentOf(stone + box("room", 9, 6, 9)).extent().x, 9, 1e-6);
    EXPECT_NEAR(contentOf(meadow).extent().x, 200, 1e-6);
    EXPECT_TRUE(contentOf("").empty());
}

TEST(SceneFile, EveryKeyOfANodeArrives) {
    const auto loaded = test::loadSceneText(R"({"tyndall": 1, "name": "all", "camera": "eye", "nodes": [
        {"name": "child", "parent": "lamp", "translation": [1, 2, 3], "rotation": [0, 0, 2, 2], "scale": [1, 2, -3], "visible": false},
        {"name": "lamp", "light": {"type": "spot", "color": [1, 0.5, 0], "intensity": 100, "range": 7, "radius": 0.25,
          "innerConeAngle": 0.2, "outerConeAngle": 0.5, "castsShadows": false},
          "animate": {"property": "light.color", "times": [0, 1], "values": [[1,1,1],[0,0,0]], "interpolation": "STEP"}},
        {"name": "panel", "light": {"type": "rect", "size": [2, 3], "radiance": [10, 11, 12]}},
        {"name": "haze", "medium": {"type": "homogeneous", "shape": "height", "scaleHeight": 20, "scattering": [0.05, 0.06, 0.07],
          "absorption": [0.005, 0, 0], "anisotropy": 0.3, "phase": "cornette-shanks", "emission": [1, 2, 3]}},
        {"name": "ball", "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 4,5,6,1], "medium": {"type": "homogeneous", "shape": "sphere", "size": [1, 2, 3]}},
        {"name": "thing", "primitive": {"shape": "cylinder", "size": [1, 2, 3]}, "material": {"baseColor": [0.1, 0.2, 0.3, 0.4],
          "metallic": 0.5, "roughness": 0.25, "specular": 0.75, "emissive": [3, 4, 5], "alphaMode": "MASK", "alphaCutoff": 0.125,
          "doubleSided": true, "unlit": true, "normalScale": 2, "occlusionStrength": 0.5}},
        {"name": "eye", "camera": {"type": "orthographic", "ymag": 3, "znear": 0.5}}],
        "environment": {"radiance": [1, 2, 3]}, "exposure": {"ev100": 7.5},
        "settings": {"z.b": true, "a.f": 0.1, "m.s": "text", "i": 12}})");
    ASSERT_TRUE(loaded.ok()) << loaded.message();
    const Scene& scene = loaded->scene;
    EXPECT_TRUE(loaded->supplied.empty());
    EXPECT_EQ(scene.name, "all");
    EXPECT_EQ(scene.ev100, 7.5f);
    EXPECT_EQ(scene.environment.radiance, vec3(1, 2, 3));
    EXPECT_EQ(scene.settings, (std::vector<std::string>{"z.b=true", "a.f=0.1", "m.s=text", "i=12"}))
        << "in the order written";
    const auto node = [&](const std::string& name) -> const Node& {
        for (const Node& one : scene.nodes)
            if (one.name == name) return one;
        CHECK(false, name);
    };
    const Node& child = node("child");
    EXPECT_EQ(scene.nodes[size_t(child.parent)].name, "lamp")
        << "a parent may stand after its child in the file";
    EXPECT_EQ(child.translation, dvec3(1, 2, 3));
    EXPECT_NEAR(child.rotation.z, std::sqrt(0.5), 1e-15) << "a quaternion is made unit";
    EXPECT_EQ(child.scale, dvec3(1, 2, -3));
    EXPECT_FALSE(child.visible);
    const Light& spot = scene.lights[size_t(node("lamp").light)];
    EXPECT_EQ(spot.type, LightType::Spot);
    EXPECT_EQ(spot.color, vec3(1, 0.5, 0));
    EXPECT_EQ(spot.intensity, 100);
    EXPECT_EQ(spot.range, 7);
    EXPECT_EQ(spot.radius, 0.25);
    EXPECT_EQ(spot.innerConeAngle, 0.2f);
    EXPECT_EQ(spot.outerConeAngle, 0.5f);
    EXPECT_FALSE(spot.castsShadows);
    const Animation& animation = node("lamp").animations.at(0);
    EXPECT_EQ(animation.property, "light.color");
    EXPECT_EQ(animation.interpolation, Interpolation::Step);
    EXPECT_EQ(animation.values, (std::vector<double>{1, 1, 1, 0, 0, 0}));
    const Light& panel = scene.lights[size_t(node("panel").light)];
    EXPECT_EQ(panel.type, LightType::Rect);
    EXPECT_EQ(panel.size, vec2(2, 3));
    EXPECT_EQ(panel.radiance, vec3(10, 11, 12));
    const Medium& haze = scene.media[size_t(node("haze").medium)];
    EXPECT_EQ(haze.kind, MediumKind::Height);
    EXPECT_EQ(haze.scaleHeight, 20);
    EXPECT_EQ(haze.scattering, vec3(0.05f, 0.06f, 0.07f));
    EXPECT_EQ(haze.absorption, vec3(0.005f, 0, 0));
    EXPECT_EQ(haze.anisotropy, 0.3f);
    EXPECT_EQ(haze.phase, PhaseFunction::CornetteShanks);
    EXPECT_EQ(haze.emission, vec3(1, 2, 3));
    const Medium& ball = scene.media[size_t(node("ball").medium)];
    EXPECT_EQ(ball.kind, MediumKind::Sphere);
    EXPECT_EQ(ball.size, dvec3(1, 2, 3));
    EXPECT_EQ(dvec3(node("ball").localTransform()[3]), dvec3(4, 5, 6));
    const Material& material = scene.materialOf(scene.meshes[size_t(node("thing").meshes.at(0))]);
    EXPECT_EQ(material.baseColor, vec4(0.1f, 0.2f, 0.3f, 0.4f));
    EXPECT_EQ(material.metallic, 0.5f);
    EXPECT_EQ(material.roughness, 0.25f);
    EXPECT_EQ(material.specular, 0.75f);
    EXPECT_EQ(material.emissive, vec3(3, 4, 5));
    EXPECT_EQ(material.alphaMode, AlphaMode::Mask);
    EXPECT_EQ(material.alphaCutoff, 0.125f);
    EXPECT_TRUE(material.doubleSided);
    EXPECT_TRUE(material.unlit);
    EXPECT_EQ(material.normalScale, 2);
    EXPECT_EQ(material.occlusionStrength, 0.5f);
    const Camera& camera = scene.cameras[size_t(node("eye").camera)];
    EXPECT_EQ(camera.type, CameraType::Orthographic);
    EXPECT_EQ(camera.ymag, 3);
    EXPECT_EQ(camera.znear, 0.5);
    for (const Version version : {scene.versions.structure, scene.versions.lights,
                                  scene.versions.environment, scene.lights[0].version})
        EXPECT_GT(version, 0u) << "never-loaded is 0";
}

TEST(SceneFile, RefusalsNameThePlaceAndTheRemedy) {
    struct Case {
        const char* node;
        const char* sentence;
    };
    const Case cases[] = {
        {R"({"lihgt": {}})", "/nodes/0 has the unknown key 'lihgt'; did you mean 'light'?"},
        {R"({"light": {"type": "point", "intensty": 1}})",
         "/nodes/0/light has the unknown key 'intensty'; did you mean 'intensity'?"},
        {R"({"light": {"type": "point", "intensity": -1}})",
         "/nodes/0/light/intensity is -1 but must be at least 0"},
        {R"({"light": {"type": "point", "intensity": "1"}})",
         "/nodes/0/light/intensity is \"1\" but must be of type number"},
        {R"({"light": {"type": "pint"}})",
         "/nodes/0/light/type is \"pint\" but must be directional, point, spot or rect"},
        {R"({"light": {}})", "/nodes/0/light lacks the key 'type', which is required"},
        {R"({"light": {"type": "rect", "intensity": 1}})",
         "/nodes/0/light has the key 'intensity', which does not apply to a rect light; it takes type, size, radiance, castsShadows"},
        {R"({"light": {"type": "spot", "innerConeAngle": 0.5, "outerConeAngle": 0.5}})",
         "/nodes/0/light/innerConeAngle is 0.5 but must be less than outerConeAngle, 0.5"},
        {R"({"translation": [1, 2]})", "/nodes/0/translation has 2 elements but must have 3"},
        {R"({"rotation": [0, 0, 0, 0]})",
         "/nodes/0/rotation is not a rotation: a quaternion x, y, z, w of length 1 is wanted"},
        {R"({"matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1], "scale": [1,1,1]})",
         "/nodes/0 has both 'matrix' and 'scale'; one of them would do"},
        {R"({"matrix": [1,0,0,1, 0,1,0,0, 0,0,1,0, 0,0,0,1]})",
         "/nodes/0/matrix is not affine: its last row (elements 3, 7, 11 and 15) must be 0, 0, 0, 1"},
        {R"({"translation": [1e31, 0, 0]})",
         "/nodes/0/translation/0 is 1e+31 but must be at most 1e+30"},
        {R"({"parent": "x"})",
         "/nodes/0/parent is 'x', which is not the name of a node of this file"},
        {R"({"name": "a", "parent": "a"})",
         "/nodes holds parents that are below their own children; parents must form a tree"},
        {R"({"name": "a"}, {"name": "a"})",
         "/nodes/1/name is 'a' as in /nodes/0, but names must be unique"},
        {R"({"material": {}})", "/nodes/0 has a 'material' without a 'primitive' to wear it"},
        {R"({"primitive": {"shape": "box", "size": [1, 1]}})",
         "/nodes/0/primitive/size has 2 elements but must have 3 for a box"},
        {R"({"primitive": {"shape": "box", "size": [1, 0, 1]}})",
         "/nodes/0/primitive/size/1 is 0 but must be at least 1e-09"},
        {R"({"medium": {"type": "homogeneous"}})",
         "/nodes/0/medium lacks the key 'shape', which a homogeneous medium needs: everywhere, box, sphere or height"},
        {R"({"medium": {"type": "homogeneous", "shape": "everywhere", "size": [1,1,1]}})",
         "/nodes/0/medium/size does not apply to the shape everywhere"},
        {R"({"medium": {"type": "grid"}})",
         "/nodes/0/medium lacks the key 'file', which a medium of type grid needs: a .vdb or .nvdb file"},
        {R"({"medium": {"type": "grid", "file": "a%04d.vdb"}})",
         "/nodes/0/medium lacks the key 'frames', which a file name with a % pattern needs: [first, last]"},
        {R"({"medium": {"type": "grid", "file": "a%s.vdb", "frames": [1, 2]}})",
         "/nodes/0/medium/file: 'a%s.vdb' is not a file pattern: exactly one %d, %4d or %04d is wanted"},
        {R"({"medium": {"type": "particles"}})",
         "/nodes/0/medium needs either a 'file' or a rule to 'generate' its particles, one of the two"},
        {R"({"medium": {"type": "homogeneous", "shape": "box", "anisotropy": 1}})",
         "/nodes/0/medium/anisotropy is 1 but must be at most 0.9999"},
        {R"({"medium": {"type": "homogeneous", "shape": "box", "emission": 1}})",
         "/nodes/0/medium/emission is 1 but must be of type array or object"},
        {R"({"medium": {"type": "homogeneous", "shape": "box", "emission": {"temperatureGrid": "t"}}})",
         "/nodes/0/medium/emission names a temperatureGrid, but a homogeneous medium has no grids"},
        {R"({"camera": {"type": "perspective", "ymag": 1}})",
         "/nodes/0/camera has the key 'ymag', which does not apply to a perspective camera; it takes type, yfov, znear"},
        {R"({"animate": {"property": "translation", "times": [0, 1], "values": [[0,0,0]]}})",
         "/nodes/0/animate/values holds 3 numbers but 2 times of 'translation' need 6"},
        {R"({"animate": {"property": "translation", "times": [1, 1], "values": [0,0,0,0,0,0]}})",
         "/nodes/0/animate/times/1 must be later than the time before"},
        {R"({"animate": {"property": "light.color", "times": [1], "values": [0,0,0]}})",
         "/nodes/0/animate/property is 'light.color' but the node has no light"},
        {R"({"name": 1})", "/nodes/0/name is 1 but must be of type string"},
        {R"([])", "/nodes/0 is [] but must be of type object"},
    };
    for (const Case& one : cases) EXPECT_EQ(refusal(loadNode(one.node)), one.sentence) << one.node;
}

TEST(SceneFile, WholeFileRefusals) {
    EXPECT_EQ(
        refusal(test::loadSceneText("{")),
        "line 1, column 2: not valid JSON: syntax error while parsing object key - unexpected end of input; expected string literal");
    EXPECT_EQ(refusal(test::loadSceneText("[]")), "the file is [] but must be of type object");
    EXPECT_EQ(refusal(test::loadSceneText("{}")), "the file lacks the key 'tyndall', which is required");
    EXPECT_EQ(refusal(test::loadSceneText(R"({"tyndall": 2})")), "/tyndall is 2 but must be 1");
    EXPECT_EQ(refusal(test::loadSceneText(R"({"tyndall": 1, "tyndall": 1})")),
              "key 'tyndall' stands twice in one JSON object");
    EXPECT_EQ(refusal(test::loadSceneText(R"({"tyndall": 1, "camera": "eye"})")),
              "/camera is 'eye', which is not the name of a node with a camera; there is none");
    EXPECT_EQ(
        refusal(test::loadSceneText(R"({"tyndall": 1, "environment": {"rotation": 1}})")),
        "/environment has the key 'rotation', which does not apply to an environment without a file; it takes radiance");
    EXPECT_EQ(refusal(test::loadSceneText(std::string(100, '['))),
              "line 1, column 65: JSON nests deeper than 64 levels");
    EXPECT_NE(refusal(test::loadSceneText(R"({"tyndall": 1, "name": 1e999})"))
                  .find("not valid JSON: number overflow"),
              std::string::npos);
    EXPECT_NE(refusal(test::loadSceneText("{\"tyndall\": 1, \"name\": \"\xff\"}")).find("not valid JSON"),
              std::string::npos);
    // Each number is fine, their product is not.
    std::string chain;
    for (int i = 0; i < 12; ++i)
        chain += (i ? ", " : "") + std::string("{\"name\": \"n") + std::to_string(i) +
                 "\", \"scale\": [1e20, 1, 1]" +
                 (i ? ", \"parent\": \"n" + std::to_string(i - 1) + "\"" : "") + "}";
    EXPECT_NE(refusal(loadNode(chain)).find("node 'n1' (number 1) ends up beyond 1e30 metres"),
              std::string::npos)
        << refusal(loadNode(chain));
    EXPECT_NE(loadScene("nowhere.scene.json").message().find("nowhere.scene.json"),
              std::string::npos);
    EXPECT_EQ(
        loadScene("a.obj").message(),
        "a.obj: '.obj' is not the ending of a scene; .scene.json, .gltf, .glb, .vdb and .nvdb are read");
}

TEST(SceneFile, LoadingCanBeCancelled) {
    const fs::path folder = test::scratchDir("scene-cancel");
    ASSERT_TRUE(writeFileAtomically(folder / "a.scene.json",
                                    R"({"tyndall": 1, "nodes": [{"gltf": "a.gltf"}]})")
                    .ok());
    LoadOptions options;
    std::vector<std::string> reported;
    options.progress = [&](float fraction, const std::string& what) {
        EXPECT_GE(fraction, 0);
        EXPECT_LE(fraction, 1);
        reported.push_back(what);
        return false;
    };
    EXPECT_EQ(loadScene(folder / "a.scene.json", options).message(), "cancelled");
    EXPECT_EQ(reported, (std::vector<std::string>{"a.gltf"}));
}

TEST(SceneFile, EndlessMediumUnderTheSkyIsNoted) {
    const std::string medium =
        R"({"name": "fog", "medium": {"type": "homogeneous", "shape": "everywhere", "scattering": [1,1,1]}})";
    const auto dark = loadNode(medium);
    ASSERT_TRUE(dark.ok()) << dark.message();
    EXPECT_TRUE(dark->notes.empty());
    const auto sunny = loadNode(medium + R"(, {"light": {"type": "directional"}})");
    ASSERT_TRUE(sunny.ok()) << sunny.message();
    ASSERT_EQ(sunny->notes.size(), 1u);
    EXPECT_NE(sunny->notes[0].find("'height' or 'box'"), std::string::npos);
}

TEST(SceneFile, ParticlesBecomeBricks) {
    const auto loaded = loadNode(
        R"({"medium": {"type": "particles", "generate": {"kind": "cloud", "count": 10, "seed": 3, "radius": 2}, "scattering": [9,9,9]}},
           {"medium": {"type": "particles", "generate": {"kind": "cloud", "count": 10, "seed": 3, "radius": 2}}})");
    ASSERT_TRUE(loaded.ok()) << loaded.message();
    const Scene& scene = loaded->scene;
    const Medium& medium = scene.media.at(0);
    EXPECT_EQ(medium.kind, MediumKind::Grid);
    ASSERT_TRUE(medium.particles && medium.density);
    EXPECT_EQ(medium.particles->particles.size(), 10u);
    EXPECT_GT(medium.density->maximum, 0);
    EXPECT_EQ(medium.temperature, nullptr);
    EXPECT_EQ(scene.nodes.at(0).particles, (ParticleGenerator{"cloud", 10, 3, 2}));
    EXPECT_TRUE(loaded->notes.empty());
    EXPECT_EQ(scene.media.at(1).density, medium.density) << "the same particles are made once";
    EXPECT_FALSE(scene.worldBounds().empty());
}

TEST(SceneFile, ParticlesOfAFileMayGlowAndMove) {
    const fs::path folder = test::scratchDir("scene-particles");
    ASSERT_TRUE(writeFileAtomically(folder / "hot.csv", "x,y,z,radius,density,temperature\n"
                                                        "0,0,0,0.5,2,1500\n1,0,0,0.5,1,900\n")
                    .ok());
    ASSERT_TRUE(
        writeFileAtomically(folder / "cold.csv", "x,y,z,radius,density\n0,0,0,0.5,2\n").ok());
    ASSERT_TRUE(
        writeFileAtomically(folder / "bad.csv", "x,y,z,radius,density\n0,0,nan,0.5,2\n").ok());
    const auto load = [&](const std::string& file, const std::string& emission) {
        const fs::path scene = folder / "s.scene.json";
        EXPECT_TRUE(
            writeFileAtomically(
                scene, R"({"tyndall": 1, "nodes": [{"medium": {"type": "particles", "file": ")" +
                           file + R"(", "emission": )" + emission + "}}]}")
                .ok());
        return loadScene(scene);
    };
    const std::string glow = R"({"temperatureGrid": "temperature", "scale": 0.5})";
    auto loaded = load("hot.csv", glow);
    ASSERT_TRUE(loaded.ok()) << loaded.message();
    Scene& scene = loaded->scene;
    EXPECT_EQ(scene.media[0].temperatureScale, 0.5f);
    ASSERT_TRUE(scene.media[0].temperature);
    EXPECT_NEAR(scene.media[0].temperature->maximum, 1500, 1e-3);
    const auto saved = sceneFileText(scene, folder);
    ASSERT_TRUE(saved.ok());
    EXPECT_NE(saved->find(R"("file": "hot.csv")"), std::string::npos);
    EXPECT_NE(saved->find(glow), std::string::npos) << *saved;

    const auto before = scene.media[0].density;
    const Version version = scene.versions.media;
    ParticleSet moved = *scene.media[0].particles;
    for (Particle& p : moved.particles) p.position.y += 3;
    ASSERT_TRUE(setParticles(scene, 0, std::make_shared<const ParticleSet>(moved)).ok());
    EXPECT_GT(scene.versions.media, version);
    EXPECT_NE(scene.media[0].density, before);
    EXPECT_NEAR(scene.worldBounds().centre().y, 3, 0.5) << "half a metre of voxels around them";

    EXPECT_TRUE(load("cold.csv", "[1, 0, 0]").ok());
    EXPECT_NE(
        load("cold.csv", glow)
            .message()
            .find(
                "/emission/temperatureGrid is 'temperature', but its particles have no column 'temperature'"),
        std::string::npos);
    EXPECT_NE(
        load("hot.csv", R"({"temperatureGrid": "heat"})")
            .message()
            .find("is 'heat', but the temperature of particles is their column 'temperature'"),
        std::string::npos);
    EXPECT_NE(load("bad.csv", "[1, 0, 0]").message().find("bad.csv', line 2: z is 'nan'"),
              std::string::npos);
    EXPECT_NE(load("none.csv", "[1, 0, 0]").message().find("/nodes/0/medium: "), std::string::npos);
}

TEST(SceneFile, SuppliedCameraSeesTheWholeScene) {
    const auto loaded = loadNode(
        R"({"primitive": {"shape": "box", "size": [1, 2, 30]}, "translation": [100, 0, 0]})");
    ASSERT_TRUE(loaded.ok()) << loaded.message();
    EXPECT_EQ(loaded->supplied, (std::vector<std::string>{"a camera that frames the scene"}));
    const Scene& scene = loaded->scene;
    const Node& node = scene.nodes[size_t(scene.activeCamera)];
    const Camera& camera = scene.cameras[size_t(node.camera)];
    const dmat4 cameraFromWorld = glm::inverse(scene.worldTransforms()[size_t(scene.activeCamera)]);
    const double slope = std::tan(camera.yfov / 2);
    double highest = 0;
    for (int i = 0; i < 8; ++i) {
        const dvec3 p(cameraFromWorld *
                      dvec4(100 + (i & 1 ? 0.5 : -0.5), i & 2 ? 1 : -1, i & 4 ? 15 : -15, 1));
        EXPECT_LT(p.z, -camera.znear) << "in front of the near plane";
        highest = std::max({highest, std::abs(p.y) / -p.z / slope, std::abs(p.x) / -p.z / slope});
    }
    EXPECT_LT(highest, 1) << "inside the frustum";
    EXPECT_GT(highest, 0.3) << "and large in it";
}

} // namespace
} // namespace tyndall
