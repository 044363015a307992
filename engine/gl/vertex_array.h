#pragma once
// How vertices lie in buffers.

#include <span>
#include <string_view>

#include "gl/object.h"

namespace tyndall::gl {

/// One vertex attribute inside a buffer.
struct VertexAttribute {
    GLuint location = 0;
    GLint components = 3;
    GLenum type = GL_FLOAT;
    GLboolean normalised = GL_FALSE;
    GLuint buffer = 0;    // GL name
    uint64_t offset = 0;  // bytes of the first vertex
    GLsizei stride = 0;   // bytes between vertices
    GLuint divisor = 0;   // 1: one value an instance
    bool integer = false; // the shader has an int or uint
};

/// Attributes and an index buffer. Keeps names, not buffers: they must live as long. Empty when moved from.
class VertexArray {
public:
    VertexArray() = default;
    /// `indices`: GL name of the buffer of indices, 0 for none.
    VertexArray(std::string_view name, std::span<const VertexAttribute> attributes,
                GLuint indices = 0);

    [[nodiscard]] GLuint id() const { return object_.id(); }
    explicit operator bool() const { return bool(object_); }

private:
    Object object_;
};

} // namespace tyndall::gl
