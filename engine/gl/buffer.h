#pragma once
// Buffers of immutable storage, and a ring of mapped memory for what changes every frame.

#include <cstddef>
#include <deque>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "gl/object.h"

namespace tyndall::gl {

/// Where a buffer's content comes from.
enum class BufferAccess : uint32_t {
    GpuOnly = 0,   // written by the GPU, by copies and clears; content at creation is allowed
    CpuUpdates = 1 // write() is allowed as well
};

/// A block of GPU memory of fixed size. Empty when moved from.
class Buffer {
public:
    Buffer() = default;
    /// Undefined content. CHECKs what create() reports.
    Buffer(std::string_view name, uint64_t bytes, BufferAccess access = BufferAccess::GpuOnly);
    /// A copy of `data`.
    Buffer(std::string_view name, std::span<const std::byte> data,
           BufferAccess access = BufferAccess::GpuOnly);
    /// `data` may be null. Errors: the driver has no room for so many bytes. CHECKs: bytes > 0.
    static Result<Buffer> create(std::string_view name, uint64_t bytes,
                                 BufferAccess access = BufferAccess::GpuOnly,
                                 const void* data = nullptr);

    [[nodiscard]] GLuint id() const { return object_.id(); }
    [[nodiscard]] uint64_t bytes() const { return uint64_t(object_.bytes()); }
    explicit operator bool() const { return bool(object_); }

    /// Copies `data` to `offset` (bytes). The driver orders it after the commands before. CHECKs: CpuUpdates, inside
    /// the buffer.
    void write(uint64_t offset, const void* data, uint64_t bytes);
    /// Copies from `source`, GPU to GPU.
    void copyFrom(GLuint source, uint64_t sourceOffset, uint64_t offset, uint64_t bytes);
    /// Fills the whole buffer with one 32-bit value; its size must be a multiple of 4.
    void clear(uint32_t value = 0);
    /// Waits for the GPU and copies to `data`: for tests and ends of captures.
    void read(uint64_t offset, void* data, uint64_t bytes) const;
    template <typename T> [[nodiscard]] std::vector<T> readAll() const {
        std::vector<T> values(size_t(bytes()) / sizeof(T));
        read(0, values.data(), values.size() * sizeof(T));
        return values;
    }

private:
    Object object_;
    BufferAccess access_ = BufferAccess::GpuOnly;
};

/// Memory that CPU and GPU share, handed out in order and taken back when the GPU has passed it: uniform blocks and
/// uploads of a frame. Grows when a frame needs more than there is; waits only when the GPU is further behind than the
/// ring is long.
class UploadRing {
public:
    /// A piece of the ring, to be written before the next GL command reads it. Valid until the end of the frame.
    struct Slice {
        GLuint buffer = 0;
        uint64_t offset = 0; // bytes
        std::byte* data = nullptr;
    };
    struct Statistics {
        uint64_t wraps = 0; // times that allocation went back to the start
        uint64_t waits = 0; // times that the CPU waited for the GPU
        uint64_t grown = 0; // times that a larger buffer was made
    };

    UploadRing() = default;
    /// CHECKs: bytes > 0.
    UploadRing(std::string_view name, uint64_t bytes);

    /// `bytes` of memory whose offset is a multiple of `alignment` (a power of two).
    Slice allocate(uint64_t bytes, uint64_t alignment);
    /// As allocate(), filled with `data`.
    Slice upload(const void* data, uint64_t bytes, uint64_t alignment);
    /// Everything allocated since the last call belongs to the frame that ends here.
    void endFrame();

    [[nodiscard]] uint64_t capacity() const { return capacity_; }
    [[nodiscard]] const Statistics& statistics() const { return statistics_; }

private:
    struct Frame {
        Fence fence;
        uint64_t end = 0; // of the ring, counted without wrapping
    };
    struct Retired {
        Object object;
        uint64_t frame = 0; // the last that may read it
    };
    void map(uint64_t bytes);
    void grow(uint64_t bytes);
    bool makeRoom(uint64_t end);
    void freePassed();

    std::string name_;
    Object object_;
    std::byte* memory_ = nullptr;
    uint64_t capacity_ = 0;
    uint64_t head_ =
        0; // both grow without wrapping; the position in memory is the rest modulo capacity_
    uint64_t tail_ = 0;
    uint64_t frame_ = 0;       // being recorded
    uint64_t oldestFrame_ = 0; // of frames_
    std::deque<Frame> frames_;
    std::vector<Retired> retired_;
    Statistics statistics_;
};

} // namespace tyndall::gl
