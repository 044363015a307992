// Shadow maps are drawn when something has changed, for the lights that matter most, and what is skipped says why.

#include "passes/shadows_scene.h"

#include <random>

#include "support/content.h"

namespace tyndall::test {
namespace {

using ShadowMapCache = LightsTest;
TYNDALL_GL_TESTS(ShadowMapCache);

TEST_P(ShadowMapCache, MapsAreDrawnAgainOnlyWhereSomethingChanged) {
    BoxOverFloor world;
    const int first = world.maker.pointLight(10, {3, 5, 0}),
              second = world.maker.pointLight(10, {-3, 5, 0});
    const auto drawn = [&] {
        const uint64_t before = lights().shadowMapsDrawn();
        look(world.maker, world.probes, world.options());
        return lights().shadowMapsDrawn() - before;
    };
    EXPECT_EQ(drawn(), 12u);
    EXPECT_EQ(drawn(), 0u);
    EXPECT_EQ(statusOf("shadow.maps"), "cached");
    EXPECT_EQ(statusOf("lights.upload"), "cached");
    world.maker.moveNode(second, {0.1, 0, 0});
    EXPECT_EQ(drawn(), 6u) << "its own alone";
    world.maker.moveNode(1, {0.1, 0, 0}); // the box
    EXPECT_EQ(drawn(), 12u);
    EXPECT_EQ(drawn(), 0u);
    // A light that changes without any transform: its colour is no part of its maps.
    world.maker.scene.lights[0].intensity = 20;
    world.maker.scene.versions.lights = nextVersion();
    EXPECT_EQ(drawn(), 0u);
    EXPECT_EQ(statusOf("lights.upload"), "ran");
    // Moving the camera leaves point lights alone.
    ProbeOptions options = world.options();
    options.eye.x += 1;
    const uint64_t before = lights().shadowMapsDrawn();
    look(world.maker, world.probes, options);
    EXPECT_EQ(lights().shadowMapsDrawn(), before);
    // Averaged frames shift their texel grids: all anew.
    options.converge = true;
    look(world.maker, world.probes, options);
    EXPECT_EQ(lights().shadowMapsDrawn(), before + 12);
    world.maker.scene.lights[size_t(world.maker.scene.nodes[size_t(first)].light)].castsShadows =
        false;
    world.maker.scene.versions.lights = nextVersion();
    EXPECT_GE(drawn(), 6u);
    EXPECT_EQ(lights().shadowPlan().views.size(), 6u);
}

TEST_P(ShadowMapCache, CachedMapsEqualFreshOnes) {
    BoxOverFloor world;
    const int lamp = world.maker.pointLight(10, {3, 5, 0});
    world.maker.directionalLight(1, {0.2, -1, 0.1});
    std::mt19937 random{uint32_t(seed())};
    std::uniform_real_distribution<double> unit(-1, 1);
    ProbeOptions options = world.options();
    for (int step = 0; step < 6; ++step) {
        if (step % 2)
            world.maker.moveNode(lamp, dvec3(unit(random), 0, unit(random)));
        else
            options.eye += dvec3(unit(random), 0, unit(random)) * 2.0;
        if (step == 4) lights().shadowSettings().localResolution = 256;
        const std::vector<Seen> kept = look(world.maker, world.probes, options);
        forgetEverything();
        const std::vector<Seen> fresh = look(world.maker, world.probes, options);
        for (size_t i = 0; i < kept.size(); ++i)
            ASSERT_EQ(kept[i].lit, fresh[i].lit) << "step " << step << ", probe " << i;
    }
}

TEST_P(ShadowMapCache, SkipsSayWhy) {
    SceneMaker empty;
    empty.pointLight(1, {0, 2, 0});
    EXPECT_EQ(look(empty, {{{1, 0, 0}, {0, 0, 0}}})[0].visibility, 1.0f);
    EXPECT_EQ(statusOf("shadow.maps"), "skipped: no surface in the scene");
    BoxOverFloor world;
    look(world.maker, world.probes, world.options());
    EXPECT_EQ(statusOf("shadow.maps"), "skipped: no light casts a shadow");
    world.maker.pointLight(10, {3, 5, 0});
    world.maker.scene.lights[0].castsShadows = false;
    const std::vector<Seen> seen = look(world.maker, world.probes, world.options());
    for (const Seen& s : seen) EXPECT_EQ(s.visibility, 1.0f);
    EXPECT_EQ(statusOf("shadow.maps"), "skipped: no light casts a shadow");
}

TEST_P(ShadowMapCache, TheLightsThatMatterMostGetShadows) {
    BoxOverFloor world;
    world.maker.pointLight(1, {0, 4, 30});
    world.maker.pointLight(100, {0, 5, 0.1});
    world.maker.pointLight(50, {0, 5, 0});
    world.maker.pointLight(0.1f, {0, 5, 0});
    lights().shadowSettings().maxLights = 2;
    look(world.maker, world.probes, world.options());
    std::vector<int> shadowed;
    for (uint32_t i = 0; i < lights().lights().size(); ++i)
        if (lights().lights()[i].shadowIndex >= 0) shadowed.push_back(int(i));
    EXPECT_EQ(shadowed, (std::vector<int>{1, 2}));
    ASSERT_EQ(lights().notes().size(), 1u);
    EXPECT_EQ(lights().notes()[0], "2 of 4 lights cast no shadows: shadows.maxLights is 2");
}

} // namespace
} // namespace tyndall::test
