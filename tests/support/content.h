#pragma once
// Where tests find things. Shared content (Sponza, volumes …) is not part of the repository: tests that need it
// skip with a sentence where it is absent.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace tyndall::test {

/// The repository's root.
std::filesystem::path sourceDir();
/// The folder of the built programs.
std::filesystem::path binDir();
/// A file of the shared content: $TYNDALL_CONTENT, else ../shared/content beside the repository. Empty where missing.
std::optional<std::filesystem::path> sharedContent(const std::string& relative);
/// A fresh folder that is removed when the process ends.
std::filesystem::path scratchDir(const std::string& name);
/// $TYNDALL_SEED, else 1. Tests that draw numbers print it, so that a failure is one pasted line away.
uint64_t seed();

} // namespace tyndall::test

/// Use in a test body: `const auto path = REQUIRE_CONTENT("vdb/smoke1.vdb");`
#define REQUIRE_CONTENT(RELATIVE)                                                                  \
    __extension__({                                                                                \
        const auto found_ = ::tyndall::test::sharedContent(RELATIVE);                              \
        if (!found_) GTEST_SKIP() << "shared content '" << RELATIVE << "' is not here";            \
        *found_;                                                                                   \
    })
