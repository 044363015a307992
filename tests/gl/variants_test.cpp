// Compiles the programs that C++ can ask for: every value of every define once, and every combination of them with TYNDALL_LONG_TESTS=1.
// An executable of its own, because it is the slowest of the GL tests.

#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <set>
#include <string>

#include "gl/gl_fixture.h"
#include "gl/shader_library.h"

namespace tyndall::gl {
namespace {

class VariantsTest : public test::GlTest {};
TYNDALL_GL_TESTS(VariantsTest);

/// Has the request a stage or a value of a define that none before it had?
class Novelty {
public:
    bool operator()(const ProgramRequest& request) {
        std::string stages;
        for (const std::string& file : request.files) stages += file + " ";
        bool isNew = seen_.insert(stages).second;
        for (const auto& [name, value] : request.defines)
            isNew |= seen_.insert(fmt::format("{} {}={}", stages, name, value)).second;
        return isNew;
    }

private:
    std::set<std::string> seen_;
};

TEST_P(VariantsTest, EveryListedVariantCompiles) {
    const bool all = std::getenv("TYNDALL_LONG_TESTS") != nullptr;
    ShaderLibrary library;
    Novelty brings;
    int count = 0;
    double slowest = 0;
    std::string slowestName;
    library.variants().forEachVariant([&](const ProgramRequest& request) {
        if (!brings(request) && !all) return;
        const auto begin = std::chrono::steady_clock::now();
        const Result<const Program*> program = library.program(request);
        const double seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        if (seconds > slowest) slowestName = request.describe();
        slowest = std::max(slowest, seconds);
        EXPECT_TRUE(program.ok()) << (program ? "" : program.message());
        // Remarks are shown and not judged: Mesa takes a global variable that main() sets for one without a value.
        if (program && !(*program)->warnings().empty())
            fmt::print("{}:\n{}\n", request.describe(), (*program)->warnings());
        ++count;
    });
    EXPECT_GT(count, 0);
    fmt::print("{} variants; the slowest, {}, took {:.2f} s\n", count, slowestName, slowest);
}

} // namespace
} // namespace tyndall::gl
