// Options that programs share: what they mean is declared once.

#include "app/options.h"

#include <CLI/CLI.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/reference_options.h"

namespace tyndall::test {
namespace {
using ::testing::HasSubstr;

/// What the reference is told by these words.
Result<void> understandReference(const std::vector<std::string>& words, ReferenceOptions& options,
                                 reference::RenderSettings& settings) {
    CLI::App command;
    addViewOptions(command, options);
    std::vector<std::string> reversed(words.rbegin(), words.rend());
    command.parse(reversed);
    options.output = "out.exr";
    return tyndall::understandReference(options, settings);
}

TEST(Options, RendererAndReferenceReadTheSameViewFromTheSameWords) {
    const std::vector<std::string> words{"a.scene.json", "--size", "64x48", "--camera",
                                         "eye",          "--time", "2.5",   "--terms",
                                         "LE,LVE",       "--seed", "7"};
    ReferenceOptions reference;
    reference.goals.spp = 1;
    reference::RenderSettings settings;
    ASSERT_TRUE(understandReference(words, reference, settings).ok());

    RenderOptions render;
    CLI::App command;
    addRenderOptions(command, render);
    command.parse(std::vector<std::string>(words.rbegin(), words.rend()));
    const Result<RenderPlan> plan = understand(render);
    ASSERT_TRUE(plan.ok());

    EXPECT_EQ(plan->width, 64);
    EXPECT_EQ(plan->height, 48);
    EXPECT_EQ(settings.width, plan->width);
    EXPECT_EQ(settings.height, plan->height);
    EXPECT_EQ(plan->terms, terms(Term::LE, Term::LVE));
    EXPECT_EQ(settings.path.terms, plan->terms);
    EXPECT_EQ(settings.seed, render.seed);
    EXPECT_EQ(reference.camera, render.camera);
    EXPECT_EQ(reference.time, 2.5);
    EXPECT_EQ(render.time, 2.5);
}

TEST(Options, ATimeWithoutAGoalIsRefusedByTheReferenceAndNamesTheBudget) {
    reference::RenderSettings settings;
    ReferenceOptions meant;
    const Result<void> refused = understandReference({"a.gltf", "--time", "30"}, meant, settings);
    ASSERT_FALSE(refused.ok());
    EXPECT_THAT(refused.message(), HasSubstr("--seconds"));
    for (const ReferenceGoals& goals :
         {ReferenceGoals{4, 0, 0}, ReferenceGoals{0, 4, 0}, ReferenceGoals{0, 0, 0.1}}) {
        ReferenceOptions options;
        options.goals = goals;
        EXPECT_TRUE(understandReference({"a.gltf", "--time", "30"}, options, settings).ok());
    }
}

TEST(Options, WithoutTimeAndGoalTheReferenceTakes64Samples) {
    ReferenceOptions options;
    reference::RenderSettings settings;
    ASSERT_TRUE(understandReference({"a.gltf"}, options, settings).ok());
    EXPECT_EQ(options.goals.spp, 64);
    EXPECT_EQ(settings.path.terms, kAllTerms);
}

TEST(Options, TheReferenceTakesLargerSeedsThanShadersDo) {
    const std::string large = "4294967296"; // 2^32
    ReferenceOptions reference;
    reference::RenderSettings settings;
    ASSERT_TRUE(understandReference({"a.gltf", "--seed", large}, reference, settings).ok());
    EXPECT_EQ(settings.seed, uint64_t(1) << 32);
    RenderOptions render;
    render.seed = uint64_t(1) << 32;
    const Result<RenderPlan> plan = understand(render);
    ASSERT_FALSE(plan.ok());
    EXPECT_THAT(plan.message(), HasSubstr("--seed " + large));
}

} // namespace
} // namespace tyndall::test
