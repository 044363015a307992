#include "media/reader_process.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>

extern char** environ;

namespace tyndall {
namespace fs = std::filesystem;

namespace {

constexpr const char* kReaderName = "tyndall-grid-reader";

Result<fs::path> findReader() {
    if (const char* given = std::getenv("TYNDALL_GRID_READER"); given && *given) {
        if (::access(given, X_OK) == 0) return fs::path(given);
        return Error{fmt::format("TYNDALL_GRID_READER names '{}', which is no program", given)};
    }
    std::error_code error;
    const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
    for (const char* relative : {".", "../libexec", "../bin"}) {
        const fs::path candidate = (folder / relative / kReaderName).lexically_normal();
        if (::access(candidate.c_str(), X_OK) == 0) return candidate;
    }
    return Error{fmt::format(
        "volumes cannot be read, because the program '{}' is missing beside this one in '{}' (TYNDALL_GRID_READER can name it)",
        kReaderName, folder.string())};
}

struct SpawnActions {
    posix_spawn_file_actions_t actions;
    SpawnActions() { posix_spawn_file_actions_init(&actions); }
    ~SpawnActions() { posix_spawn_file_actions_destroy(&actions); }
    SpawnActions(const SpawnActions&) = delete;
    SpawnActions& operator=(const SpawnActions&) = delete;
};

struct SpawnAttributes {
    posix_spawnattr_t attributes;
    SpawnAttributes() {
        // The child must not inherit that the parent blocks or ignores signals; the limits rely on them.
        posix_spawnattr_init(&attributes);
        sigset_t none, all;
        sigemptyset(&none);
        sigfillset(&all);
        posix_spawnattr_setsigmask(&attributes, &none);
        posix_spawnattr_setsigdefault(&attributes, &all);
        posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    }
    ~SpawnAttributes() { posix_spawnattr_destroy(&attributes); }
    SpawnAttributes(const SpawnAttributes&) = delete;
    SpawnAttributes& operator=(const SpawnAttributes&) = delete;
};

bool isContinuation(std::string_view text, size_t i) {
    return i < text.size() && (static_cast<unsigned char>(text[i]) & 0xc0) == 0x80;
}

} // namespace

std::string printable(std::string_view text) {
    std::string result;
    for (size_t i = 0; i < text.size(); ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        if (byte >= 0x20 && byte < 0x7f) {
            result += text[i];
            continue;
        }
        const size_t length = byte >= 0xc2 && byte < 0xe0   ? 2
                              : byte >= 0xe0 && byte < 0xf0 ? 3
                              : byte >= 0xf0 && byte < 0xf5 ? 4
                                                            : 0;
        bool whole = length > 0;
        for (size_t k = 1; k < length; ++k) whole = whole && isContinuation(text, i + k);
        // C1 control characters (U+0080 to U+009F) would reach the terminal too.
        if (!whole || (byte == 0xc2 && static_cast<unsigned char>(text[i + 1]) < 0xa0)) {
            result += '?';
            continue;
        }
        result += text.substr(i, length);
        i += length - 1;
    }
    return result;
}

Result<ReaderProcess> ReaderProcess::start(const fs::path& file, const GridLimits& limits) {
    const Result<fs::path> reader = findReader();
    if (!reader) return reader.error();
    std::error_code error;
    const uintmax_t fileBytes = fs::file_size(file, error);

    ReaderProcess process;
    process.file_ = printable(file.string());
    process.seconds_ =
        limits.seconds > 0 ? limits.seconds : 20.0 + (error ? 0.0 : double(fileBytes) / 10e6);
    process.deadline_ = std::chrono::steady_clock::now() +
                        std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                            std::chrono::duration<double>(process.seconds_));

    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
        return Error{fmt::format("'{}' cannot be read: no socket for the reader: {}", process.file_,
                                 std::strerror(errno))};
    process.socket_ = ends[0];

    SpawnActions spawn;
    posix_spawn_file_actions_adddup2(&spawn.actions, ends[1], STDIN_FILENO);
    posix_spawn_file_actions_addopen(&spawn.actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&spawn.actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    const SpawnAttributes attributes;

    std::string arguments[] = {reader->string(), file.string(), std::to_string(limits.readerBytes),
                               std::to_string(uint64_t(process.seconds_) + 1)};
    char* argv[] = {arguments[0].data(), arguments[1].data(), arguments[2].data(),
                    arguments[3].data(), nullptr};
    const int failure = ::posix_spawn(&process.child_, argv[0], &spawn.actions,
                                      &attributes.attributes, argv, environ);
    ::close(ends[1]);
    if (failure != 0) {
        process.child_ = -1;
        return Error{fmt::format("'{}' cannot be read: '{}' does not start: {}", process.file_,
                                 arguments[0], std::strerror(failure))};
    }
    return process;
}

ReaderProcess::ReaderProcess(ReaderProcess&& other) noexcept
    : child_(std::exchange(other.child_, -1)), socket_(std::exchange(other.socket_, -1)),
      file_(std::move(other.file_)), format_(std::move(other.format_)), seconds_(other.seconds_),
      deadline_(other.deadline_) {}

ReaderProcess::~ReaderProcess() { stop(); }

int ReaderProcess::stop() {
    if (socket_ >= 0) ::close(std::exchange(socket_, -1));
    if (child_ < 0) return -1;
    const pid_t child = std::exchange(child_, -1);
    ::kill(child, SIGKILL); // of no effect on one that has ended by itself
    int status = -1;
    while (::waitpid(child, &status, 0) < 0)
        if (errno != EINTR) return -1;
    return status;
}

Error ReaderProcess::damaged(const std::string& reason) const {
    return Error{fmt::format("'{}' cannot be used: {}", file_, reason)};
}

Error ReaderProcess::explainEnd() {
    // The stream ended. The child has ended or is about to: a moment to do so tells a crash from a kill.
    int status = -1;
    for (int wait = 0; wait < 200 && child_ >= 0; ++wait) {
        const pid_t ended = ::waitpid(child_, &status, WNOHANG);
        if (ended != 0) {
            child_ = -1;
            if (ended < 0) status = -1;
            break;
        }
        ::usleep(10000);
    }
    if (status >= 0 && WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
        return Error{fmt::format("'{}' is damaged or too large: reading it took more than {:.0f} s",
                                 file_, seconds_)};
    if (status >= 0 && WIFSIGNALED(status))
        return Error{fmt::format("'{}' is damaged: the {} reader crashed on it (signal {})", file_,
                                 format_, WTERMSIG(status))};
    return Error{
        fmt::format("'{}' is damaged: the {} reader ended before it was done", file_, format_)};
}

Result<void> ReaderProcess::receiveBytes(void* data, size_t bytes) {
    char* next = static_cast<char*>(data);
    while (bytes > 0) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
                              deadline_ - std::chrono::steady_clock::now())
                              .count();
        pollfd waiting{socket_, POLLIN, 0};
        const int ready =
            left <= 0 ? 0 : ::poll(&waiting, 1, int(std::min<long long>(left, 1 << 30)));
        if (ready < 0 && errno == EINTR) continue;
        if (ready == 0) {
            stop();
            return Error{
                fmt::format("'{}' is damaged or too large: reading it took more than {:.0f} s",
                            file_, seconds_)};
        }
        const ssize_t got = ::recv(socket_, next, bytes, 0);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return explainEnd();
        next += got;
        bytes -= size_t(got);
    }
    return {};
}

Result<ReaderMessage> ReaderProcess::receive() {
    stream::MessageHeader header;
    if (const Result<void> got = receiveBytes(&header, sizeof header); !got) return got.error();
    if (header.magic != stream::kMagic || header.bytes > stream::kMaximumMessageBytes)
        return Error{
            fmt::format("'{}' is damaged: the {} reader lost its way in it", file_, format_)};
    ReaderMessage message{header.type, std::vector<char>(header.bytes)};
    if (const Result<void> got = receiveBytes(message.payload.data(), message.payload.size()); !got)
        return got.error();

    const std::string_view text(message.payload.data(), message.payload.size());
    if (message.type == stream::MessageType::Failure) return damaged(printable(text));
    if (message.type == stream::MessageType::Hello) {
        uint32_t version = 0;
        if (text.size() < sizeof version) return damaged("its reader says nothing sensible");
        std::memcpy(&version, text.data(), sizeof version);
        if (version != stream::kStreamVersion)
            return damaged(fmt::format("{} is of another version of tyndall (it speaks {}, not {})",
                                       kReaderName, version, stream::kStreamVersion));
        format_ = printable(text.substr(sizeof version));
        format_ = format_.substr(0, format_.find(' ')); // without the file version
    }
    return message;
}

Result<void> ReaderProcess::send(stream::CommandType type, uint32_t grid) {
    const stream::Command command{stream::kMagic, type, grid};
    // Smaller than any socket's buffer, so that it is sent whole or not at all.
    if (::send(socket_, &command, sizeof command, MSG_NOSIGNAL) != ssize_t(sizeof command))
        return explainEnd();
    return {};
}

} // namespace tyndall
