#pragma once
// The driver's messages (KHR_debug), debug groups, and the table of messages that mean nothing.

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gl/api.h"

namespace tyndall::gl {

enum class Severity : uint32_t { Notification = 0, Low = 1, Medium = 2, High = 3 };
const char* severityName(Severity severity);

/// A message that a driver sends in sound programs, with the reason why it is dropped.
struct HarmlessMessage {
    const char* vendor; // part of GL_VENDOR or GL_RENDERER; "" for all
    GLenum source;      // GL_DONT_CARE: any
    GLenum type;        // GL_DONT_CARE: any
    GLuint id;          // 0: any
    const char* text;   // part of the message; "" for any
    const char* reason;
};
std::span<const HarmlessMessage> harmlessMessages();

/// Counts what the driver says, remembers the worst and logs each sentence once. Thread-safe, since drivers may call
/// from their threads.
class DebugLog {
public:
    DebugLog();
    ~DebugLog();
    DebugLog(DebugLog&&) noexcept;
    DebugLog& operator=(DebugLog&&) noexcept;

    /// Messages of this severity since the start or reset(), harmless ones not counted.
    [[nodiscard]] uint64_t count(Severity severity) const;
    /// Harmless messages that were dropped.
    [[nodiscard]] uint64_t dropped() const;
    /// The first 64 messages of high severity, each with its type and the debug groups around it.
    [[nodiscard]] std::vector<std::string> highSeverityMessages() const;
    /// Forgets counts and messages.
    void reset();

    /// Starts to listen to the current context. `driver` is vendor and renderer, for the table of harmless messages.
    void install(std::string driver, bool synchronous);

    struct State; // stays where it is when the log moves: the driver holds its address
private:
    std::unique_ptr<State> state_;
};

/// A named group of commands in debuggers and in the driver's messages, from construction to destruction.
class DebugGroup {
public:
    explicit DebugGroup(std::string_view name);
    ~DebugGroup();
    DebugGroup(const DebugGroup&) = delete;
    DebugGroup& operator=(const DebugGroup&) = delete;
};

} // namespace tyndall::gl
