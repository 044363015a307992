#include "gl/buffer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace tyndall::gl {
namespace {

/// Empties the error flag, so that an error read afterwards is new.
void forgetErrors() {
    while (glGetError() != GL_NO_ERROR) {
    }
}

Buffer orNoRoom(Result<Buffer> created) {
    if (!created.ok()) throw NoRoom(created.message());
    return std::move(*created);
}

} // namespace

Result<Buffer> Buffer::create(std::string_view name, uint64_t bytes, BufferAccess access,
                              const void* data) {
    CHECK(bytes > 0, fmt::format("buffer '{}' needs a size", name));
    constexpr uint64_t kMostBytes =
        uint64_t(1) << 46; // more than any GPU addresses; larger sizes overflow in drivers
    if (bytes > kMostBytes)
        return Error{
            fmt::format("buffer '{}' of {} bytes is larger than any GPU's memory", name, bytes)};
    GLuint id = 0;
    glCreateBuffers(1, &id);
    forgetErrors();
    glNamedBufferStorage(id, GLsizeiptr(bytes), data,
                         access == BufferAccess::CpuUpdates ? GL_DYNAMIC_STORAGE_BIT : 0);
    if (glGetError() == GL_OUT_OF_MEMORY) {
        glDeleteBuffers(1, &id);
        return Error{fmt::format("buffer '{}': the GPU has no room for {} bytes", name, bytes)};
    }
    Buffer buffer;
    buffer.object_ = Object(ObjectKind::Buffer, id, int64_t(bytes));
    buffer.object_.label(name);
    buffer.access_ = access;
    return buffer;
}

Buffer::Buffer(std::string_view name, uint64_t bytes, BufferAccess access)
    : Buffer(orNoRoom(create(name, bytes, access))) {}

Buffer::Buffer(std::string_view name, std::span<const std::byte> data, BufferAccess access)
    : Buffer(orNoRoom(create(name, data.size(), access, data.data()))) {}

void Buffer::write(uint64_t offset, const void* data, uint64_t size) {
    CHECK(access_ == BufferAccess::CpuUpdates, "write() needs a buffer made with CpuUpdates");
    CHECK(offset <= bytes() && size <= bytes() - offset,
          fmt::format("write of {} bytes at {} into a buffer of {}", size, offset, bytes()));
    if (size > 0) glNamedBufferSubData(id(), GLintptr(offset), GLsizeiptr(size), data);
}

void Buffer::copyFrom(GLuint source, uint64_t sourceOffset, uint64_t offset, uint64_t size) {
    CHECK(offset <= bytes() && size <= bytes() - offset,
          fmt::format("copy of {} bytes to {} of a buffer of {}", size, offset, bytes()));
    if (size > 0)
        glCopyNamedBufferSubData(source, id(), GLintptr(sourceOffset), GLintptr(offset),
                                 GLsizeiptr(size));
}

void Buffer::clear(uint32_t value) {
    CHECK(bytes() % 4 == 0,
          fmt::format("clear() of a buffer of {} bytes, which is no multiple of 4", bytes()));
    glClearNamedBufferData(id(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &value);
}

void Buffer::read(uint64_t offset, void* data, uint64_t size) const {
    CHECK(offset <= bytes() && size <= bytes() - offset,
          fmt::format("read of {} bytes at {} from a buffer of {}", size, offset, bytes()));
    if (size == 0) return;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT); // shaders may have written it
    glGetNamedBufferSubData(id(), GLintptr(offset), GLsizeiptr(size), data);
}

UploadRing::UploadRing(std::string_view name, uint64_t bytes) : name_(name) {
    CHECK(bytes > 0, fmt::format("ring '{}' needs a size", name));
    map(bytes);
}

void UploadRing::map(uint64_t bytes) {
    constexpr GLbitfield kFlags = GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    GLuint id = 0;
    glCreateBuffers(1, &id);
    forgetErrors();
    glNamedBufferStorage(id, GLsizeiptr(bytes), nullptr, kFlags);
    object_ = Object(ObjectKind::Buffer, id, int64_t(bytes));
    object_.label(name_);
    memory_ = static_cast<std::byte*>(glMapNamedBufferRange(id, 0, GLsizeiptr(bytes), kFlags));
    CHECK(memory_ != nullptr,
          fmt::format("ring '{}': the driver cannot map {} bytes", name_, bytes));
    capacity_ = bytes;
    head_ = tail_ = 0;
}

void UploadRing::freePassed() {
    while (!frames_.empty() && frames_.front().fence.passed()) {
        tail_ = std::max(tail_, frames_.front().end);
        frames_.pop_front();
        ++oldestFrame_;
    }
    std::erase_if(retired_,
                  [this](const Retired& retired) { return retired.frame < oldestFrame_; });
}

/// True when everything up to `end` fits behind the tail. Waits for a frame only when many are on their way: a ring
/// that is merely too short for the frames that the GPU may be behind grows instead.
bool UploadRing::makeRoom(uint64_t end) {
    constexpr size_t kFramesInFlight = 3;
    if (end - tail_ <= capacity_) return true;
    freePassed();
    while (end - tail_ > capacity_ && frames_.size() >= kFramesInFlight) {
        ++statistics_.waits;
        frames_.front().fence.wait();
        freePassed();
    }
    return end - tail_ <= capacity_;
}

/// A new buffer with room for `bytes` in this frame; the old one stays until the GPU has passed this frame.
void UploadRing::grow(uint64_t bytes) {
    uint64_t size = capacity_ * 2;
    while (size < bytes * 2) size *= 2;
    retired_.push_back({std::move(object_), frame_});
    for (Frame& frame : frames_) frame.end = 0; // positions in the old buffer
    ++statistics_.grown;
    map(size);
}

UploadRing::Slice UploadRing::allocate(uint64_t bytes, uint64_t alignment) {
    CHECK(object_, "the ring is empty");
    CHECK(bytes > 0, fmt::format("ring '{}': allocation of no bytes", name_));
    CHECK(alignment > 0 && (alignment & (alignment - 1)) == 0,
          fmt::format("alignment {} is no power of two", alignment));
    if (bytes > capacity_) grow(bytes);
    const auto start = [&] {
        uint64_t position = head_ % capacity_;
        const uint64_t aligned = (position + alignment - 1) & ~(alignment - 1);
        if (aligned + bytes <= capacity_) return head_ + (aligned - position);
        return head_ +
               (capacity_ - position); // the rest of the memory is too short: on to its start
    };
    if (!makeRoom(start() + bytes)) grow(bytes);
    const uint64_t begin = start();
    if (begin > 0 && begin % capacity_ == 0) ++statistics_.wraps;
    head_ = begin + bytes;
    const uint64_t offset = begin % capacity_;
    return {object_.id(), offset, memory_ + offset};
}

UploadRing::Slice UploadRing::upload(const void* data, uint64_t bytes, uint64_t alignment) {
    const Slice slice = allocate(bytes, alignment);
    std::memcpy(slice.data, data, size_t(bytes));
    return slice;
}

void UploadRing::endFrame() {
    CHECK(object_, "the ring is empty");
    frames_.push_back({Fence::insert(), head_});
    ++frame_;
    freePassed();
}

} // namespace tyndall::gl
