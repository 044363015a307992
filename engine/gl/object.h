#pragma once
// Ownership of GL names, and a count of those that are alive, so that a leak can be reported.

#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include "gl/api.h"

namespace tyndall::gl {

/// Thrown where storage is made in the middle of a frame: the driver has no room for it, or takes no such size. The renderer makes
/// an Error of it. what() is a sentence.
struct NoRoom : std::runtime_error {
    using std::runtime_error::runtime_error;
};

enum class ObjectKind : uint32_t {
    Buffer = 0,
    Texture = 1,
    Sampler = 2,
    Framebuffer = 3,
    VertexArray = 4,
    Program = 5,
    Query = 6,
    Fence = 7,
};
inline constexpr size_t kObjectKindCount = 8;

/// "buffer", "texture" …
const char* objectKindName(ObjectKind kind);

/// What one context has alive.
struct LiveObjects {
    std::array<int64_t, kObjectKindCount> counts{};
    int64_t bytes = 0; // of buffer and texture storage, without the driver's padding

    [[nodiscard]] int64_t count(ObjectKind kind) const { return counts[size_t(kind)]; }
    [[nodiscard]] int64_t total() const;
    /// "2 textures, 1 program", or "none".
    [[nodiscard]] std::string describe() const;
};

/// One GL name, made in the current context and deleted with the owner; empty when moved from. Deleting needs the same
/// context to be current: a name whose context is gone went with it, and one whose context is merely not current is
/// left alone and logged.
class Object {
public:
    Object() = default;
    /// Takes over `name`, which belongs to the current context; 0 makes an empty owner.
    Object(ObjectKind kind, GLuint name, int64_t bytes = 0);
    Object(Object&& other) noexcept;
    Object& operator=(Object&& other) noexcept;
    Object(const Object&) = delete;
    Object& operator=(const Object&) = delete;
    ~Object();

    [[nodiscard]] GLuint id() const { return id_; }
    [[nodiscard]] int64_t bytes() const { return bytes_; }
    explicit operator bool() const { return id_ != 0; }
    void reset();
    /// Names the object for debuggers and for the driver's messages. Fences have no name of this kind and ignore it.
    void label(std::string_view name) const;

private:
    ObjectKind kind_ = ObjectKind::Buffer;
    GLuint id_ = 0;
    uint64_t context_ = 0;
    int64_t bytes_ = 0;
};

/// A point in the stream of commands of the current context; empty when moved from.
class Fence {
public:
    Fence() = default;
    /// A fence after everything recorded so far.
    static Fence insert();
    Fence(Fence&& other) noexcept;
    Fence& operator=(Fence&& other) noexcept;
    Fence(const Fence&) = delete;
    Fence& operator=(const Fence&) = delete;
    ~Fence();

    explicit operator bool() const { return sync_ != nullptr; }
    /// True once the GPU has passed it; never waits. An empty fence is passed.
    [[nodiscard]] bool passed() const;
    /// Returns when the GPU has passed it.
    void wait() const;
    void reset();

private:
    GLsync sync_ = nullptr;
    uint64_t context_ = 0;
};

} // namespace tyndall::gl
