#pragma once
// How a command ends: the exit status that scripts see, and the sentence that people see.

#include <string>

#include "core/result.h"

namespace tyndall {

/// Exit statuses of all programs.
enum class ExitStatus : int {
    Done = 0,
    Failed = 1,     // it did not work, or a threshold of the command line was not met
    WrongInput = 2, // the command line or an input file is wrong
};

struct [[nodiscard]] Outcome {
    ExitStatus status = ExitStatus::Done;
    std::string message; // empty when done

    [[nodiscard]] bool ok() const { return status == ExitStatus::Done; }
};

inline Outcome failed(std::string message) { return {ExitStatus::Failed, std::move(message)}; }
inline Outcome wrongInput(std::string message) {
    return {ExitStatus::WrongInput, std::move(message)};
}
/// What a Result means to a command whose failure has this status.
template <typename T> Outcome outcomeOf(const Result<T>& result, ExitStatus otherwise) {
    return result.ok() ? Outcome{} : Outcome{otherwise, result.message()};
}

} // namespace tyndall
