#pragma once
// Rows measured and judged.

#include "validation/recipes.h"

namespace tyndall::validation {

enum class Verdict {
    Pass = 0,
    Fail = 1,
    Skipped = 2,
    Unresolved = 3 // measured, but too coarsely to tell anything
};

struct Outcome {
    const Row* row = nullptr;
    Verdict verdict = Verdict::Skipped;
    std::string how;    // how it was measured, or why it was not
    bool exact = false; // without chance
    double value = 0, error = 0;
    double t = 0;     // (value - expected) / standard error, of the first measurement
    double again = 0; // of the second one, where there was need for one; else 0
    bool repeated = false;
    uint64_t samples = 0, seed = 0;
    tracing::PathCounts counts;
    double seconds = 0;
    /// Standard error over expected value.
    [[nodiscard]] double relativeError() const;
};

struct SuiteOptions {
    double relativeTarget = 5e-4; // of the standard error
    double segmentsPerRow = 6e5;  // at most, path segments and shadow rays together
    double publishedEffort = 4;   // times that, for what others have printed
    uint64_t seed = 20261;
};

/// A row passes where it is within the expected value's printed digits, or within kLargestT standard errors of it. One that does
/// not is measured once more with other random numbers and four times the effort, and that decides: among a thousand
/// honest rows two or three are outside the first time.
Outcome judge(const Row& row, const std::vector<Row>& table, const SuiteOptions& options);

/// The rows of the short run: all published ones, all that are cheap, and of the others every `stride`th.
std::vector<const Row*> shortRun(const std::vector<Row>& table, size_t stride);

/// One line for a terminal.
std::string lineOf(const Outcome& outcome);

} // namespace tyndall::validation
