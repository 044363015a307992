// Virtual point lights against the reference's layers of the terms that they claim, receiver by receiver.

#include <gtest/gtest.h>

#include "core/image_metrics.h"
#include "reference_terms.h"
#include "support/render.h"

namespace tyndall::test {
namespace {

TEST(VplAgainstReference, ConvergesToItInFogInABox) {
    const ReferenceTerms reference("content/cornell_fog.scene.json");
    RenderOptions options;
    options.width = ReferenceTerms::kWidth;
    options.height = ReferenceTerms::kHeight;
    options.gi = "vpl";
    options.frames = 24; // averaged
    options.settings = {"gi.vpl.walks=256", "gi.vpl.mapSide=48", "gi.vpl.samples=16",
                        "gi.vpl.surfaces.resolution=half", "gi.vpl.march=half"};
    options.terms = kIndirectOnSurfaces | kIndirectInMedia;
    const Rendered ours = sharedRenderer().render(reference.scene(), options);
    for (const TermSet terms : {kIndirectOnSurfaces, kIndirectInMedia}) {
        Image picture(options.width, options.height, 3);
        for (const auto& [name, image] : ours.terms)
            if ((name.find("LSSE") != std::string::npos) == (terms == kIndirectOnSurfaces))
                for (size_t i = 0; i < picture.pixels.size(); ++i)
                    picture.pixels[i] += image.pixels[i];
        const ImageMetrics metrics = compareImages(picture, reference.sum(terms)).value();
        printf("%s: relmse %.4f, energy %.4f\n", terms == kIndirectInMedia ? "media" : "surfaces",
               metrics.relmse, metrics.energy);
        // 6,144 walks, and 1,024 samples a pixel of the reference: noise of some 0.01 each.
        EXPECT_LE(metrics.relmse, 0.04);
        // Of that noise the mean of the picture has little; of 24 frames' bounds, which no more than one step makes up for, it lacks some percent.
        EXPECT_NEAR(metrics.energy, 1, 0.04);
    }
}

} // namespace
} // namespace tyndall::test
