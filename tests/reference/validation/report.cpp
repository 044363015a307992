#include "validation/report.h"

#include <cmath>
#include <map>

#include <fmt/format.h>

namespace tyndall::validation {
namespace {

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '|' || c == '<' || c == '*' || c == '_' || c == '~') result += '\\';
        result += c;
    }
    return result;
}

std::map<Verdict, size_t> countsOf(const std::vector<Outcome>& outcomes) {
    std::map<Verdict, size_t> counts;
    for (const Outcome& o : outcomes) ++counts[o.verdict];
    return counts;
}

/// A value with two digits of its error in parentheses: 0.36172(15).
std::string withError(double value, double error) {
    if (!(error > 0)) return fmt::format("{:.9g}", value);
    const int decimals = std::max(0, 1 - int(std::floor(std::log10(error))));
    if (decimals > 8) { // small numbers: by powers of ten
        const int power = int(std::floor(std::log10(std::max(std::abs(value), error))));
        const double unit = std::pow(10.0, power);
        const int digits = std::max(0, 1 - int(std::floor(std::log10(error / unit))));
        return fmt::format("{:.{}f}({:.0f})e{}", value / unit, digits,
                           error / unit * std::pow(10.0, digits), power);
    }
    return fmt::format("{:.{}f}({:.0f})", value, decimals, error * std::pow(10.0, decimals));
}

std::string verdictOf(const Outcome& o) {
    switch (o.verdict) {
    case Verdict::Pass: return o.repeated ? "pass, 2nd" : "pass";
    case Verdict::Fail: return "**FAIL**";
    case Verdict::Unresolved: return "unresolved";
    case Verdict::Skipped: break;
    }
    return "skipped";
}

std::string headOf(const std::vector<Outcome>& outcomes, const SuiteOptions& options,
                   const ReportFacts& facts) {
    auto counts = countsOf(outcomes);
    size_t exact = 0, reached = 0, repeated = 0;
    for (const Outcome& o : outcomes) {
        exact += o.exact;
        repeated += o.repeated;
        reached += !o.exact && o.verdict != Verdict::Skipped &&
                   o.error <= 1.1 * options.relativeTarget * std::abs(o.row->expected);
    }
    const Spread spread = spreadOf(outcomes);
    const size_t n = std::max<size_t>(1, spread.count);
    return fmt::format(
        R"(# Validation of the reference path tracer

This page measures `tyndall reference` against {} published, exact and recomputed results of radiative transfer, on {}; `{}` makes it again.
None of the results comes from this project's code. Do not edit this page by hand.

| | rows |
| --- | --- |
| pass | {} |
| **fail** | {} |
| unresolved: too little light for the effort, says nothing | {} |
| skipped, with reasons below | {} |

- {} rows are computed without random numbers, to a relative 1e-6 unless noted; {} are measured with {} independent batches each.
- {} of these reach the standard error that was asked for, {:g} of the value; for the others the table gives the one that they reach.
- All t values together: mean {:+.3f} ± {:.3f} (0 expected), variance {:.3f} ± {:.2f} (19/17 = 1.118 expected), {} of {} beyond 3.5 at first ({:.1f} expected);
  {} rows were measured a second time.
- The tracer as of commit {}; {}; {:.0f} s. The seed fixes every digit below, on any machine.

## How to read it
- *Measured* has its standard error in parentheses, in units of its last digits: 0.36172(15) is 0.36172 ± 0.00015.
- *t* is measured less expected, over the standard error (combined with the expected value's own where it has one). A row computed without random numbers has no t.
- A row passes where it is within half the last printed digit, or where |t| ≤ 3.5. With {} batches a correct program exceeds 3.5 once in 420 rows. A row that exceeds it is measured again
  with other random numbers and four times the effort, and the second measurement decides ("pass, 2nd"). Every row has random numbers of its own.
- A row is *unresolved* where the standard error is above 5 % of the value: too few paths find that light for a verdict.
- *Line* is the line of the table `rt-tables.csv`. Its conventions: σt = 1, so that metres are mean free paths; T includes the direct beam; radiances are for a
  perpendicular irradiance of π.

)",
        outcomes.size(), facts.machine, facts.command, counts[Verdict::Pass], counts[Verdict::Fail],
        counts[Verdict::Unresolved], counts[Verdict::Skipped], exact,
        outcomes.size() - exact - counts[Verdict::Skipped], kBatches, reached,
        options.relativeTarget, spread.mean, std::sqrt(1.118 / double(n)), spread.variance,
        1.118 * std::sqrt(2.4 / double(n)), spread.beyond, spread.count,
        0.0024 * double(spread.count), repeated, facts.version, facts.date, facts.seconds,
        kBatches);
}

std::string rowLine(const Outcome& o) {
    const std::string what = escaped(o.row->title());
    const std::string expected =
        o.row->value.find_first_not_of("0123456789.e-+") == std::string::npos ? o.row->value : "0";
    if (o.exact)
        return fmt::format("| {} | {} | {} | {:.9g} | | {} |\n", o.row->line, what, expected,
                           o.value, verdictOf(o));
    const std::string t = o.repeated ? fmt::format("{:+.2f}, then {:+.2f}", o.t, o.again)
                                     : fmt::format("{:+.2f}", o.t);
    return fmt::format("| {} | {} | {} | {} | {} | {} |\n", o.row->line, what, expected,
                       withError(o.value, o.error), t, verdictOf(o));
}

/// Runs of rows of one name, and what is said once for all that are measured alike.
std::string tablesOf(const std::vector<Outcome>& outcomes, bool published) {
    std::string page, name, how;
    for (const Outcome& o : outcomes) {
        if (o.verdict == Verdict::Skipped || o.row->published != published) continue;
        if (o.row->name != name || o.how != how) {
            if (o.row->name != name) page += fmt::format("\n### {}\n", o.row->name);
            name = o.row->name;
            how = o.how;
            page +=
                fmt::format("\n{}{}.\n\n| line | quantity | expected | measured | t | verdict |\n"
                            "| ---: | --- | --- | --- | ---: | --- |\n",
                            char(std::toupper(how[0])), how.substr(1));
        }
        page += rowLine(o);
    }
    return page;
}

std::string skippedOf(const std::vector<Outcome>& outcomes) {
    std::map<std::string, std::vector<const Row*>> reasons;
    for (const Outcome& o : outcomes)
        if (o.verdict == Verdict::Skipped) reasons[o.how].push_back(o.row);
    std::string page = "\n## Skipped\n\n| rows | lines | reason |\n| ---: | --- | --- |\n";
    for (const auto& [reason, rows] : reasons)
        page += fmt::format("| {} | {} to {} ({}) | {} |\n", rows.size(), rows.front()->line,
                            rows.back()->line, rows.front()->name, reason);
    return page;
}

} // namespace

Spread spreadOf(const std::vector<Outcome>& outcomes) {
    Spread spread;
    std::vector<double> values;
    for (const Outcome& o : outcomes)
        if (!o.exact && (o.verdict == Verdict::Pass || o.verdict == Verdict::Fail))
            values.push_back(o.t);
    spread.count = values.size();
    for (const double t : values) {
        spread.mean += t / double(values.size());
        spread.beyond += std::abs(t) > kLargestT;
    }
    for (const double t : values)
        spread.variance +=
            (t - spread.mean) * (t - spread.mean) / std::max(1.0, double(values.size()) - 1);
    return spread;
}

std::string reportPage(const std::vector<Outcome>& outcomes, const SuiteOptions& options,
                       const ReportFacts& facts) {
    std::string page = headOf(outcomes, options, facts);
    std::vector<Outcome> failed;
    for (const Outcome& o : outcomes)
        if (o.verdict == Verdict::Fail) failed.push_back(o);
    if (!failed.empty()) {
        page +=
            "## Failures\n\n| line | quantity | expected | measured | t | verdict |\n| ---: | --- | "
            "--- | --- | ---: | --- |\n";
        for (const Outcome& o : failed) page += rowLine(o);
    }
    page += "\n## Published values\n" + tablesOf(outcomes, true);
    page += skippedOf(outcomes);
    page += "\n## Exact and recomputed values\n" + tablesOf(outcomes, false);
    return page;
}

} // namespace tyndall::validation
