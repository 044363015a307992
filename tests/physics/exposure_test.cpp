// A new exposure or tone curve runs the tone-mapping pass alone: what is shown then is what a whole frame would show.

#include <gtest/gtest.h>

#include "gi_scenes.h"
#include "scene/scene_edit.h"
#include "support/render.h"

namespace tyndall::test {
namespace {

constexpr const char* kFog =
    R"({"name": "fog", "medium": {"type": "homogeneous", "shape": "box", "size": [6, 4, 6], "scattering": [0.2, 0.2, 0.3], "absorption": [0, 0, 0]}},)";

RenderOptions options(int frames, std::vector<std::string> settings = {}) {
    RenderOptions result;
    result.width = 48;
    result.height = 36;
    result.frames = frames;
    result.settings = std::move(settings);
    result.separateTerms = false;
    return result;
}

Renderer& renderer() { return sharedRenderer().renderer(); }

void assign(const std::string& setting) {
    const Result<void> done = renderer().settings().assign(setting);
    ASSERT_TRUE(done.ok()) << done.message();
}

/// Was it done? A test fails where it could not be.
bool toneMapAgain() {
    const Result<bool> done = renderer().toneMapAgain();
    EXPECT_TRUE(done.ok()) << done.message();
    return done.ok() && *done;
}

class Exposure : public ::testing::TestWithParam<int> {}; // frames averaged
INSTANTIATE_TEST_SUITE_P(Frames, Exposure, ::testing::Values(1, 3));

TEST_P(Exposure, ToneMappingAgainShowsWhatAWholeFrameShowsToTheLastBit) {
    Scene scene = sceneFromJson(corner(100, kFog));
    const std::vector<std::string> after = {"post.toneCurve=aces", "post.dither=true",
                                            "post.exposureCompensation=0.75"};
    const float before = scene.ev100;
    scene.ev100 = before - 1.5f;
    const Rendered whole = sharedRenderer().render(scene, options(GetParam(), after));
    scene.ev100 = before;
    const Rendered old = sharedRenderer().render(scene, options(GetParam()));
    ASSERT_NE(old.display, whole.display) << "the two exposures differ in the picture";

    scene.ev100 = before - 1.5f;
    for (const std::string& setting : after) assign(setting);
    ASSERT_TRUE(toneMapAgain());
    EXPECT_EQ(renderer().readDisplay(), whole.display);
    EXPECT_EQ(renderer().readBeauty().pixels, old.beauty.pixels) << "the linear picture stays";
}

TEST_P(Exposure, NothingElseIsRenderedAgain) {
    Scene scene = sceneFromJson(corner(100, kFog));
    const Rendered old = sharedRenderer().render(scene, options(GetParam()));
    // Whatever pass ran would see these.
    for (size_t i = 0; i < scene.lights.size(); ++i) {
        Light light = scene.lights[i];
        light.intensity *= 8;
        setLight(scene, int(i), light);
    }
    ASSERT_TRUE(toneMapAgain());
    EXPECT_EQ(renderer().readBeauty().pixels, old.beauty.pixels);
    EXPECT_EQ(renderer().readDisplay(), old.display);
}

TEST(ExposureOfDebugViews, ADebugViewMayDependOnTheExposureAndAsksForAWholeFrame) {
    const Scene scene = sceneFromJson(corner(100, kFog));
    RenderOptions lattice = options(1, {"gi.lpv.show=light"});
    lattice.gi = "lpv";
    (void)sharedRenderer().render(scene, lattice);
    EXPECT_FALSE(toneMapAgain());
    lattice.settings.clear();
    (void)sharedRenderer().render(scene, lattice);
    EXPECT_TRUE(toneMapAgain()) << "the light of a technique is in nits";
}

} // namespace
} // namespace tyndall::test
