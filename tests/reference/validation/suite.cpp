#include "validation/suite.h"

#include <chrono>
#include <cmath>

#include <fmt/format.h>

namespace tyndall::validation {
namespace {

/// Standard error over expected value beyond which a measurement says nothing: light that gets so deep is found by too few paths
/// for their mean to be normal.
constexpr double kCoarsest = 0.05;
/// The effort of a second measurement.
constexpr double kRepeatFactor = 4;

/// The printed numbers' margin is left out: passes() has it. A computed one has an error of its own.
double tOf(const Row& row, const Estimate& estimate) {
    const double margin = row.published ? 0 : row.margin, apart = estimate.value - row.expected;
    const double error = std::hypot(estimate.error, margin);
    return error > 0 ? apart / error : (apart == 0 ? 0 : kInfinity);
}

bool passes(const Row& row, const Estimate& estimate) {
    return std::abs(estimate.value - row.expected) <= row.margin ||
           std::abs(tOf(row, estimate)) <= kLargestT;
}

void judgeComputed(const Computed& computed, Outcome& outcome) {
    const Row& row = *outcome.row;
    outcome.exact = true;
    outcome.value = computed.value;
    outcome.error = computed.tolerance * (row.expected != 0 ? std::abs(row.expected) : 1);
    const bool near = std::abs(computed.value - row.expected) <= outcome.error + row.margin;
    outcome.verdict = near ? Verdict::Pass : Verdict::Fail;
}

void judgeProbe(const Probe& probe, const SuiteOptions& options, Outcome& outcome) {
    const Row& row = *outcome.row;
    const auto measured = [&](const Effort& effort, uint64_t seed) {
        Estimate estimate = measure(probe, effort, seed);
        estimate.error = std::hypot(estimate.error, probe.bias * row.expected);
        outcome.counts.add(estimate.counts);
        return estimate;
    };
    Effort effort;
    effort.targetError =
        std::max(options.relativeTarget * std::abs(row.expected), 0.3 * row.margin);
    effort.segments =
        options.segmentsPerRow * probe.effort * (row.published ? options.publishedEffort : 1);
    // Of one seed for all rows every deviation would lie on the same side.
    outcome.seed = tracing::mixBits(options.seed * 1000003 + uint64_t(row.line));
    Estimate estimate = measured(effort, outcome.seed);
    outcome.t = tOf(row, estimate);
    if (!passes(row, estimate)) {
        effort.targetError /= std::sqrt(kRepeatFactor);
        effort.segments *= kRepeatFactor;
        estimate = measured(effort, tracing::mixBits(outcome.seed));
        outcome.repeated = true;
        outcome.again = tOf(row, estimate);
    }
    outcome.value = estimate.value;
    outcome.error = estimate.error;
    outcome.samples = estimate.samples;
    outcome.verdict = passes(row, estimate) ? Verdict::Pass : Verdict::Fail;
    // Paths cut off, or light that is no number, would be a mistake even where the mean looks right.
    const tracing::PathCounts& counts = outcome.counts;
    if (counts.cutOff + counts.nonFinite + counts.negative > 0) outcome.verdict = Verdict::Fail;
    if (!(estimate.error <= kCoarsest * std::abs(row.expected)) && row.expected != 0)
        outcome.verdict = Verdict::Unresolved;
}

} // namespace

double Outcome::relativeError() const {
    return row->expected != 0 ? error / std::abs(row->expected) : error;
}

Outcome judge(const Row& row, const std::vector<Row>& table, const SuiteOptions& options) {
    const auto begin = std::chrono::steady_clock::now();
    const Recipe recipe = recipeFor(row, table);
    Outcome outcome;
    outcome.row = &row;
    outcome.how = recipe.how;
    if (const auto* skipped = std::get_if<Skipped>(&recipe.what))
        outcome.how = skipped->reason;
    else if (const auto* computed = std::get_if<Computed>(&recipe.what))
        judgeComputed(*computed, outcome);
    else
        judgeProbe(std::get<Probe>(recipe.what), options, outcome);
    outcome.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return outcome;
}

std::vector<const Row*> shortRun(const std::vector<Row>& table, size_t stride) {
    std::vector<const Row*> rows;
    size_t others = 0;
    for (const Row& row : table) {
        const bool cheap = row.quantityHas("direct transmittance") || row.name == "transmittance" ||
                           row.name == "HG" || row.name == "Cornette-Shanks" ||
                           row.name == "Giovanelli" || row.name == "VPL-clamp-loss" ||
                           row.name == "white-furnace" || row.name == "airlight" ||
                           row.name == "airlight-vacuum-limit";
        const bool single = row.name == "Blanco-Fournier" || row.name == "isothermal" ||
                            row.name == "sphere-escape" || row.name == "Milne";
        if (row.published || cheap || single || others++ % stride == 0) rows.push_back(&row);
    }
    return rows;
}

std::string lineOf(const Outcome& o) {
    const char* verdicts[] = {"pass", "FAIL", "skipped", "unresolved"};
    const std::string head =
        fmt::format("line {:4} {:16} {:10}", o.row->line, o.row->name, verdicts[int(o.verdict)]);
    if (o.verdict == Verdict::Skipped) return fmt::format("{} {}", head, o.how);
    const std::string what = o.row->title();
    if (o.exact)
        return fmt::format("{} {:.9g} (expected {:.9g} ± {:.1g}) {}", head, o.value,
                           o.row->expected, o.error, what);
    return fmt::format("{} {:.7g} ± {:.1g} ({:.1g}), expected {:.7g}, t {:+.2f}{} seed {:016x} "
                       "[{:.2f} s, {} samples] {}",
                       head, o.value, o.error, o.relativeError(), o.row->expected, o.t,
                       o.repeated ? fmt::format(", again {:+.2f}", o.again) : "", o.seed, o.seconds,
                       o.samples, what);
}

} // namespace tyndall::validation
