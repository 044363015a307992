#pragma once
// What the engine said, for the log pane; stderr hears it too.

#include <deque>
#include <mutex>
#include <string>
#include <vector>

#include "core/log.h"

namespace tyndall::editor {

class Messages {
public:
    struct Entry {
        log::Level level;
        std::string text;
        int count = 1; // said so often in a row
    };

    /// Listens from construction to destruction.
    Messages();
    ~Messages();
    Messages(const Messages&) = delete;
    Messages& operator=(const Messages&) = delete;

    [[nodiscard]] std::vector<Entry> entries() const;
    /// Messages so far, to see whether there are new ones.
    [[nodiscard]] size_t total() const;
    void clear();

private:
    void hear(log::Level level, std::string_view text);
    mutable std::mutex mutex_; // drivers and loaders speak from their own threads
    std::deque<Entry> entries_;
    size_t total_ = 0;
    log::Sink before_;
};

} // namespace tyndall::editor
