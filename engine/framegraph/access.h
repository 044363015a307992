#pragma once
// How a pass touches a resource. The barrier before a pass follows from the accesses of the pass
// and of the last writer, by one table (access.cpp).

#include <cstdint>

namespace tyndall::fg {

enum class Access : uint32_t {
    // reads
    Sampled = 0,      // texture unit, any stage
    StorageRead = 1,  // image or shader storage, read only
    Uniform = 2,      // uniform buffer
    Indirect = 3,     // draw or dispatch arguments
    Vertex = 4,       // vertex attributes or indices
    TransferRead = 5, // copy source, read-back
    DepthRead = 6,    // depth test without writes; may be Sampled in the same pass
    // writes
    StorageWrite = 7, // image or shader storage; old content is kept where it is not written
    ColorTarget = 8,
    DepthTarget = 9,
    TransferWrite = 10, // copy destination, clear
    Capture = 11,       // transform feedback, and the number of what it wrote
};

bool isWrite(Access access);
const char* accessName(Access access);
/// The GL barrier bits, as a plain number, that `next` needs after `previous` on the same storage; 0 where GL orders them itself.
/// Only shader writes to images and storage buffers are incoherent (OpenGL 4.5, section 7.12.2): what follows them must
/// see them, and they themselves must wait for earlier reads and writes.
uint32_t barrierBits(Access previous, Access next, bool isBuffer);

} // namespace tyndall::fg
