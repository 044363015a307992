// Volumes, pictures and skies from files.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/image.h"
#include "scene/scene_file.h"
#include "scene/scene_writer.h"
#include "support/content.h"

namespace tyndall {
namespace {

/// What the longest side of the grid's box would be worth in optical depth if it lay in the mean density of where there is any.
double typicalOpticalDepth(const Medium& medium) {
    const BrickGrid& grid = *medium.density;
    const Bounds box = grid.indexBounds();
    const dvec3 extent = box.transformed(grid.worldFromIndex).extent();
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(0, 1);
    double sum = 0, count = 0;
    for (int i = 0; i < 200000; ++i) {
        const dvec3 at(uniform(random), uniform(random), uniform(random));
        const double density = grid.sample(box.minimum + at * box.extent());
        if (density > 0) {
            sum += density;
            ++count;
        }
    }
    return sum / count * std::max({extent.x, extent.y, extent.z}) * double(medium.extinction().x);
}

TEST(BareVolume, IsSuppliedWithMediumCameraAndLight) {
    for (const char* file :
         {"vdb/sphere_fog_tiny.vdb", "vdb/smoke1.vdb", "vdb/dragon_fog_xform.vdb",
          "nvdb/wdas_cloud_sixteenth_fpN_zip.nvdb"}) {
        const auto path = REQUIRE_CONTENT(file);
        SCOPED_TRACE(file);
        const auto loaded = loadScene(path);
        ASSERT_TRUE(loaded.ok()) << loaded.message();
        const Scene& scene = loaded->scene;
        EXPECT_EQ(loaded->supplied.size(), 4u) << "medium, camera, light, exposure";
        ASSERT_EQ(scene.media.size(), 1u);
        const Medium& medium = scene.media[0];
        EXPECT_EQ(medium.kind, MediumKind::Grid);
        EXPECT_NEAR(medium.scattering.x / medium.extinction().x, 0.99f, 1e-4f);
        EXPECT_NEAR(typicalOpticalDepth(medium), 4, 1.5)
            << "about 4: the mean is taken over samples, here over volume";
        EXPECT_EQ(scene.nodes[size_t(0)].localTransform(), dmat4(1.0))
            << "the grid's own transform is kept";
        EXPECT_NE(scene.activeCamera, kNone);
        EXPECT_FALSE(scene.worldBounds().empty());
    }
}

TEST(BareVolume, LevelSetAndPointsAreRefusedByName) {
    for (const char* file : {"vdb/sphere_levelset.vdb", "vdb/points_pointdata.vdb"}) {
        const auto path = REQUIRE_CONTENT(file);
        const auto loaded = loadScene(path);
        ASSERT_FALSE(loaded.ok()) << file;
        EXPECT_NE(loaded.message().find(path.filename().string()), std::string::npos)
            << loaded.message();
    }
}

TEST(SceneVolumes, SequenceLoadsItsFirstFrameAndKeepsTheRest) {
    const std::filesystem::path folder = test::scratchDir("scene-sequence");
    const std::string puff = readFile(test::sourceDir() / "content/smoke_puff.vdb").value();
    ASSERT_TRUE(writeFileAtomically(folder / "smoke_0007.vdb", puff).ok());
    const std::string text = R"({
  "tyndall": 1,
  "name": "sequence",
  "nodes": [
    {
      "name": "smoke",
      "medium": {"type": "grid", "file": "smoke_%04d.vdb", "grid": "density", "frames": [7, 9], "fps": 12, "loop": true}
    },
    {"name": "eye", "camera": {"type": "perspective"}}
  ],
  "camera": "eye"
}
)";
    ASSERT_TRUE(writeFileAtomically(folder / "s.scene.json", text).ok());
    const auto loaded = loadScene(folder / "s.scene.json");
    ASSERT_TRUE(loaded.ok()) << loaded.message();
    const Scene& scene = loaded->scene;
    EXPECT_EQ(scene.nodes[0].sequence, (GridSequence{7, 9, 12, true}));
    ASSERT_TRUE(scene.media.at(0).density != nullptr);
    // The puff is 2.4 m across; a brick has room for a cell more on each side.
    EXPECT_NEAR(scene.worldBounds().extent().x, 2.4, 0.6);
    EXPECT_EQ(sceneFileText(scene, folder).value(), text);
}

TEST(SceneVolumes, FireHasDensityAndTemperature) {
    const auto loaded = loadScene(test::sourceDir() / "content/campfire.scene.json");
    ASSERT_TRUE(loaded.ok()) << loaded.message();
    const auto fire = std::find_if(loaded->scene.media.begin(), loaded->scene.media.end(),
                                   [](const Medium& m) { return m.kind == MediumKind::Grid; });
    ASSERT_NE(fire, loaded->scene.media.end());
    ASSERT_TRUE(fire->temperature != nullptr);
    EXPECT_NEAR(fire->temperature->maximum, 1800, 20) << "the core: 300 K and 1500 K more";
    EXPECT_GT(fire->temperatureScale, 0);
}

TEST(ScenePictures, EnvironmentFileIsReadAndSaved) {
    const auto sky = REQUIRE_CONTENT("hdr/studio_small_08_1k.hdr");
    const std::filesystem::path folder = test::scratchDir("scene-sky");
    ASSERT_TRUE(writeFileAtomically(folder / "sky.hdr", readFile(sky).value()).ok());
    ASSERT_TRUE(
        writeFileAtomically(
            folder / "s.scene.json",
            R"({"tyndall": 1, "environment": {"file": "sky.hdr", "intensity": 3, "rotation": 1.5}})")
            .ok());
    const auto loaded = loadScene(folder / "s.scene.json");
    ASSERT_TRUE(loaded.ok()) << loaded.message();
    const Environment& environment = loaded->scene.environment;
    ASSERT_TRUE(environment.image != nullptr);
    EXPECT_EQ(environment.image->width, 1024);
    EXPECT_EQ(environment.image->height, 512);
    EXPECT_EQ(environment.intensity, 3);
    EXPECT_EQ(environment.rotation, 1.5f);
    EXPECT_NE(sceneFileText(loaded->scene, folder)
                  .value()
                  .find(R"("environment": {"file": "sky.hdr", "intensity": 3, "rotation": 1.5})"),
              std::string::npos);
}

TEST(ScenePictures, TexturesAreReadByFileNameOnceEach) {
    const auto logo = REQUIRE_CONTENT("gltf/khronos/BoxTexturedNonPowerOfTwo/CesiumLogoFlat.png");
    const std::filesystem::path folder = test::scratchDir("scene-textures");
    ASSERT_TRUE(writeFileAtomically(folder / "logo.png", readFile(logo).value()).ok());
    ASSERT_TRUE(writeFileAtomically(folder / "s.scene.json",
                                    R"({"tyndall": 1, "nodes": [{"primitive": {"shape": "box"},
        "material": {"baseColorTexture": "logo.png", "normalTexture": "logo.png"}}]})")
                    .ok());
    const auto loaded = loadScene(folder / "s.scene.json");
    ASSERT_TRUE(loaded.ok()) << loaded.message();
    const Scene& scene = loaded->scene;
    ASSERT_EQ(scene.images.size(), 1u);
    EXPECT_EQ(scene.images[0].rgba.size(),
              size_t(scene.images[0].width) * size_t(scene.images[0].height) * 4);
    EXPECT_EQ(scene.meshes.at(0).tangents.size(), scene.meshes[0].positions.size())
        << "a normal texture needs tangents";
    ASSERT_TRUE(writeFileAtomically(folder / "logo.png", "no picture").ok());
    EXPECT_NE(
        loadScene(folder / "s.scene.json")
            .message()
            .find(
                "/nodes/0/material/baseColorTexture is 'logo.png', but the picture is neither PNG, JPEG nor WebP"),
        std::string::npos);
}

TEST(ScenePictures, BombsAreRefusedByTheirHeader) {
    // A PNG header that claims 16000 x 4000 pixels, and nothing behind it.
    const std::filesystem::path folder = test::scratchDir("scene-bomb");
    std::string png("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x3e\x80\0\0\x0f\xa0\x08\x06\0\0\0\0\0\0\0",
                    33);
    png += std::string(400, 'x');
    ASSERT_TRUE(writeFileAtomically(folder / "bomb.png", png).ok());
    ASSERT_TRUE(
        writeFileAtomically(
            folder / "s.scene.json",
            R"({"tyndall": 1, "nodes": [{"primitive": {"shape": "box"}, "material": {"baseColorTexture": "bomb.png"}}]})")
            .ok());
    const auto loaded = loadScene(folder / "s.scene.json");
    ASSERT_FALSE(loaded.ok());
    EXPECT_NE(loaded.message().find("claims 16000x4000 pixels in 433 bytes"), std::string::npos)
        << loaded.message();
}

} // namespace
} // namespace tyndall
