#include "messages.h"

#include <cstdio>

namespace tyndall::editor {
namespace {
constexpr size_t kMost = 2000; // lines kept
}

Messages::Messages() {
    before_ = log::setSink([this](log::Level level, std::string_view text) { hear(level, text); });
}

Messages::~Messages() { log::setSink(std::move(before_)); }

void Messages::hear(log::Level level, std::string_view text) {
    const char* prefix = level == log::Level::Warning ? "warning: "
                         : level == log::Level::Error ? "error: "
                                                      : "";
    std::fprintf(stderr, "%s%.*s\n", prefix, int(text.size()), text.data());
    const std::scoped_lock lock(mutex_);
    ++total_;
    if (!entries_.empty() && entries_.back().text == text && entries_.back().level == level) {
        ++entries_.back().count;
        return;
    }
    entries_.push_back({level, std::string(text)});
    if (entries_.size() > kMost) entries_.pop_front();
}

std::vector<Messages::Entry> Messages::entries() const {
    const std::scoped_lock lock(mutex_);
    return {entries_.begin(), entries_.end()};
}

size_t Messages::total() const {
    const std::scoped_lock lock(mutex_);
    return total_;
}

void Messages::clear() {
    const std::scoped_lock lock(mutex_);
    entries_.clear();
}

} // namespace tyndall::editor
