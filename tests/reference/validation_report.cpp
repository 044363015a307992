// Measures the whole table and writes docs/measured/validation.md; see `make validation`.

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <string>

#include <fmt/format.h>
#include <tbb/info.h>

#include "core/image.h"
#include "validation/report.h"

namespace tyndall::validation {
namespace {

struct Arguments {
    std::string table, report, only;
    SuiteOptions options;
    bool ok = true;
};

Arguments parse(int argc, char** argv) {
    Arguments arguments;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        const bool more = i + 1 < argc;
        if (word == "--precise") { // for the night
            arguments.options.relativeTarget = 1e-4;
            arguments.options.segmentsPerRow *= 100;
        } else if (word == "--table" && more) {
            arguments.table = argv[++i];
        } else if (word == "--report" && more) {
            arguments.report = argv[++i];
        } else if (word == "--only" && more) {
            arguments.only = argv[++i];
        } else if (word == "--segments" && more) {
            arguments.options.segmentsPerRow = std::atof(argv[++i]);
        } else if (word == "--seed" && more) {
            arguments.options.seed = std::strtoull(argv[++i], nullptr, 10);
        } else {
            arguments.ok = false;
        }
    }
    arguments.ok = arguments.ok && !arguments.table.empty();
    return arguments;
}

std::string firstLineOf(const char* command) {
    char text[256] = "";
    if (FILE* pipe = popen(command, "r")) {
        if (!std::fgets(text, sizeof text, pipe)) text[0] = '\0';
        pclose(pipe);
    }
    text[std::strcspn(text, "\n")] = '\0';
    return text;
}

std::string machine() {
    std::ifstream info("/proc/cpuinfo");
    std::string line;
    while (std::getline(info, line))
        if (line.rfind("model name", 0) == 0) break;
    const size_t colon = line.find(": ");
    return fmt::format("{} threads of {}", tbb::info::default_concurrency(),
                       colon == std::string::npos ? "a processor" : line.substr(colon + 2));
}

int run(const Arguments& arguments) {
    const std::vector<Row> table = readTable(arguments.table);
    const auto begin = std::chrono::steady_clock::now();
    ReportFacts facts;
    facts.version = firstLineOf("git log -1 --format=%h -- engine/reference 2>/dev/null");
    std::vector<Outcome> outcomes;
    bool failed = false;
    for (const Row& row : table) {
        if (!arguments.only.empty() && row.name != arguments.only) continue;
        outcomes.push_back(judge(row, table, arguments.options));
        std::printf("%s\n", lineOf(outcomes.back()).c_str());
        std::fflush(stdout);
        failed = failed || outcomes.back().verdict == Verdict::Fail;
    }
    facts.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    facts.command =
        arguments.options.relativeTarget < 5e-4 ? "make validation PRECISE=1" : "make validation";
    facts.machine = machine();
    char date[32];
    const std::time_t now = std::time(nullptr);
    std::strftime(date, sizeof date, "%Y-%m-%d", std::gmtime(&now));
    facts.date = date;
    const Spread spread = spreadOf(outcomes);
    std::printf("%zu rows, %.0f s; t: mean %+.3f, variance %.3f, %zu beyond %.1f\n",
                outcomes.size(), facts.seconds, spread.mean, spread.variance, spread.beyond,
                kLargestT);
    if (!arguments.report.empty()) {
        const auto written =
            writeFileAtomically(arguments.report, reportPage(outcomes, arguments.options, facts));
        if (!written.ok()) {
            std::fprintf(stderr, "%s\n", written.message().c_str());
            return 2;
        }
    }
    return failed ? 1 : 0;
}

} // namespace
} // namespace tyndall::validation

int main(int argc, char** argv) {
    const auto arguments = tyndall::validation::parse(argc, argv);
    if (!arguments.ok) {
        std::fprintf(stderr,
                     "reference_validation --table rt-tables.csv [--report FILE] [--precise] "
                     "[--segments N] [--seed N] [--only CASE]\n");
        return 2;
    }
    try {
        return tyndall::validation::run(arguments);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 2;
    }
}
