// Bare volumes: what is supplied must be plausible.
#include <gtest/gtest.h>

#include "scene/scene_file.h"
#include "support/content.h"

namespace tyndall {
namespace {

/// Optical depth along the longest side of the grid's box, through its middle, by a fine midpoint rule.
double opticalDepthThrough(const Medium& medium) {
    const BrickGrid& grid = *medium.density;
    const Bounds box = grid.indexBounds();
    const dvec3 worldExtent = box.transformed(grid.worldFromIndex).extent();
    dvec3 along(0);
    const int axis = worldExtent.x >= worldExtent.y && worldExtent.x >= worldExtent.z ? 0 : worldExtent.y >= worldExtent.z ? 1 : 2;
    along[axis] = 1;
    const dmat4 indexFromWorld = glm::inverse(grid.worldFromIndex);
    const dvec3 centre = dvec3(grid.worldFromIndex * dvec4(box.centre(), 1));
    double sum = 0;
    constexpr int kSteps = 2000;
    for (int i = 0; i < kSteps; ++i) {
        const dvec3 p = centre + along * worldExtent[axis] * ((i + 0.5) / kSteps - 0.5);
        sum += grid.sample(dvec3(indexFromWorld * dvec4(p, 1)));
    }
    return sum / kSteps * worldExtent[axis] * double(medium.extinction().x);
}

TEST(BareVolume, IsSuppliedWithMediumCameraAndLight) {
    for (const char* file : {"vdb/sphere_fog_tiny.vdb", "vdb/smoke1.vdb", "vdb/dragon_fog_xform.vdb", "nvdb/wdas_cloud_sixteenth_fpN_zip.nvdb"}) {
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
        const double depth = opticalDepthThrough(medium);
        EXPECT_GT(depth, 0.5);
        EXPECT_LT(depth, 16);
        EXPECT_EQ(scene.nodes[size_t(0)].localTransform(), dmat4(1.0)) << "the grid's own transform is kept";
        EXPECT_NE(scene.activeCamera, kNone);
        EXPECT_FALSE(scene.worldBounds().empty());
    }
}

TEST(BareVolume, LevelSetAndPointsAreRefusedByName) {
    for (const char* file : {"vdb/sphere_levelset.vdb", "vdb/points_pointdata.vdb"}) {
        const auto path = REQUIRE_CONTENT(file);
        const auto loaded = loadScene(path);
        ASSERT_FALSE(loaded.ok()) << file;
        EXPECT_NE(loaded.message().find(path.filename().string()), std::string::npos) << loaded.message();
    }
}

} // namespace
} // namespace tyndall
