// The renderer's own passes, LE + LSE + LVE, averaged over many frames, against the reference's pictures of the same terms.
// tests/images/references.txt lists the pictures, `make references` makes them. TYNDALL_LONG_TESTS=1 takes all ten scenes, which on a
// software driver takes most of an hour; else those that a few frames settle.

#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>

#include "core/image_metrics.h"
#include "reference/picture_cache.h"
#include "support/content.h"
#include "support/render.h"

namespace tyndall::test {
namespace {
namespace fs = std::filesystem;

struct Case {
    const char* scene; // from the repository's root
    int frames;        // so many that the average's own noise is a small part of the bound
    bool quick;        // on a software driver
    // Where it is not 0: surfaces apart, from so many frames kDetail times as wide and high. Glints on normal maps under lamps without extent
    // need over a thousand samples a pixel, and cost little beside the march through the media, which does not need them.
    int surfaceFrames = 0;
};

constexpr int kDetail = 8;
constexpr int kWidth = 96, kHeight = 54;

const Case kCases[] = {
    {"content/slab.scene.json", 32, true},
    {"content/cornell.scene.json", 256, true},
    {"content/cornell_fog.scene.json", 256, true},
    {"content/furnace.scene.json", 128, false},
    {"content/campfire.scene.json", 128, false},
    {"content/cloud.scene.json", 128, false},
    {"content/fog_hall.scene.json", 512, false},
    {"content/demo.scene.json", 512, false},
    {"tests/bench/peers/scenes/smoke.scene.json", 128, false},
    {"tests/scenes/sponza_fog_smoke.scene.json", 64, false, 32},
};

std::string nameOf(const ::testing::TestParamInfo<Case>& info) {
    const std::string file = fs::path(info.param.scene).filename().string();
    return file.substr(0, file.find('.'));
}

/// The scene's file, or a copy in which @CONTENT@ is the shared content's folder. Empty where that is missing.
fs::path sceneFile(const std::string& name) {
    const fs::path file = sourceDir() / name;
    std::string text = readFile(file).value();
    const std::string place = "@CONTENT@";
    if (text.find(place) == std::string::npos) return file;
    const auto content = sharedContent("sponza/Sponza.gltf");
    if (!content) return {};
    const std::string folder = fs::absolute(*content).parent_path().parent_path().string();
    for (size_t at = text.find(place); at != std::string::npos; at = text.find(place))
        text.replace(at, place.size(), folder);
    const fs::path copy = scratchDir("direct") / file.filename();
    EXPECT_TRUE(writeFileAtomically(copy, text).ok());
    return copy;
}

/// Adds the means over squares of `detail` by `detail` pixels to `sum`.
void addShrunk(const Image& picture, int detail, Image& sum) {
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x)
            for (int c = 0; c < 3; ++c)
                sum.pixels[size_t((y / detail * sum.width + x / detail) * 3 + c)] +=
                    picture.pixels[size_t((y * picture.width + x) * 3 + c)] /
                    float(detail * detail);
}

/// LE + LSE + LVE.
Image directLight(const Scene& scene, const Case& test) {
    RenderOptions options;
    options.converge = true;
    // Fine enough for 96 pixels; on a software driver maps cost more than all the rest.
    options.settings = {"shadows.resolution=512", "shadows.localResolution=256",
                        "shadows.environmentResolution=256"};
    Image sum(kWidth, kHeight, 3);
    const auto add = [&](TermSet terms, int frames, int detail) {
        options.width = kWidth * detail;
        options.height = kHeight * detail;
        options.frames = frames;
        options.terms = terms;
        const Rendered rendered = sharedRenderer().render(scene, options);
        for (const auto& [name, picture] : rendered.terms) addShrunk(picture, detail, sum);
    };
    if (test.surfaceFrames == 0) {
        add(kDirectTerms, test.frames, 1);
    } else {
        add(bit(Term::LVE), test.frames, 1);
        add(bit(Term::LE) | bit(Term::LSE), test.surfaceFrames, kDetail);
    }
    return sum;
}

class DirectLight : public ::testing::TestWithParam<Case> {};

TEST_P(DirectLight, IsTheReferences) {
    const Case& test = GetParam();
    if (!test.quick && !std::getenv("TYNDALL_LONG_TESTS"))
        GTEST_SKIP() << "minutes on a software driver: TYNDALL_LONG_TESTS=1 runs it";
    const fs::path file = sceneFile(test.scene);
    if (file.empty()) GTEST_SKIP() << "the shared content is not here";
    Result<LoadedScene> loaded = loadScene(file);
    ASSERT_TRUE(loaded.ok()) << loaded.message();
    const Scene& scene = loaded->scene;

    reference::RenderSettings settings;
    settings.width = kWidth;
    settings.height = kHeight;
    settings.path.terms = kDirectTerms;
    const fs::path picture = sourceDir() / "tests/images/references" /
                             reference::pictureName(scene, file, scene.activeCamera, settings);
    ASSERT_TRUE(fs::exists(picture))
        << picture << " is missing: has the scene changed? `make references`";
    const ExrFile reference = readExr(picture).value();

    const Image sum = directLight(scene, test);
    const Image& expected = reference.layers.front().image;
    ASSERT_EQ(reference.layers.front().name, "");
    const ImageMetrics metrics = compareImages(sum, expected).value();
    double floor = 0;
    for (const ImageLayer& layer : reference.layers)
        if (layer.name == "variance") floor = referenceFloor(expected, layer.image).value();
    std::printf("%s: relmse %.3g, of which the reference's noise %.3g, energy %.5f\n", test.scene,
                metrics.relmse, floor, metrics.energy);
    // What the project promises of its direct light; nothing of it is noise or rounding.
    EXPECT_LE(metrics.relmse - floor, 1e-3);
    EXPECT_NEAR(metrics.energy, 1, 0.005); // promised: half a percent
}

INSTANTIATE_TEST_SUITE_P(Scenes, DirectLight, ::testing::ValuesIn(kCases), nameOf);

} // namespace
} // namespace tyndall::test
