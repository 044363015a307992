#pragma once
// Typed, versioned handles. A handle names a resource *and* the write that produced its content, so a
// pass that holds an old handle reads what it meant to read, or is told that it no longer can.

#include <cstdint>

namespace tyndall::fg {

struct TextureHandle {
    uint32_t resource = 0; // 0: no resource
    uint32_t version = 0;  // counts the writes since creation or import
    explicit operator bool() const { return resource != 0; }
    bool operator==(const TextureHandle&) const = default;
};

struct BufferHandle {
    uint32_t resource = 0;
    uint32_t version = 0;
    explicit operator bool() const { return resource != 0; }
    bool operator==(const BufferHandle&) const = default;
};

/// Immutable things that live longer than a frame and need no ordering: material textures, meshes,
/// tables. Registered once with the executor; 0: none.
struct StaticTexture {
    uint32_t id = 0;
};
struct StaticBuffer {
    uint32_t id = 0;
};
struct StaticGeometry {
    uint32_t id = 0;
};

} // namespace tyndall::fg
