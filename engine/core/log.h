#pragma once
// Messages for people: one line each on stderr. A message that repeats (a broken shader, once a frame)
// is shown once per key.

#include <functional>
#include <string>
#include <string_view>

namespace tyndall::log {

enum class Level { Debug = 0, Info = 1, Warning = 2, Error = 3 };

/// Receives every message at or above the level; the editor's log pane is one. Default: stderr.
using Sink = std::function<void(Level, std::string_view)>;

/// Replaces the sink and returns the one before; an empty sink restores stderr. Thread-safe.
Sink setSink(Sink sink);
/// Messages below `level` are dropped (default Info; `--quiet` sets Warning).
void setLevel(Level level);

void debug(std::string_view message);
void info(std::string_view message);
void warning(std::string_view message);
void error(std::string_view message);
/// As warning(), but only the first time this `key` is seen in the process.
void warningOnce(std::string_view key, std::string_view message);

} // namespace tyndall::log
