#include "gl/object.h"

#include <fmt/format.h>

#include <utility>

#include "core/log.h"
#include "gl/context_state.h"

namespace tyndall::gl {
namespace {

GLenum labelIdentifier(ObjectKind kind) {
    switch (kind) {
    case ObjectKind::Buffer: return GL_BUFFER;
    case ObjectKind::Texture: return GL_TEXTURE;
    case ObjectKind::Sampler: return GL_SAMPLER;
    case ObjectKind::Framebuffer: return GL_FRAMEBUFFER;
    case ObjectKind::VertexArray: return GL_VERTEX_ARRAY;
    case ObjectKind::Program: return GL_PROGRAM;
    case ObjectKind::Query: return GL_QUERY;
    case ObjectKind::Fence: break;
    }
    return GL_NONE;
}

void deleteName(ObjectKind kind, GLuint id) {
    switch (kind) {
    case ObjectKind::Buffer: glDeleteBuffers(1, &id); break;
    case ObjectKind::Texture: glDeleteTextures(1, &id); break;
    case ObjectKind::Sampler: glDeleteSamplers(1, &id); break;
    case ObjectKind::Framebuffer: glDeleteFramebuffers(1, &id); break;
    case ObjectKind::VertexArray: glDeleteVertexArrays(1, &id); break;
    case ObjectKind::Program: glDeleteProgram(id); break;
    case ObjectKind::Query: glDeleteQueries(1, &id); break;
    case ObjectKind::Fence: break;
    }
}

Context::State& stateForCreation() {
    Context::State* state = currentState();
    CHECK(state != nullptr, "a GL object needs a current context");
    return *state;
}

} // namespace

const char* objectKindName(ObjectKind kind) {
    static constexpr const char* kNames[kObjectKindCount] = {
        "buffer", "texture", "sampler", "framebuffer", "vertex array", "program", "query", "fence"};
    return kNames[size_t(kind)];
}

int64_t LiveObjects::total() const {
    int64_t sum = 0;
    for (int64_t count : counts) sum += count;
    return sum;
}

std::string LiveObjects::describe() const {
    std::string text;
    for (size_t i = 0; i < kObjectKindCount; ++i) {
        if (counts[i] == 0) continue;
        if (!text.empty()) text += ", ";
        const std::string_view name = objectKindName(ObjectKind(i));
        const bool queries = ObjectKind(i) == ObjectKind::Query;
        text += counts[i] == 1 ? fmt::format("1 {}", name)
                : queries      ? fmt::format("{} queries", counts[i])
                               : fmt::format("{} {}s", counts[i], name);
    }
    return text.empty() ? "none" : text;
}

Object::Object(ObjectKind kind, GLuint name, int64_t bytes)
    : kind_(kind), id_(name), bytes_(bytes) {
    if (name == 0) return;
    Context::State& state = stateForCreation();
    context_ = state.serial;
    ++state.live.counts[size_t(kind)];
    state.live.bytes += bytes;
}

Object::Object(Object&& other) noexcept
    : kind_(other.kind_), id_(std::exchange(other.id_, 0)),
      context_(std::exchange(other.context_, 0)), bytes_(std::exchange(other.bytes_, 0)) {}

Object& Object::operator=(Object&& other) noexcept {
    if (this == &other) return *this;
    reset();
    kind_ = other.kind_;
    id_ = std::exchange(other.id_, 0);
    context_ = std::exchange(other.context_, 0);
    bytes_ = std::exchange(other.bytes_, 0);
    return *this;
}

Object::~Object() { reset(); }

void Object::reset() {
    if (id_ == 0) return;
    if (Context::State* state = currentState(); state != nullptr && state->serial == context_) {
        deleteName(kind_, id_);
        --state->live.counts[size_t(kind_)];
        state->live.bytes -= bytes_;
    } else if (contextExists(context_)) {
        log::error(fmt::format(
            "a {} was released while its GL context was not current; it stays until the context goes",
            objectKindName(kind_)));
    }
    id_ = 0;
    context_ = 0;
    bytes_ = 0;
}

void Object::label(std::string_view name) const {
    if (id_ == 0) return;
    const GLenum identifier = labelIdentifier(kind_);
    if (identifier == GL_NONE) return;
    const auto length =
        std::min<size_t>(name.size(), size_t(currentCapabilities().limits.labelLength) - 1);
    glObjectLabel(identifier, id_, GLsizei(length), name.data());
}

Fence Fence::insert() {
    Context::State& state = stateForCreation();
    Fence fence;
    fence.sync_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    fence.context_ = state.serial;
    ++state.live.counts[size_t(ObjectKind::Fence)];
    return fence;
}

Fence::Fence(Fence&& other) noexcept
    : sync_(std::exchange(other.sync_, nullptr)), context_(std::exchange(other.context_, 0)) {}

Fence& Fence::operator=(Fence&& other) noexcept {
    if (this == &other) return *this;
    reset();
    sync_ = std::exchange(other.sync_, nullptr);
    context_ = std::exchange(other.context_, 0);
    return *this;
}

Fence::~Fence() { reset(); }

void Fence::reset() {
    if (sync_ == nullptr) return;
    if (Context::State* state = currentState(); state != nullptr && state->serial == context_) {
        glDeleteSync(sync_);
        --state->live.counts[size_t(ObjectKind::Fence)];
    }
    sync_ = nullptr;
    context_ = 0;
}

bool Fence::passed() const {
    if (sync_ == nullptr) return true;
    // The flush bit only matters the first time: without it a fence that was never sent to the GPU would never pass.
    const GLenum status = glClientWaitSync(sync_, GL_SYNC_FLUSH_COMMANDS_BIT, 0);
    return status == GL_ALREADY_SIGNALED || status == GL_CONDITION_SATISFIED;
}

void Fence::wait() const {
    if (sync_ == nullptr) return;
    constexpr GLuint64 kSecond = 1'000'000'000;
    while (true) {
        const GLenum status = glClientWaitSync(sync_, GL_SYNC_FLUSH_COMMANDS_BIT, kSecond);
        CHECK(status != GL_WAIT_FAILED, "waiting for a GL fence failed: the context was lost");
        if (status != GL_TIMEOUT_EXPIRED) return;
    }
}

} // namespace tyndall::gl
