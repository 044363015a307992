#pragma once
// tyndall-grid-reader as a child process: started, listened to, and ended whatever it does.

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <sys/types.h>
#include <vector>

#include "core/result.h"
#include "media/grid_import.h"
#include "media/reader/grid_stream.h"

namespace tyndall {

/// What the reader sent: a whole message, already checked for magic number and size.
struct ReaderMessage {
    stream::MessageType type{};
    std::vector<char> payload;
};

/// One reader and its file. Moved-from is empty; the destructor ends the child.
class ReaderProcess {
public:
    /// Errors: the reader is not found or does not start.
    static Result<ReaderProcess> start(const std::filesystem::path& file, const GridLimits& limits);

    ReaderProcess(ReaderProcess&& other) noexcept;
    ReaderProcess& operator=(ReaderProcess&&) = delete;
    ~ReaderProcess();

    /// The next message. Errors, a sentence that names the file: the reader reported a failure, crashed, hung, or
    /// sent what makes no sense.
    Result<ReaderMessage> receive();
    Result<void> send(stream::CommandType type, uint32_t grid);

private:
    ReaderProcess() = default;
    [[nodiscard]] Result<void> receiveBytes(void* data, size_t bytes);
    [[nodiscard]] Error damaged(const std::string& reason) const;
    [[nodiscard]] Error explainEnd();
    int stop(); // the child's wait status, -1 if unknown

    pid_t child_ = -1;
    int socket_ = -1;
    std::string file_; // for sentences
    std::string format_ = "file";
    double seconds_ = 0;
    std::chrono::steady_clock::time_point deadline_;
};

/// Text from a file, made fit for one line: control characters and broken UTF-8 become '?'.
[[nodiscard]] std::string printable(std::string_view text);

} // namespace tyndall
