// Several techniques in one frame: each term once, each as its technique computes it alone.

#include <gtest/gtest.h>

#include "core/image_metrics.h"
#include "gi_scenes.h"
#include "support/render.h"

namespace tyndall::test {
namespace {

const std::string kFog =
    R"({"name": "fog", "medium": {"type": "homogeneous", "shape": "box", "size": [4, 3, 4], "scattering": [0.3, 0.3, 0.3],
    "absorption": [0, 0.1, 0.2], "anisotropy": 0.5}, "translation": [0, 1.5, 0]},)";

Rendered rendered(const std::string& gi, TermSet terms = kAllTerms) {
    RenderOptions options;
    options.width = 24;
    options.height = 16;
    options.gi = gi;
    options.terms = terms;
    // Every pixel gathers on its own: where one takes its neighbours' light depends on how that looks.
    options.settings = {"gi.vpl.walks=16",
                        "gi.vpl.mapSide=16",
                        "gi.vpl.samples=4",
                        "gi.vpl.march=full",
                        "gi.vpl.surfaces.resolution=full",
                        "gi.lpv.resolution=8",
                        "gi.lpv.rsmSize=32",
                        "gi.lpv.march=full",
                        "gi.lpv.cascades=1",
                        "gi.vpl.candidates=1"};
    return sharedRenderer().render(sceneFromJson(corner(50, kFog)), options);
}

TEST(Composition, ThreeTechniquesShareSixTermsAndEachImageIsThatOfItsTechniqueAlone) {
    const std::string ofWalks = "LSSE=vpl,LVSE=vpl,LXSSE=vpl", ofLattice = "LSVE=lpv",
                      ofOctaves = "LVVE=octaves,LXVVE=octaves";
    const Rendered all = rendered(ofWalks + "," + ofLattice + "," + ofOctaves);
    EXPECT_EQ(all.frame.plan.rendered, kDirectTerms | terms(Term::LSSE, Term::LVSE, Term::LXSSE,
                                                            Term::LSVE, Term::LVVE, Term::LXVVE));
    EXPECT_EQ(all.frame.plan.missing, terms(Term::LXVSE, Term::LXSVE));
    ASSERT_EQ(all.terms.size(), 6u) << "three direct terms and an image from each technique";
    for (const std::string& one : {ofWalks, ofLattice, ofOctaves})
        for (const auto& [name, image] : rendered(one).terms) {
            ASSERT_TRUE(all.terms.count(name)) << name;
            EXPECT_TRUE(meanOf(image) > 0 || name == "LE") << name; // nothing glows
            EXPECT_EQ(all.terms.at(name).pixels, image.pixels) << name;
        }
}

TEST(Composition, LightInTwoKindsOfMediaAddsUp) {
    // A ball of fog in height fog: what a technique computes in either, with the other only in the way, is together what it computes in both.
    const std::string both =
        R"({"name": "ball", "medium": {"type": "homogeneous", "shape": "sphere", "size": [2, 2, 2], "scattering": [0.9, 0.6, 0.3],
    "absorption": [0, 0.1, 0.2]}, "translation": [0, 1.2, 0]},
    {"name": "haze", "medium": {"type": "homogeneous", "shape": "height", "scaleHeight": 1, "scattering": [0.2, 0.2, 0.2],
    "absorption": [0, 0, 0]}},)";
    const Scene scene = sceneFromJson(corner(50, both));
    const auto light = [&](const std::string& technique, const std::string& media) {
        RenderOptions options;
        options.width = 24;
        options.height = 16;
        options.terms = technique == "octaves" ? terms(Term::LVVE, Term::LXVVE) : kIndirectInMedia;
        std::string gi;
        for (uint32_t t = 0; t < kTermCount; ++t)
            if (options.terms & bit(Term(t)))
                gi += (gi.empty() ? "" : ",") + std::string(termName(Term(t))) + media + "=" +
                      technique;
        options.gi = gi;
        options.settings = {"gi.vpl.walks=16",
                            "gi.vpl.mapSide=16",
                            "gi.vpl.samples=256",
                            "gi.vpl.march=full",
                            "gi.vpl.classes=1",
                            "gi.vpl.candidates=1",
                            "gi.vpl.compensation=clamped",
                            "gi.lpv.resolution=8",
                            "gi.lpv.rsmSize=32",
                            "gi.lpv.march=full",
                            "gi.octaves.count=2"};
        return sharedRenderer().render(scene, options).beauty;
    };
    // To rounding. Virtual lights are gathered at points that are drawn by how much scatters there: 256 on a ray leave some noise.
    for (const auto& [technique, relmse] :
         {std::pair("octaves", 1e-10), {"lpv", 1e-10}, {"vpl", 1e-3}}) {
        const Image inBoth = light(technique, ""), inBall = light(technique, ":shapes"),
                    inHaze = light(technique, ":height");
        EXPECT_GT(meanOf(inBall), 0.05 * meanOf(inBoth)) << technique;
        EXPECT_GT(meanOf(inHaze), 0.05 * meanOf(inBoth)) << technique;
        Image sum = inBall;
        for (size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += inHaze.pixels[i];
        EXPECT_LT(compareImages(sum, inBoth).value().relmse, relmse) << technique;
    }
}

TEST(Composition, TechniquesThatShareTermsShareTheirImage) {
    const std::string ofBall = "LVVE:shapes=octaves,LXVVE:shapes=octaves",
                      ofRest = "LVVE=vpl,LXVVE=vpl";
    const Rendered both = rendered(ofBall + "," + ofRest);
    ASSERT_EQ(both.terms.count("LVVE+LXVVE"), 1u);
    ASSERT_EQ(both.terms.size(), 4u) << "three direct terms, and what both techniques compute";
    Image sum(both.beauty.width, both.beauty.height, 3);
    for (const auto& [name, image] : both.terms)
        for (size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += image.pixels[i];
    EXPECT_LT(compareImages(sum, both.beauty).value().relmse, 1e-12); // single precision
}

/// Every term given to `technique` alone, and the sum of their images.
Image sumOfParts(const std::string& technique, const std::vector<Term>& parts) {
    Image sum;
    for (const Term term : parts) {
        const Image part =
            rendered(std::string(termName(term)) + "=" + technique, bit(term)).beauty;
        EXPECT_GT(meanOf(part), 0) << termName(term);
        if (sum.pixels.empty()) sum = Image(part.width, part.height, part.channels);
        for (size_t i = 0; i < part.pixels.size(); ++i) sum.pixels[i] += part.pixels[i];
    }
    return sum;
}

struct Tolerance {
    double relmse, energy;
};

void expectSumOfParts(const std::string& technique, const std::vector<Term>& parts,
                      const Tolerance& tolerance) {
    std::string list;
    TermSet set = 0;
    for (const Term term : parts) {
        list += (list.empty() ? "" : ",") + std::string(termName(term)) + "=" + technique;
        set |= bit(term);
    }
    const Image whole = rendered(list, set).beauty, sum = sumOfParts(technique, parts);
    const ImageMetrics metrics = compareImages(sum, whole).value();
    EXPECT_LT(metrics.relmse, tolerance.relmse) << list;
    EXPECT_NEAR(metrics.energy, 1, tolerance.energy) << list;
}

TEST(Composition, TermsOfVirtualLightsAddUpToTheirSum) {
    const Tolerance rounding{1e-10, 1e-5}; // single precision, summed in another order
    expectSumOfParts("vpl", {Term::LSSE, Term::LVSE, Term::LXSSE, Term::LXVSE}, rounding);
    expectSumOfParts("vpl", {Term::LSVE, Term::LVVE, Term::LXSVE, Term::LXVVE}, rounding);
}

TEST(Composition, TermsOfALatticeAddUpToTheirSum) {
    // A cell sends its light on as one lobe of two bands, which is kept from being negative: where light comes from two sides the lobe of both is
    // not the sum of two, and leaves by other sides (in this coarse lattice a twentieth of it; LpvLattice's laws keep its power).
    const Tolerance lobes{1e-2, 0.06};
    expectSumOfParts("lpv", {Term::LSVE, Term::LVVE}, lobes);
    expectSumOfParts("lpv", {Term::LSSE, Term::LVSE}, lobes);
}

} // namespace
} // namespace tyndall::test
