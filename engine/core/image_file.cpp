// Whole files in and out. A file is written beside its final name and renamed, so that a full disk or an interruption
// leaves the last good one.

#include "core/image.h"

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

#include <fmt/format.h>

namespace tyndall {
namespace fs = std::filesystem;
namespace {

/// A file descriptor that closes itself.
class Descriptor {
public:
    explicit Descriptor(int fd) : fd_(fd) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() {
        if (fd_ >= 0) ::close(fd_);
    }
    [[nodiscard]] int get() const { return fd_; }
    /// Closes and reports what the system held back until now (network file systems do).
    [[nodiscard]] bool closeNow() { return ::close(std::exchange(fd_, -1)) == 0; }

private:
    int fd_;
};

Error systemError(std::string_view what, const fs::path& path, int code) {
    return Error{fmt::format("{} '{}': {}", what, path.string(), std::strerror(code))};
}

bool writeAll(int fd, std::string_view content) {
    while (!content.empty()) {
        const ssize_t written = ::write(fd, content.data(), content.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        content.remove_prefix(size_t(written));
    }
    return true;
}

Result<void> writeThrough(const fs::path& path, int flags, std::string_view content) {
    Descriptor file(::open(path.c_str(), flags | O_WRONLY | O_CLOEXEC, 0666));
    if (file.get() < 0) return systemError("cannot write", path, errno);
    if (!writeAll(file.get(), content)) return systemError("cannot write all of", path, errno);
    // Pipes and devices cannot be synchronised (EINVAL); for a file the rename must not overtake its content.
    if (::fsync(file.get()) != 0 && errno != EINVAL && errno != EROFS)
        return systemError("cannot write all of", path, errno);
    if (!file.closeNow()) return systemError("cannot write all of", path, errno);
    return {};
}

/// Unique in the folder: two programs, or two threads of one, may write the same output at once. Short, since the target's name
/// may be as long as a name can be.
fs::path temporaryNameBeside(const fs::path& target) {
    static std::atomic<unsigned> counter{0};
    return target.parent_path() /
           fmt::format(".tyndall-{}-{}.tmp", ::getpid(), counter.fetch_add(1));
}

} // namespace

std::string lowerExtension(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

Result<void> writeFileAtomically(const fs::path& path, std::string_view content) {
    if (path.empty() || path.filename().empty())
        return Error{fmt::format("cannot write '{}': that is not a file name", path.string())};
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (fs::is_directory(status)) return systemError("cannot write", path, EISDIR);
    if (fs::exists(status) && !fs::is_regular_file(status))
        return writeThrough(path, 0, content); // /dev/stdout, a pipe
    // Through a symbolic link it is the target that is replaced, as with an ordinary write.
    const fs::path target = fs::exists(status) ? fs::canonical(path, error) : path;
    if (error && fs::exists(status))
        return Error{fmt::format("cannot write '{}': {}", path.string(), error.message())};
    // The folder decides about a rename; a file that its owner write-protected stays.
    if (fs::exists(status) && ::access(target.c_str(), W_OK) != 0)
        return systemError("cannot write", path, errno);

    fs::path temporary = temporaryNameBeside(target);
    while (fs::exists(fs::symlink_status(temporary, error))) // left by a process that was killed
        temporary = temporaryNameBeside(target);
    Result<void> written = writeThrough(temporary, O_CREAT | O_EXCL, content);
    if (written.ok() && ::rename(temporary.c_str(), target.c_str()) != 0)
        written = systemError("cannot write", path, errno);
    if (!written.ok()) {
        ::unlink(temporary.c_str());
        std::string message = written.message();
        if (const size_t at = message.find(temporary.string()); at != std::string::npos)
            message.replace(at, temporary.string().size(), path.string());
        return Error{message};
    }
    return {};
}

Result<std::string> readFile(const fs::path& path, size_t maxBytes) {
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (file.get() < 0) return systemError("cannot read", path, errno);
    struct stat information {};
    if (::fstat(file.get(), &information) != 0) return systemError("cannot read", path, errno);
    if (S_ISDIR(information.st_mode)) return systemError("cannot read", path, EISDIR);
    if (information.st_size > 0 && size_t(information.st_size) > maxBytes)
        return Error{fmt::format("'{}' has {} bytes: at most {} are read", path.string(),
                                 information.st_size, maxBytes)};

    std::string content;
    content.reserve(size_t(information.st_size)); // 0 for pipes, which grow the string as they come
    for (;;) {
        const size_t have = content.size();
        content.resize(have + (size_t(information.st_size) > have
                                   ? size_t(information.st_size) - have
                                   : size_t(65536)));
        const ssize_t got = ::read(file.get(), content.data() + have, content.size() - have);
        if (got < 0 && errno != EINTR) return systemError("cannot read", path, errno);
        content.resize(have + size_t(std::max<ssize_t>(got, 0)));
        if (got == 0) return content;
        if (content.size() > maxBytes)
            return Error{fmt::format("'{}' has more than {} bytes, which is all that is read",
                                     path.string(), maxBytes)};
    }
}

} // namespace tyndall
