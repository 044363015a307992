#include "gl/debug.h"

#include <fmt/format.h>

#include <mutex>

#include "core/log.h"

namespace tyndall::gl {
namespace {

// Every row with its reason. What is of high severity is never dropped, but for the compiler's messages: those come
// back from the compilation itself, with files and lines (Program::build, Program::warnings).
constexpr HarmlessMessage kHarmless[] = {
    {"", GL_DEBUG_SOURCE_APPLICATION, GL_DEBUG_TYPE_PUSH_GROUP, 0, "", "our own debug group opens"},
    {"", GL_DEBUG_SOURCE_APPLICATION, GL_DEBUG_TYPE_POP_GROUP, 0, "", "our own debug group closes"},
    {"NVIDIA", GL_DEBUG_SOURCE_API, GL_DEBUG_TYPE_OTHER, 131185, "",
     "tells in which memory a buffer lies"},
    {"NVIDIA", GL_DEBUG_SOURCE_API, GL_DEBUG_TYPE_OTHER, 131169, "",
     "tells how a framebuffer is stored"},
    {"NVIDIA", GL_DEBUG_SOURCE_API, GL_DEBUG_TYPE_OTHER, 131204, "",
     "a unit holds a texture without the mips that its sampler filters; no program reads it"},
    {"NVIDIA", GL_DEBUG_SOURCE_API, GL_DEBUG_TYPE_PERFORMANCE, 131154, "",
     "a read-back waits for the drawing before it, which is what a read-back is for"},
    {"NVIDIA", GL_DEBUG_SOURCE_API, GL_DEBUG_TYPE_PERFORMANCE, 131186, "",
     "a buffer that is read back moves to the host"},
    {"NVIDIA", GL_DEBUG_SOURCE_API, GL_DEBUG_TYPE_PERFORMANCE, 131218, "",
     "a program is compiled again for the state of its first draw"},
    {"", GL_DEBUG_SOURCE_SHADER_COMPILER, GL_DONT_CARE, 0, "",
     "errors and warnings of a shader are returned by its compilation, and statistics of the compiler mean nothing"},
};

constexpr size_t kKeptMessages = 64;

/// The debug groups that are open on this thread, outermost first: a synchronous message belongs to them.
std::vector<std::string>& openGroups() {
    thread_local std::vector<std::string> groups;
    return groups;
}

Severity severityOf(GLenum severity) {
    switch (severity) {
    case GL_DEBUG_SEVERITY_HIGH: return Severity::High;
    case GL_DEBUG_SEVERITY_MEDIUM: return Severity::Medium;
    case GL_DEBUG_SEVERITY_LOW: return Severity::Low;
    default: return Severity::Notification;
    }
}

const char* typeName(GLenum type) {
    switch (type) {
    case GL_DEBUG_TYPE_ERROR: return "error";
    case GL_DEBUG_TYPE_DEPRECATED_BEHAVIOR: return "deprecated";
    case GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR: return "undefined behaviour";
    case GL_DEBUG_TYPE_PORTABILITY: return "portability";
    case GL_DEBUG_TYPE_PERFORMANCE: return "performance";
    case GL_DEBUG_TYPE_MARKER: return "marker";
    default: return "message";
    }
}

bool isHarmless(std::string_view driver, GLenum source, GLenum type, GLuint id,
                std::string_view text) {
    for (const HarmlessMessage& row : kHarmless) {
        if (driver.find(row.vendor) == std::string_view::npos) continue;
        if (row.source != GL_DONT_CARE && row.source != source) continue;
        if (row.type != GL_DONT_CARE && row.type != type) continue;
        if (row.id != 0 && row.id != id) continue;
        if (text.find(row.text) != std::string_view::npos) return true;
    }
    return false;
}

void report(Severity severity, const std::string& sentence) {
    switch (severity) {
    case Severity::High: log::warningOnce(sentence, sentence); break;
    case Severity::Medium: log::warningOnce(sentence, sentence); break;
    case Severity::Low: log::debug(sentence); break;
    case Severity::Notification: log::debug(sentence); break;
    }
}

} // namespace

struct DebugLog::State {
    mutable std::mutex mutex;
    std::string driver;
    std::array<uint64_t, 4> counts{};
    uint64_t dropped = 0;
    std::vector<std::string> high;

    void receive(GLenum source, GLenum type, GLuint id, GLenum glSeverity, std::string_view text) {
        const Severity severity = severityOf(glSeverity);
        std::string place;
        for (const std::string& group : openGroups()) place += (place.empty() ? "" : " > ") + group;
        while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.remove_suffix(1);
        const std::string sentence = fmt::format("GL {} {}{}{}: {}", typeName(type), id,
                                                 place.empty() ? "" : " in ", place, text);
        {
            std::lock_guard lock(mutex);
            const bool mayDrop =
                severity != Severity::High || source == GL_DEBUG_SOURCE_SHADER_COMPILER;
            if (mayDrop && isHarmless(driver, source, type, id, text)) {
                ++dropped;
                return;
            }
            ++counts[size_t(severity)];
            if (severity == Severity::High && high.size() < kKeptMessages) high.push_back(sentence);
        }
        report(severity, sentence);
    }
};

namespace {
void GLAD_API_PTR onMessage(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length,
                            const GLchar* message, const void* state) {
    const std::string_view text =
        length >= 0 ? std::string_view(message, size_t(length)) : std::string_view(message);
    static_cast<DebugLog::State*>(const_cast<void*>(state))
        ->receive(source, type, id, severity, text);
}
} // namespace

const char* severityName(Severity severity) {
    static constexpr const char* kNames[] = {"notification", "low", "medium", "high"};
    return kNames[size_t(severity)];
}

std::span<const HarmlessMessage> harmlessMessages() { return kHarmless; }

DebugLog::DebugLog() : state_(std::make_unique<State>()) {}
DebugLog::~DebugLog() = default;
DebugLog::DebugLog(DebugLog&&) noexcept = default;
DebugLog& DebugLog::operator=(DebugLog&&) noexcept = default;

uint64_t DebugLog::count(Severity severity) const {
    std::lock_guard lock(state_->mutex);
    return state_->counts[size_t(severity)];
}

uint64_t DebugLog::dropped() const {
    std::lock_guard lock(state_->mutex);
    return state_->dropped;
}

std::vector<std::string> DebugLog::highSeverityMessages() const {
    std::lock_guard lock(state_->mutex);
    return state_->high;
}

void DebugLog::reset() {
    std::lock_guard lock(state_->mutex);
    state_->counts = {};
    state_->dropped = 0;
    state_->high.clear();
}

void DebugLog::install(std::string driver, bool synchronous) {
    state_->driver = std::move(driver);
    glEnable(GL_DEBUG_OUTPUT);
    if (synchronous)
        glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    else
        glDisable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DONT_CARE, 0, nullptr, GL_TRUE);
    glDebugMessageCallback(onMessage, state_.get());
}

DebugGroup::DebugGroup(std::string_view name) {
    openGroups().emplace_back(name);
    glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, GLsizei(name.size()), name.data());
}

DebugGroup::~DebugGroup() {
    glPopDebugGroup();
    openGroups().pop_back();
}

} // namespace tyndall::gl
