#pragma once
// The suite's outcome as a page of Markdown.

#include <string>

#include "validation/suite.h"

namespace tyndall::validation {

struct ReportFacts {
    std::string command, version, date, machine;
    double seconds = 0;
};

std::string reportPage(const std::vector<Outcome>& outcomes, const SuiteOptions& options,
                       const ReportFacts& facts);

/// Of the t values of all rows measured by chance: mean and variance, and how many lie beyond kLargestT. For honest rows
/// they have Student's distribution with kBatches - 1 degrees of freedom: mean 0 and variance 19/17.
struct Spread {
    size_t count = 0, beyond = 0;
    double mean = 0, variance = 0;
};
Spread spreadOf(const std::vector<Outcome>& outcomes);

} // namespace tyndall::validation
