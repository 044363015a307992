// Light propagation volumes against the reference's layers of the terms that they claim, receiver by receiver.

#include <gtest/gtest.h>

#include "core/image_metrics.h"
#include "reference/picture_cache.h"
#include "support/content.h"
#include "support/render.h"

namespace tyndall::test {
namespace {
namespace fs = std::filesystem;

constexpr int kWidth = 96, kHeight = 54;

Image sumOf(const ExrFile& file, TermSet terms) {
    Image sum(kWidth, kHeight, 3);
    for (const ImageLayer& layer : file.layers) {
        const Result<TermSet> term = parseTerms(layer.name);
        if (layer.name.empty() || !term.ok() || (*term & terms) == 0) continue;
        for (size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += layer.image.pixels[i];
    }
    return sum;
}

TEST(LpvAgainstReference, IsNearInFogInABox) {
    const fs::path file = sourceDir() / "content/cornell_fog.scene.json";
    Result<LoadedScene> loaded = loadScene(file);
    ASSERT_TRUE(loaded.ok()) << loaded.message();
    const Scene& scene = loaded->scene;
    reference::RenderSettings settings;
    settings.width = kWidth;
    settings.height = kHeight;
    const fs::path picture = sourceDir() / "tests/images/references" /
                             reference::pictureName(scene, file, scene.activeCamera, settings);
    ASSERT_TRUE(fs::exists(picture)) << picture << " is missing: `make references`";
    const ExrFile reference = readExr(picture).value();

    RenderOptions options;
    options.width = kWidth;
    options.height = kHeight;
    options.gi = "lpv";
    options.settings = {"gi.lpv.resolution=16", "gi.lpv.rsmSize=64"};
    struct Receiver {
        const char* name;
        TermSet terms;
        double
            relmse; // what is aimed at, and the noise of the reference's layers: 1,024 samples a pixel
    };
    for (const Receiver& receiver : {Receiver{"surfaces", kIndirectOnSurfaces, 0.1 + 0.02},
                                     Receiver{"media", kIndirectInMedia, 0.05 + 0.02}}) {
        options.terms = receiver.terms;
        const Image ours = sharedRenderer().render(scene, options).beauty;
        const ImageMetrics metrics = compareImages(ours, sumOf(reference, receiver.terms)).value();
        printf("%s: relmse %.4f, energy %.4f\n", receiver.name, metrics.relmse, metrics.energy);
        EXPECT_LE(metrics.relmse, receiver.relmse);
        EXPECT_NEAR(metrics.energy, 1, 0.1);
    }
}

} // namespace
} // namespace tyndall::test
