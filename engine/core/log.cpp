#include "core/log.h"

#include <cstdio>
#include <mutex>
#include <set>

namespace tyndall::log {
namespace {

struct State {
    std::mutex mutex;
    Sink sink;
    Level level = Level::Info;
    std::set<std::string, std::less<>> seen;
};

State& state() {
    static State instance; // The one sink of the process: stderr is one, too.
    return instance;
}

void writeToStderr(Level level, std::string_view message) {
    const char* prefix = level == Level::Warning ? "warning: "
                         : level == Level::Error ? "error: "
                                                 : "";
    std::fprintf(stderr, "%s%.*s\n", prefix, int(message.size()), message.data());
}

void emit(Level level, std::string_view message) {
    State& s = state();
    std::lock_guard lock(s.mutex);
    if (level < s.level) return;
    if (s.sink)
        s.sink(level, message);
    else
        writeToStderr(level, message);
}

} // namespace

Sink setSink(Sink sink) {
    State& s = state();
    std::lock_guard lock(s.mutex);
    std::swap(s.sink, sink);
    return sink;
}

void setLevel(Level level) {
    State& s = state();
    std::lock_guard lock(s.mutex);
    s.level = level;
}

void debug(std::string_view message) { emit(Level::Debug, message); }
void info(std::string_view message) { emit(Level::Info, message); }
void warning(std::string_view message) { emit(Level::Warning, message); }
void error(std::string_view message) { emit(Level::Error, message); }

void warningOnce(std::string_view key, std::string_view message) {
    {
        State& s = state();
        std::lock_guard lock(s.mutex);
        if (!s.seen.emplace(key).second) return;
    }
    emit(Level::Warning, message);
}

} // namespace tyndall::log
