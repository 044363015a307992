// Known results of radiative transfer: the rows that others have published, those that need no chance, and a spread of the rest.
// `make validation` measures all of them and writes docs/measured/validation.md.

#include <gtest/gtest.h>

#include "support/content.h"
#include "validation/report.h"

namespace tyndall::validation {
namespace {

// A short run: a hundred seconds on two cores. Rows that do not reach the wanted error say which one they reach.
constexpr size_t kStride = 17;
constexpr double kSegments = 1.2e6;

SuiteOptions shortOptions() {
    SuiteOptions options;
    options.segmentsPerRow = kSegments;
    options.publishedEffort = 1;
    return options;
}

void expectPass(const Outcome& outcome) {
    const std::string line = lineOf(outcome);
    std::printf("%s\n", line.c_str());
    EXPECT_NE(outcome.verdict, Verdict::Fail) << line;
}

TEST(ReferenceTables, EveryRowIsMeasuredOrHasAReasonNotToBe) {
    const std::vector<Row> table = readTable(REQUIRE_CONTENT("../reference/rt-tables.csv"));
    EXPECT_EQ(table.size(), 1216u);
    size_t measured = 0, skipped = 0;
    for (const Row& row : table) {
        if (row.name == "white-furnace" ||
            row.name == "transmittance") { // these take a second each
            ++measured;
            continue;
        }
        const Recipe recipe = recipeFor(row, table);
        if (const auto* reason = std::get_if<Skipped>(&recipe.what)) {
            EXPECT_FALSE(reason->reason.empty());
            ++skipped;
        } else {
            EXPECT_FALSE(recipe.how.empty()) << row.line;
            ++measured;
        }
    }
    EXPECT_EQ(measured + skipped, table.size());
    // Of 1216: 2 refract, 9 belong to a technique, 6 are roots of an equation, 3 conserve energy, 71 are twins of better rows, 3 let next to nothing through.
    EXPECT_EQ(skipped, 94u);
}

TEST(ReferenceTables, PublishedAndExactRowsAndASpreadOfTheOthers) {
    const std::vector<Row> table = readTable(REQUIRE_CONTENT("../reference/rt-tables.csv"));
    std::vector<Outcome> outcomes;
    size_t resolved = 0;
    for (const Row* row : shortRun(table, kStride)) {
        outcomes.push_back(judge(*row, table, shortOptions()));
        if (outcomes.back().verdict != Verdict::Skipped) expectPass(outcomes.back());
        resolved += outcomes.back().verdict == Verdict::Pass;
    }
    const Spread spread = spreadOf(outcomes);
    std::printf("%zu rows; t: mean %+.3f, variance %.3f, %zu of %zu beyond %.1f at first\n",
                outcomes.size(), spread.mean, spread.variance, spread.beyond, spread.count,
                kLargestT);
    EXPECT_GT(resolved, 250u);
    // A bias too small for single rows shows in the mean of all: four standard errors of it.
    EXPECT_LT(std::abs(spread.mean), 4 * std::sqrt(1.118 / double(spread.count)));
    EXPECT_LE(spread.beyond, 2u);
}

TEST(ReferenceTables, ASuiteThatIsHandedAWrongValueSaysSo) {
    const std::vector<Row> table = readTable(REQUIRE_CONTENT("../reference/rt-tables.csv"));
    SuiteOptions options = shortOptions();
    options.segmentsPerRow = 3e5;
    Row row = table[27]; // the slab's reflectance by adding-doubling
    ASSERT_EQ(row.name, "MCML-vdH35");
    row.expected *= 1.05;
    EXPECT_EQ(judge(row, table, options).verdict, Verdict::Fail);
    Row exact = table[1173]; // a closed form
    ASSERT_EQ(exact.name, "transmittance");
    exact.expected *= 1 + 1e-5;
    EXPECT_EQ(judge(exact, table, options).verdict, Verdict::Fail);
}

} // namespace
} // namespace tyndall::validation
