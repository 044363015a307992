// Light propagation volumes against the reference's layers of the terms that they claim, receiver by receiver.

#include <gtest/gtest.h>

#include "core/image_metrics.h"
#include "reference_terms.h"
#include "support/render.h"

namespace tyndall::test {
namespace {

TEST(LpvAgainstReference, IsNearInFogInABox) {
    const ReferenceTerms reference("content/cornell_fog.scene.json");
    RenderOptions options;
    options.width = ReferenceTerms::kWidth;
    options.height = ReferenceTerms::kHeight;
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
        const Image ours = sharedRenderer().render(reference.scene(), options).beauty;
        const ImageMetrics metrics = compareImages(ours, reference.sum(receiver.terms)).value();
        printf("%s: relmse %.4f, energy %.4f\n", receiver.name, metrics.relmse, metrics.energy);
        EXPECT_LE(metrics.relmse, receiver.relmse);
        EXPECT_NEAR(metrics.energy, 1, 0.1);
    }
}

} // namespace
} // namespace tyndall::test
