#pragma once
// Checks for programmers' errors. `CHECK` is always on and guards API edges; `ASSERT` is on in debug
// and test builds. Both print the expression, the message and the place, then throw
// `CheckFailure` — a test can expect it, and a program's main() turns it into exit status 1.

#include <stdexcept>
#include <string>
#include <string_view>

namespace tyndall {

/// Thrown by CHECK and ASSERT; what() holds expression, message and file:line.
class CheckFailure : public std::logic_error {
public:
    using std::logic_error::logic_error;
};

[[noreturn]] void failCheck(const char* expression, std::string_view message, const char* file,
                            int line);

} // namespace tyndall

// clang-format off
#define CHECK(condition, ...)                                                                     \
    do {                                                                                          \
        if (!(condition)) [[unlikely]] ::tyndall::failCheck(#condition, ::std::string{__VA_ARGS__}, __FILE__, __LINE__); \
    } while (false)

#if defined(NDEBUG) && !defined(TYNDALL_ASSERTS)
#define ASSERT(condition, ...) do { (void)sizeof(!(condition)); } while (false)
#else
#define ASSERT(condition, ...) CHECK(condition __VA_OPT__(,) __VA_ARGS__)
#endif

/// For statistical statements: `probability` is the chance of a false alarm, and goes into the message.
#define CHECK_RARE(condition, probability, seed)                                                  \
    do {                                                                                          \
        if (!(condition)) [[unlikely]]                                                            \
            ::tyndall::failCheck(#condition, "a statement expected to hold but for probability " + ::std::to_string(probability) + "; seed " + ::std::to_string(seed), __FILE__, __LINE__); \
    } while (false)
// clang-format on
