#include "framegraph/gl/capture.h"

#include "core/check.h"

namespace tyndall::fg {

void Capture::aim(const gl::Buffer& into, uint64_t firstByte, uint64_t bytes,
                  const gl::Buffer* count, uint64_t countOffset) {
    end();
    into_ = into.id();
    count_ = count ? count->id() : 0;
    countOffset_ = countOffset;
    // GL wants whole words (OpenGL 4.5, section 13.2.1).
    glBindBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, into_, GLintptr(firstByte),
                      GLsizeiptr(bytes / 4 * 4));
}

void Capture::begin(GLenum primitives) {
    CHECK(
        !primitives_ || primitives_ == primitives,
        "one capture takes either points, lines or triangles: capture() again before another kind is drawn");
    if (primitives_) return;
    primitives_ = primitives;
    if (count_ != 0) {
        if (!query_) {
            GLuint id = 0;
            glCreateQueries(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, 1, &id);
            query_ = gl::Object(gl::ObjectKind::Query, id);
            query_.label("captured primitives");
        }
        glBeginQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, query_.id());
    }
    glBeginTransformFeedback(primitives);
}

void Capture::end() {
    if (into_ == 0) return;
    if (primitives_) {
        glEndTransformFeedback();
        if (count_ != 0) {
            glEndQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN);
            glGetQueryBufferObjectuiv(query_.id(), count_, GL_QUERY_RESULT, GLintptr(countOffset_));
        }
    } else if (count_ != 0) {
        glClearNamedBufferSubData(count_, GL_R32UI, GLintptr(countOffset_), 4, GL_RED_INTEGER,
                                  GL_UNSIGNED_INT, nullptr); // zeros
    }
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
    into_ = count_ = 0;
    primitives_.reset();
}

} // namespace tyndall::fg
