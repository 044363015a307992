#include "transport/plan.h"

#include <gtest/gtest.h>

namespace tyndall {
namespace {

Technique technique(const char* name, TermSet claims, std::vector<TermSet> sets = {}) {
    Technique made;
    made.name = name;
    made.claims = claims;
    made.sets = std::move(sets);
    return made;
}

const TermSet kOctaves = terms(Term::LVVE, Term::LXVVE);
/// Computes its terms in media inside particles alone.
Technique network() {
    Technique made = technique("network", kOctaves);
    made.media = kParticleMedia;
    return made;
}
const std::vector<Technique> kTechniques = {
    technique("octaves", kOctaves, {kOctaves}),
    technique("lattice", kIndirectOnSurfaces | kIndirectInMedia),
    technique("fogonly", terms(Term::LVE, Term::LVVE)),
    network(),
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
         {"auto", "none", "lattice", "fogonly", "network", "LVVE=fogonly,LSVE=lattice", "LVVE=network,LVVE=lattice"})
        for (TermSet wanted : {kAllTerms, kDirectTerms, bit(Term::LVVE), TermSet(0)}) {
            const Result<FramePlan> plan = makePlan(gi, wanted, kTechniques, kEverything);
            ASSERT_TRUE(plan.ok()) << gi;
            TermSet seen = 0;
            for (uint32_t t = 0; t < kTermCount; ++t) {
                MediaSet taken = 0;
                for (const TermShare& share : plan->sharesOf(Term(t))) {
                    EXPECT_EQ(taken & share.media, 0u) << gi;
                    taken |= share.media;
                    EXPECT_TRUE(plan->termsOf(share.owner) & bit(Term(t))) << gi;
                }
                if (taken != 0) seen |= bit(Term(t));
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

TEST(TransportPlan, WhoCouldComputeAMissingTermIsWhoRendersItWhenChosen) {
    SceneTraits noParticles = kEverything;
    noParticles.kinds = kAllMedia & ~kParticleMedia;
    for (const SceneTraits& traits : {kEverything, noParticles})
        for (const TermSet wanted : {kAllTerms, kAllTerms & ~bit(Term::LXVVE)}) {
            const FramePlan none = makePlan("none", wanted, kTechniques, traits).value();
            for (uint32_t t = 0; t < kTermCount; ++t) {
                std::vector<int> able;
                for (size_t i = 0; i < kTechniques.size(); ++i) {
                    const Result<FramePlan> chosen =
                        makePlan(kTechniques[i].name, wanted, kTechniques, traits);
                    const bool less = chosen.ok() && chosen->missingIn(Term(t)) !=
                                                         none.missingIn(Term(t));
                    if (less) able.push_back(int(i));
                }
                EXPECT_EQ(techniquesFor(Term(t), none, kTechniques), able) << t << " " << wanted;
            }
        }
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

TEST(TransportPlan, AssignmentsRenderTheIndirectTermsThatTheyNameAndKeepTheDirectOnes) {
    const auto rendered = [](const char* gi, TermSet wanted) {
        return makePlan(gi, wanted, kTechniques, kEverything).value().rendered;
    };
    EXPECT_EQ(rendered("LSVE=lattice", kAllTerms), kDirectTerms | bit(Term::LSVE));
    EXPECT_EQ(rendered("LSE=direct,LSVE=lattice", kAllTerms), kDirectTerms | bit(Term::LSVE));
    EXPECT_EQ(rendered("LSVE=lattice", terms(Term::LE, Term::LSVE)), terms(Term::LE, Term::LSVE));
    const FramePlan plan =
        makePlan("LVE=fogonly", kAllTerms, kTechniques, kEverything).value();
    EXPECT_EQ(plan.termsOf(kDirectPasses), terms(Term::LE, Term::LSE)) << "taken from the engine";
    EXPECT_EQ(plan.termsOf(2), bit(Term::LVE));
}

TEST(TransportPlan, ATechniqueThatMixesTermsGetsAllOfThemOrNone) {
    const Result<FramePlan> part = makePlan("LVVE=octaves", kAllTerms, kTechniques, kEverything);
    ASSERT_FALSE(part.ok());
    EXPECT_NE(part.message().find("cannot leave out LXVVE"), std::string::npos) << part.message();
    EXPECT_FALSE(makePlan("octaves", bit(Term::LXVVE), kTechniques, kEverything).ok());
    EXPECT_TRUE(
        makePlan("LVVE=octaves,LXVVE=octaves", kAllTerms, kTechniques, kEverything).ok());
    // What the scene cannot have is not missed: in vacuum nothing of the mixture is left.
    EXPECT_TRUE(makePlan("octaves", bit(Term::LXVVE), kTechniques, {true, false, false, true}).ok());
}

TEST(TransportPlan, OneKindOfMediumFromOneTechniqueAndTheRestFromAnother) {
    for (const char* gi : {"LVVE=network,LVVE=lattice", "LVVE=lattice,LVVE=network"}) {
        const FramePlan plan = makePlan(gi, kAllTerms, kTechniques, kEverything).value();
        EXPECT_EQ(plan.mediaOf(3), kParticleMedia) << gi;
        EXPECT_EQ(plan.mediaOf(1), kAllMedia & ~kParticleMedia) << gi;
        EXPECT_EQ(plan.missingIn(Term::LVVE), 0u) << gi;
    }
    // Where the other cannot leave out particles, it cannot be had twice.
    std::vector<Technique> techniques = kTechniques;
    techniques[1].separatesMedia = false;
    EXPECT_FALSE(
        makePlan("LVVE=network,LVVE=lattice", kAllTerms, techniques, kEverything).ok());
    // All that it computes in media it computes in the same media.
    const Result<FramePlan> uneven =
        makePlan("LVVE=network,LVVE=lattice,LSVE=lattice", kAllTerms, kTechniques, kEverything);
    ASSERT_FALSE(uneven.ok());
    EXPECT_NE(uneven.message().find("the same kinds of media"), std::string::npos);
}

TEST(TransportPlan, AnAssignmentMayNameTheKindOfMedium) {
    const FramePlan plan =
        makePlan("LVVE:grids=fogonly,LVVE=lattice", kAllTerms, kTechniques, kEverything).value();
    EXPECT_EQ(plan.mediaOf(2), kGridMedia);
    EXPECT_EQ(plan.mediaOf(1), kAllMedia & ~kGridMedia);
    const auto refusal = [](const char* gi) {
        const Result<FramePlan> refused = makePlan(gi, kAllTerms, kTechniques, kEverything);
        return refused.ok() ? std::string() : refused.message();
    };
    EXPECT_NE(refusal("LVVE:clouds=lattice").find("shapes,height,grids,particles"),
              std::string::npos);
    EXPECT_NE(refusal("LVVE:grids=network").find("it has particles"), std::string::npos);
    EXPECT_NE(refusal("LSSE:grids=lattice").find("on surfaces"), std::string::npos);
}

TEST(TransportPlan, WhatIsComputedInSomeMediaIsMissingInTheOthers) {
    SceneTraits traits = kEverything;
    traits.kinds = kParticleMedia | kHeightMedia;
    const FramePlan plan = makePlan("network", kAllTerms, kTechniques, traits).value();
    EXPECT_TRUE(plan.rendered & bit(Term::LVVE));
    EXPECT_TRUE(plan.missing & bit(Term::LVVE));
    EXPECT_EQ(plan.missingIn(Term::LVVE), kHeightMedia);
    traits.kinds = kParticleMedia;
    EXPECT_FALSE(makePlan("network", kAllTerms, kTechniques, traits).value().missing &
                 bit(Term::LVVE));
}

TEST(TransportPlan, AutoMayTakeSurfacesFromOneAndMediaFromAnother) {
    std::vector<Technique> techniques = kTechniques;
    techniques[1].claims = kIndirectOnSurfaces;
    const FramePlan plan = makePlan("auto", kAllTerms, techniques, kEverything).value();
    EXPECT_EQ(plan.termsOf(1), kIndirectOnSurfaces);
    EXPECT_EQ(plan.termsOf(0), kOctaves);
    EXPECT_EQ(plan.technique, "lattice+octaves");
    EXPECT_EQ(plan.missing, terms(Term::LSVE, Term::LXSVE));
}

TEST(TransportPlan, AmongEqualsAutoTakesTheOneWithTheLeastError) {
    std::vector<Technique> techniques = {technique("rough", kIndirectInMedia),
                                         technique("fine", kIndirectInMedia)};
    for (Expectation& e : techniques[0].expected) e.errorInMedia = 0.2f;
    for (Expectation& e : techniques[1].expected) e.errorInMedia = 0.1f;
    EXPECT_EQ(makePlan("auto", kAllTerms, techniques, kEverything).value().technique, "fine");
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
    EXPECT_NE(makePlan("LSVE=lattice,LSVE=lattice", kAllTerms, kTechniques, kEverything)
                  .message()
                  .find("two techniques"),
              std::string::npos);
}

} // namespace
} // namespace tyndall
