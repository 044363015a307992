#include "programs/process.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include "support/content.h"

namespace tyndall::test {
namespace {

using Clock = std::chrono::steady_clock;

std::vector<char*> pointers(const std::vector<std::string>& texts) {
    std::vector<char*> result;
    for (const std::string& text : texts) result.push_back(const_cast<char*>(text.c_str()));
    result.push_back(nullptr);
    return result;
}

/// The child's side: between fork and exec only calls that are safe in a process with threads.
[[noreturn]] void becomeProgram(char** arguments, char** environment, const char* folder, int out,
                                int err) {
    if (*folder && ::chdir(folder) != 0) ::_exit(126);
    const int nothing = ::open("/dev/null", O_RDONLY);
    ::dup2(nothing, STDIN_FILENO);
    ::dup2(out, STDOUT_FILENO);
    ::dup2(err, STDERR_FILENO);
    ::execve(arguments[0], arguments, environment);
    ::_exit(127);
}

/// Reads what there is; false at the end of the pipe.
bool drain(int fd, std::string& text) {
    char buffer[65536];
    const ssize_t got = ::read(fd, buffer, sizeof buffer);
    if (got > 0) text.append(buffer, size_t(got));
    return got > 0 || (got < 0 && errno == EINTR);
}

/// Collects both streams until they end; signals the process when its time comes.
void attend(pid_t process, int out, int err, const ProcessOptions& options, Clock::time_point start,
            ProcessResult& result) {
    pollfd streams[2] = {{out, POLLIN, 0}, {err, POLLIN, 0}};
    bool interruptSent = options.interruptAfterSeconds <= 0;
    while (streams[0].fd >= 0 || streams[1].fd >= 0) {
        const double elapsed = std::chrono::duration<double>(Clock::now() - start).count();
        if (!interruptSent && elapsed >= options.interruptAfterSeconds) {
            ::kill(process, SIGINT);
            interruptSent = true;
        }
        if (elapsed > options.timeoutSeconds) {
            result.timedOut = true;
            ::kill(process, SIGKILL);
            return;
        }
        if (::poll(streams, 2, 20) <= 0) continue;
        if (streams[0].revents && !drain(out, result.out)) streams[0].fd = -1;
        if (streams[1].revents && !drain(err, result.err)) streams[1].fd = -1;
    }
}

} // namespace

ProcessResult run(const std::vector<std::string>& arguments, const ProcessOptions& options) {
    ProcessResult result;
    int out[2], err[2];
    if (::pipe2(out, O_CLOEXEC) != 0 || ::pipe2(err, O_CLOEXEC) != 0) {
        result.err = std::string("no pipe: ") + std::strerror(errno);
        return result;
    }
    const std::vector<char*> argv = pointers(arguments);
    const std::vector<std::string> environment =
        options.environment.value_or(std::vector<std::string>()); // the pointers are into it
    const std::vector<char*> envp = pointers(environment);
    const std::string folder = options.folder.string();
    const Clock::time_point start = Clock::now();
    const pid_t process = ::fork();
    if (process == 0)
        becomeProgram(const_cast<char**>(argv.data()),
                      options.environment ? const_cast<char**>(envp.data()) : environ,
                      folder.c_str(), out[1], err[1]);
    ::close(out[1]);
    ::close(err[1]);
    int status = 0;
    if (process > 0) {
        attend(process, out[0], err[0], options, start, result);
        while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
        }
        if (WIFEXITED(status)) result.status = WEXITSTATUS(status);
        if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
    }
    ::close(out[0]);
    ::close(err[0]);
    result.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    return result;
}

ProcessResult tyndall(std::vector<std::string> arguments, const ProcessOptions& options) {
    arguments.insert(arguments.begin(), (binDir() / "tyndall").string());
    return run(arguments, options);
}

bool endedByItself(const ProcessResult& result, std::string& why) {
    if (result.timedOut)
        why = "it hung";
    else if (result.signal)
        why = std::string("signal ") + strsignal(result.signal);
    else if (result.err.find("Sanitizer") != std::string::npos ||
             result.err.find("runtime error:") != std::string::npos)
        why = "a sanitizer's report: " + result.err;
    else
        return true;
    return false;
}

} // namespace tyndall::test
