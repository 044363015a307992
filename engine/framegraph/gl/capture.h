#pragma once
// Transform feedback of one raster command: its draws append to a buffer, and their number lands in another without a read-back.

#include <cstdint>
#include <optional>

#include "gl/buffer.h"
#include "gl/object.h"

namespace tyndall::fg {

class Capture {
public:
    /// The next draws capture into `bytes` of `into`, from `firstByte` on. The number of primitives goes to `count`, unless null, at `countOffset`.
    void aim(const gl::Buffer& into, uint64_t firstByte, uint64_t bytes, const gl::Buffer* count,
             uint64_t countOffset);
    [[nodiscard]] bool isAimed() const { return into_ != 0; }
    /// Before a draw that makes `primitives` (GL_POINTS, GL_LINES or GL_TRIANGLES). CHECKs that draws of one command make one kind.
    void begin(GLenum primitives);
    /// Ends capturing, if there was any, and writes the count: 0 where nothing was drawn. Aims at nothing afterwards.
    void end();

private:
    gl::Object query_; // made when first needed
    GLuint into_ = 0, count_ = 0;
    uint64_t countOffset_ = 0;
    std::optional<GLenum> primitives_; // nothing: no draw yet
};

} // namespace tyndall::fg
