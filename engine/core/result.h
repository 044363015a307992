#pragma once
// Errors of the outside world (files, drivers, users) travel as values: a sentence that names the
// culprit, the place in it, what was wrong and what would be right. Programmer's errors are `CHECK`s.

#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "core/check.h"

namespace tyndall {

/// One sentence for a person. It names the file and the place in it; no trailing newline.
struct Error {
    std::string message;
};

/// A value, or the sentence that says why there is none. Reading the wrong side is a CHECK failure.
template <typename T> class [[nodiscard]] Result {
public:
    Result(T value) : state_(std::move(value)) {}
    Result(Error error) : state_(std::move(error)) {}

    [[nodiscard]] bool ok() const { return std::holds_alternative<T>(state_); }
    explicit operator bool() const { return ok(); }

    T& value() & { return checked(); }
    const T& value() const& { return const_cast<Result*>(this)->checked(); }
    T&& value() && { return std::move(checked()); }
    T& operator*() & { return checked(); }
    const T& operator*() const& { return const_cast<Result*>(this)->checked(); }
    T* operator->() { return &checked(); }
    const T* operator->() const { return &const_cast<Result*>(this)->checked(); }

    [[nodiscard]] const Error& error() const {
        CHECK(!ok(), "error() called on a Result that holds a value");
        return std::get<Error>(state_);
    }
    [[nodiscard]] const std::string& message() const { return error().message; }

private:
    T& checked() {
        CHECK(ok(), ok() ? std::string() : std::get<Error>(state_).message);
        return std::get<T>(state_);
    }
    std::variant<T, Error> state_;
};

/// Success, or the sentence that says why not.
template <> class [[nodiscard]] Result<void> {
public:
    Result() = default;
    Result(Error error) : error_(std::move(error)) {}

    [[nodiscard]] bool ok() const { return !error_.has_value(); }
    explicit operator bool() const { return ok(); }
    [[nodiscard]] const Error& error() const {
        CHECK(!ok(), "error() called on a Result that holds a value");
        return *error_;
    }
    [[nodiscard]] const std::string& message() const { return error().message; }

private:
    std::optional<Error> error_;
};

} // namespace tyndall
