#include "vpl_truth.h"

#include <gtest/gtest.h>

#include "core/image_metrics.h"
#include "reference/render.h"
#include "support/render.h"

namespace tyndall::test {
namespace {

constexpr int kWidth = 32, kHeight = 18, kFrames = 24;

/// The path tracer's picture of these terms, and the relmse that a perfect picture has against it.
struct Truth {
    Image picture;
    double noise = 0;
};

Truth truthOf(const Scene& scene, TermSet terms, uint32_t samples) {
    reference::RenderSettings settings;
    settings.width = kWidth;
    settings.height = kHeight;
    settings.path.terms = terms;
    auto render = reference::ReferenceRender::start(scene, scene.activeCamera, settings);
    if (!render.ok()) throw std::runtime_error(render.message());
    render->addSamples(samples);
    Truth truth{render->film().beauty(), 0};
    truth.noise = referenceFloor(truth.picture, render->film().variance()).value();
    return truth;
}

} // namespace

const std::string kDarkRoom = R"(
    {"name": "floor", "primitive": {"shape": "box", "size": [3, 0.1, 3]}, "material": {"baseColor": [0.7, 0.7, 0.7], "specular": 0}, "translation": [0, -1.05, 0]},
    {"name": "ceiling", "primitive": {"shape": "box", "size": [3, 0.1, 3]}, "material": {"baseColor": [0.7, 0.7, 0.7], "specular": 0}, "translation": [0, 1.05, 0]},
    {"name": "left", "primitive": {"shape": "box", "size": [0.1, 2, 3]}, "material": {"baseColor": [0.7, 0.2, 0.1], "specular": 0}, "translation": [-1.55, 0, 0]},
    {"name": "right", "primitive": {"shape": "box", "size": [0.1, 2, 3]}, "material": {"baseColor": [0.1, 0.5, 0.2], "specular": 0}, "translation": [1.55, 0, 0]},
    {"name": "back", "primitive": {"shape": "box", "size": [3, 2, 0.1]}, "material": {"baseColor": [0.6, 0.6, 0.6], "specular": 0}, "translation": [0, 0, -1.55]},)";

Scene sceneOf(const Case& about) {
    return sceneFromJson(
        R"({"tyndall": 1, "camera": "eye", "nodes": [)" + about.nodes +
        R"({"name": "eye", "camera": {"type": "perspective", "yfov": 0.8}, "translation": [0, 0.3, 4.5]}]})");
}

Against againstTruth(const Scene& scene, const Case& about) {
    const Truth truth = truthOf(scene, about.terms, 2048);
    RenderOptions options;
    options.width = kWidth;
    options.height = kHeight;
    options.gi = "vpl";
    options.terms = about.terms;
    options.frames = kFrames;
    options.settings = about.settings;
    for (const char* every : {"gi.vpl.march=full", "gi.vpl.surfaces.resolution=full"})
        options.settings.emplace_back(every);
    const Image ours = sharedRenderer().render(scene, options).beauty;
    const ImageMetrics found = compareImages(ours, truth.picture).value();
    printf("%s: relmse %.4f, of it the reference's noise %.4f; energy %.4f\n", about.name,
           found.relmse, truth.noise, found.energy);
    return {found.relmse, found.energy, truth.noise};
}

/// Bounds: four times the spread among seeds of the picture's mean, which follows from how many of the walks meet anything, and 1 to 2 % that
/// the bound of the first frames takes away and one step does not make up for; twice the relmse that noise of so many walks and points has.
void expectTheTruth(const Scene& scene, const Case& about) {
    const Against found = againstTruth(scene, about);
    EXPECT_LT(found.relmse, found.noise + about.relmse) << about.name;
    EXPECT_NEAR(found.energy, 1, about.energy) << about.name;
}

} // namespace tyndall::test
