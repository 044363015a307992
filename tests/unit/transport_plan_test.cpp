#include "transport/plan.h"

#include <gtest/gtest.h>

namespace tyndall {
namespace {

const std::vector<Technique> kTechniques = {
    {"octaves", "Octaves", "", "volumetric_gi", terms(Term::LVVE, Term::LXVVE)},
    {"lattice", "Lattice", "", "other", kIndirectOnSurfaces | kIndirectInMedia},
    {"fogonly", "Fog", "", "other", terms(Term::LVE, Term::LVVE)},
};
const SceneTraits kEverything{true, true, true, true};

TEST(TransportTerms, NamesRoundTripForEverySet) {
    for (TermSet set = 0; set <= kAllTerms; ++set)
        ASSERT_EQ(parseTerms(termNames(set)).value(), set);
    EXPECT_EQ(parseTerms("all").value(), kAllTerms);
    EXPECT_EQ(parseTerms("direct,LVVE").value(), kDirectTerms | bit(Term::LVVE));
    EXPECT_NE(parseTerms("LVEE").message().find("did you mean"), std::string::npos);
}

TEST(TransportTerms, EveryTermIsDirectOrOnSurfacesOrInMediaAndOnlyOnce) {
    EXPECT_EQ(kDirectTerms & kIndirectOnSurfaces, 0u);
    EXPECT_EQ(kDirectTerms & kIndirectInMedia, 0u);
    EXPECT_EQ(kIndirectOnSurfaces & kIndirectInMedia, 0u);
    EXPECT_EQ(__builtin_popcount(kAllTerms), int(kTermCount));
}

TEST(TransportPlan, EveryTermHasAtMostOneOwnerWhateverIsAskedFor) {
    for (const char* gi :
         {"auto", "none", "octaves", "lattice", "fogonly", "LVVE=octaves,LSVE=lattice"})
        for (TermSet wanted : {kAllTerms, kDirectTerms, bit(Term::LVVE), TermSet(0)}) {
            const Result<FramePlan> plan = makePlan(gi, wanted, kTechniques, kEverything);
            ASSERT_TRUE(plan.ok()) << gi;
            TermSet seen = 0;
            for (int owner = kDirectPasses; owner < int(kTechniques.size()); ++owner) {
                if (owner == kNobody) continue;
                EXPECT_EQ(seen & plan->termsOf(owner), 0u) << gi;
                seen |= plan->termsOf(owner);
            }
            EXPECT_EQ(seen, plan->rendered);
            EXPECT_EQ(plan->rendered & ~wanted, 0u);
            EXPECT_EQ(plan->rendered | plan->missing, wanted & (plan->possible | plan->rendered));
        }
}

TEST(TransportPlan, WhatNobodyClaimsIsMissing) {
    const FramePlan plan = makePlan("octaves", kAllTerms, kTechniques, kEverything).value();
    EXPECT_EQ(plan.missing, kAllTerms & ~(kDirectTerms | terms(Term::LVVE, Term::LXVVE)));
}

TEST(TransportPlan, TermsThatTheSceneCannotHaveAreNotMissing) {
    const SceneTraits vacuum{true, false, false, true};
    const FramePlan plan = makePlan("none", kAllTerms, kTechniques, vacuum).value();
    EXPECT_EQ(plan.missing, terms(Term::LSSE, Term::LXSSE));
    EXPECT_EQ(makePlan("none", kAllTerms, kTechniques, {}).value().missing, 0u)
        << "no light, nothing missing";
}

TEST(TransportPlan, AutoTakesTheTechniqueThatClaimsMostAndSaysSo) {
    const FramePlan plan = makePlan("auto", kAllTerms, kTechniques, kEverything).value();
    EXPECT_EQ(plan.technique, "lattice");
    EXPECT_NE(plan.why.find("lattice"), std::string::npos);
    EXPECT_EQ(makePlan("auto", kDirectTerms, kTechniques, kEverything).value().technique, "none");
}

TEST(TransportPlan, AutoLeavesAloneWhatIsOnlyForWhoAsks) {
    std::vector<Technique> techniques = kTechniques;
    techniques[1].automatic = false;
    EXPECT_EQ(makePlan("auto", kAllTerms, techniques, kEverything).value().technique, "octaves");
    EXPECT_EQ(makePlan("lattice", kAllTerms, techniques, kEverything).value().missing, 0u);
}

TEST(TransportPlan, AssignmentsRenderExactlyWhatTheyName) {
    const FramePlan plan =
        makePlan("LSE=direct,LVVE=octaves", kAllTerms, kTechniques, kEverything).value();
    EXPECT_EQ(plan.rendered, terms(Term::LSE, Term::LVVE));
}

TEST(TransportPlan, RefusalsSayWhatIsThere) {
    EXPECT_NE(makePlan("octave", kAllTerms, kTechniques, kEverything)
                  .message()
                  .find("did you mean 'octaves'"),
              std::string::npos);
    EXPECT_NE(makePlan("LSVE=octaves", kAllTerms, kTechniques, kEverything)
                  .message()
                  .find("claims LVVE,LXVVE"),
              std::string::npos);
    EXPECT_NE(makePlan("LVVE=octaves,LVVE=lattice", kAllTerms, kTechniques, kEverything)
                  .message()
                  .find("two techniques"),
              std::string::npos);
}

} // namespace
} // namespace tyndall
