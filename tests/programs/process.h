#pragma once
// Runs programs as a user does: another process, its exit status, what it said.

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tyndall::test {

struct ProcessResult {
    int status = -1;       // exit status; -1 where a signal ended it
    int signal = 0;        // that signal
    bool timedOut = false; // it was killed for taking too long
    std::string out, err;
    double seconds = 0;
};

struct ProcessOptions {
    std::filesystem::path folder;                        // to run in; empty: where the test runs
    std::optional<std::vector<std::string>> environment; // "NAME=VALUE"; none: the test's own
    double timeoutSeconds = 120;
    double interruptAfterSeconds = 0; // > 0: sends SIGINT once, after so long
};

ProcessResult run(const std::vector<std::string>& arguments, const ProcessOptions& options = {});

/// The `tyndall` of this build with these arguments.
ProcessResult tyndall(std::vector<std::string> arguments, const ProcessOptions& options = {});

/// True when it neither crashed nor hung. The message to show is in `why`.
bool endedByItself(const ProcessResult& result, std::string& why);

} // namespace tyndall::test
