// Compiles every program that C++ can ask for. An executable of its own, because it is the slowest of the GL tests.

#include <fmt/format.h>

#include <chrono>

#include "gl/gl_fixture.h"
#include "gl/shader_library.h"

namespace tyndall::gl {
namespace {

class VariantsTest : public test::GlTest {};
TYNDALL_GL_TESTS(VariantsTest);

TEST_P(VariantsTest, EveryListedVariantCompiles) {
    ShaderLibrary library;
    int count = 0;
    double slowest = 0;
    std::string slowestName;
    library.variants().forEachVariant([&](const ProgramRequest& request) {
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
