#include "framegraph/access.h"

#include <iterator>

#include "core/check.h"

namespace tyndall::fg {
namespace {

// Values of the GL enumerants (OpenGL 4.5 core, section 7.12.2); the graph itself does not include GL.
constexpr uint32_t kVertexAttribArray = 0x1;
constexpr uint32_t kElementArray = 0x2;
constexpr uint32_t kUniform = 0x4;
constexpr uint32_t kTextureFetch = 0x8;
constexpr uint32_t kShaderImageAccess = 0x20;
constexpr uint32_t kCommand = 0x40;
constexpr uint32_t kTextureUpdate = 0x100;
constexpr uint32_t kBufferUpdate = 0x200;
constexpr uint32_t kFramebuffer = 0x400;
constexpr uint32_t kTransformFeedback = 0x800;
constexpr uint32_t kShaderStorage = 0x2000;
constexpr uint32_t kQueryBuffer = 0x8000;

struct AccessInfo {
    const char* name;
    bool write;
    uint32_t textureBits, bufferBits; // what this access needs after a shader's write
};

constexpr AccessInfo kAccesses[] = {
    {"sampled", false, kTextureFetch, kTextureFetch},
    {"storage read", false, kShaderImageAccess, kShaderStorage},
    {"uniform", false, kUniform, kUniform},
    {"indirect", false, kCommand, kCommand},
    {"vertex", false, kVertexAttribArray | kElementArray, kVertexAttribArray | kElementArray},
    {"transfer read", false, kTextureUpdate, kBufferUpdate},
    {"depth read", false, kFramebuffer, 0},
    {"storage write", true, kShaderImageAccess, kShaderStorage},
    {"color target", true, kFramebuffer, 0},
    {"depth target", true, kFramebuffer, 0},
    {"transfer write", true, kTextureUpdate, kBufferUpdate},
    {"capture", true, 0, kTransformFeedback | kQueryBuffer},
};

const AccessInfo& info(Access access) {
    CHECK(size_t(access) < std::size(kAccesses), "not an access");
    return kAccesses[size_t(access)];
}

} // namespace

bool isWrite(Access access) { return info(access).write; }
const char* accessName(Access access) { return info(access).name; }

uint32_t barrierBits(Access previous, Access next, bool isBuffer) {
    const bool incoherent = previous == Access::StorageWrite || next == Access::StorageWrite;
    if (!incoherent) return 0;
    return isBuffer ? info(next).bufferBits : info(next).textureBits;
}

} // namespace tyndall::fg
