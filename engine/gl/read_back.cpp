#include "gl/read_back.h"

#include <fmt/format.h>

#include <cstring>
#include <utility>

namespace tyndall::gl {

ReadBack ReadBack::start(const Texture& texture, int mip) {
    CHECK(texture, "a read-back of an empty texture");
    const FormatInfo& info = formatInfo(texture.spec().internalFormat);
    ReadBack result;
    result.region_ = texture.mipRegion(mip);
    result.channels_ = int(info.channels);
    result.integer_ =
        info.formatClass == FormatClass::UnsignedInt || info.formatClass == FormatClass::SignedInt;
    const uint64_t bytes = uint64_t(result.region_.width) * uint64_t(result.region_.height) *
                           uint64_t(result.region_.depth) * info.channels * sizeof(float);
    CHECK(bytes < (uint64_t(1) << 31),
          fmt::format("a read-back of {} bytes is more than OpenGL packs at once", bytes));

    GLuint id = 0;
    glCreateBuffers(1, &id);
    constexpr GLbitfield kFlags = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    glNamedBufferStorage(id, GLsizeiptr(bytes), nullptr, kFlags | GL_CLIENT_STORAGE_BIT);
    result.memory_ = Object(ObjectKind::Buffer, id, int64_t(bytes));
    result.memory_.label("read-back");

    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT | GL_PIXEL_BUFFER_BARRIER_BIT |
                    GL_FRAMEBUFFER_BARRIER_BIT); // shaders may have written it
    glBindBuffer(GL_PIXEL_PACK_BUFFER, id);
    const GLenum type = info.formatClass == FormatClass::SignedInt ? GL_INT
                        : result.integer_                          ? GL_UNSIGNED_INT
                                                                   : GL_FLOAT;
    glGetTextureImage(texture.id(), mip, info.transferFormat, type, GLsizei(bytes), nullptr);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    result.mapped_ = glMapNamedBufferRange(id, 0, GLsizeiptr(bytes), kFlags);
    CHECK(result.mapped_ != nullptr, "the driver cannot map a read-back");
    result.fence_ = Fence::insert();
    return result;
}

const void* ReadBack::finish() {
    CHECK(memory_, "a read-back is taken once");
    fence_.wait();
    return mapped_;
}

std::vector<float> ReadBack::takeFloats() {
    CHECK(!integer_, "the texture has integers: takeIntegers()");
    std::vector<float> values(size_t(memory_.bytes()) / sizeof(float));
    std::memcpy(values.data(), finish(), values.size() * sizeof(float));
    *this = {};
    return values;
}

std::vector<uint32_t> ReadBack::takeIntegers() {
    CHECK(integer_, "the texture has no integers: takeFloats()");
    std::vector<uint32_t> values(size_t(memory_.bytes()) / sizeof(uint32_t));
    std::memcpy(values.data(), finish(), values.size() * sizeof(uint32_t));
    *this = {};
    return values;
}

std::vector<float> readFloats(const Texture& texture, int mip) {
    return ReadBack::start(texture, mip).takeFloats();
}
std::vector<uint32_t> readIntegers(const Texture& texture, int mip) {
    return ReadBack::start(texture, mip).takeIntegers();
}

Image takeImage(ReadBack& readBack, int layer) {
    const TextureRegion region = readBack.region();
    CHECK(layer >= 0 && layer < region.depth,
          fmt::format("layer {} of a texture with {}", layer, region.depth));
    Image image(region.width, region.height, readBack.channels());
    const std::vector<float> values = readBack.takeFloats();
    const size_t row = size_t(image.width) * size_t(image.channels);
    const float* source = values.data() + size_t(layer) * size_t(image.height) * row;
    for (int y = 0; y < image.height; ++y)
        std::memcpy(image.at(0, image.height - 1 - y), source + size_t(y) * row,
                    row * sizeof(float));
    return image;
}

Image readImage(const Texture& texture, int layer) {
    ReadBack readBack = ReadBack::start(texture);
    return takeImage(readBack, layer);
}

} // namespace tyndall::gl
