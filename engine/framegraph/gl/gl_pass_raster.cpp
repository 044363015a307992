// The part of GlPassContext that draws, clears and copies.

#include <fmt/format.h>

#include <algorithm>

#include "core/check.h"
#include "framegraph/gl/gl_format.h"
#include "framegraph/gl/gl_pass_context.h"
#include "gl/context.h"

namespace tyndall::fg {
namespace {

void enable(GLenum capability, bool on) { on ? glEnable(capability) : glDisable(capability); }

} // namespace

// --- targets and state ---

void GlPassContext::targets(const Target* colors, uint32_t colorCount, const Target* depth) {
    if (!program_) return;
    CHECK(colorCount <= gl::FramebufferCache::kMostColors,
          fmt::format("pass '{}' draws to {} colours", passName(), colorCount));
    const auto attachment = [&](const Target& target, Touch touch, const char* place) {
        check(target.texture.resource, target.texture.version, touch, place);
        CHECK(!isAbsent(target.texture),
              fmt::format("pass '{}' draws to something absent", passName()));
        const gl::Texture& texture =
            world_.storageOf(target.texture.resource, target.texture.version).texture;
        return gl::Attachment{&texture, target.mip,
                              texture.spec().target == GL_TEXTURE_2D ? -1 : target.layer};
    };
    std::array<gl::Attachment, gl::FramebufferCache::kMostColors> attachments;
    for (uint32_t i = 0; i < colorCount; ++i)
        attachments[i] = attachment(colors[i], Touch::ColorAttachment, "color target");
    gl::Attachment depthAttachment;
    if (depth) depthAttachment = attachment(*depth, Touch::DepthTest, "depth target");
    depthTarget_ = depth ? depth->texture : TextureHandle{};
    const GLuint framebuffer = world_.framebuffers.get({attachments.data(), colorCount},
                                                       depth ? &depthAttachment : nullptr);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    hasTargets_ = true;
    const gl::Attachment& first = colorCount > 0 ? attachments[0] : depthAttachment;
    const gl::TextureRegion size = first.texture->mipRegion(first.mip);
    glViewport(0, 0, size.width, size.height);
}

void GlPassContext::viewport(int32_t x, int32_t y, int32_t width, int32_t height) {
    if (program_) glViewport(x, y, width, height);
}

void GlPassContext::rasterState(const RasterState& state) {
    state_ = state;
    stateApplied_ = false;
}

void GlPassContext::applyState() {
    if (stateApplied_) return;
    stateApplied_ = true;
    if (program_->tessellatesTo()) {
        const auto most = uint32_t(gl::currentCapabilities().limits.patchVertices);
        CHECK(state_.patchVertices >= 1 && state_.patchVertices <= most,
              fmt::format("pass '{}' draws patches of {} vertices with '{}': a patch has 1 to {}",
                          passName(), state_.patchVertices, program_->name(), most));
        glPatchParameteri(GL_PATCH_VERTICES, GLint(state_.patchVertices));
    }
    const bool depthWrites = state_.depth == DepthMode::TestAndWrite;
    if (depthWrites && depthTarget_)
        check(depthTarget_.resource, depthTarget_.version, Touch::DepthAttachment, "depth target");
    enable(GL_CULL_FACE, state_.cull != CullMode::None);
    if (state_.cull != CullMode::None)
        glCullFace(state_.cull == CullMode::Back ? GL_BACK : GL_FRONT);
    glFrontFace(state_.frontFaceClockwise ? GL_CW : GL_CCW);
    enable(GL_BLEND, state_.blend != BlendMode::Replace);
    if (state_.blend != BlendMode::Replace)
        glBlendFunc(GL_ONE, state_.blend == BlendMode::Add ? GL_ONE : GL_ONE_MINUS_SRC_ALPHA);
    enable(GL_DEPTH_TEST, state_.depth != DepthMode::Off);
    glDepthMask(depthWrites ? GL_TRUE : GL_FALSE);
    if (state_.depth == DepthMode::TestEqual)
        glDepthFunc(GL_EQUAL);
    else
        glDepthFunc(state_.compare == CompareMode::Greater ? GL_GREATER : GL_LESS);
    const bool offset = state_.slopeBias != 0 || state_.constantBias != 0;
    enable(GL_POLYGON_OFFSET_FILL, offset);
    if (offset) glPolygonOffset(state_.slopeBias, state_.constantBias);
    enable(GL_DEPTH_CLAMP, state_.depthClamp);
}

void GlPassContext::setDiscard(bool on) {
    if (on != discards_) enable(GL_RASTERIZER_DISCARD, on);
    discards_ = on;
}

// --- draws ---

void GlPassContext::capture(BufferHandle into, BufferHandle count, uint64_t countOffset,
                            uint64_t firstByte) {
    if (!program_) return;
    CHECK(
        program_->captureStride() > 0,
        fmt::format(
            "pass '{}' captures from '{}', which has no output with xfb_offset in its last stage before "
            "rasterisation",
            passName(), program_->name()));
    check(into.resource, into.version, Touch::Capture, "capture");
    CHECK(!isAbsent(into), fmt::format("pass '{}' captures into something absent", passName()));
    CHECK(firstByte % 4 == 0 && firstByte + 4 <= desc(into).bytes,
          fmt::format("pass '{}' captures from byte {} of a buffer of {} on", passName(), firstByte,
                      desc(into).bytes));
    const gl::Buffer* counter = nullptr;
    if (count) {
        check(count.resource, count.version, Touch::Capture, "capture count");
        CHECK(!isAbsent(count), fmt::format("pass '{}' counts in something absent", passName()));
        CHECK(countOffset % 4 == 0 && countOffset + 4 <= desc(count).bytes,
              fmt::format("pass '{}' writes the capture count at byte {} of a buffer of {}",
                          passName(), countOffset, desc(count).bytes));
        counter = &world_.storageOf(count.resource, count.version).buffer;
    }
    capture_.aim(world_.storageOf(into.resource, into.version).buffer, firstByte, desc(into).bytes - firstByte,
                 counter, countOffset);
}

GLenum GlPassContext::topology() const {
    if (program_->tessellatesTo()) return GL_PATCHES;
    switch (state_.topology) {
    case Topology::Triangles: return GL_TRIANGLES;
    case Topology::Lines: return GL_LINES;
    case Topology::Points: return GL_POINTS;
    }
    return GL_TRIANGLES;
}

void GlPassContext::prepareDraw(GLuint vertexArray) {
    CHECK(!program_->isCompute(),
          fmt::format("pass '{}' draws with '{}', a compute shader", passName(), program_->name()));
    CHECK(hasTargets_ || !program_->hasFragments(),
          fmt::format("pass '{}' draws with '{}' without targets", passName(), program_->name()));
    CHECK(capture_.isAimed() || program_->captureStride() == 0,
          fmt::format(
              "pass '{}' draws with '{}', which captures, without a buffer for it: call capture() "
              "before, and again after a clear, copy, upload or barrier",
              passName(), program_->name()));
    checkAllBound();
    applyState();
    if (!hasTargets_) glBindFramebuffer(GL_FRAMEBUFFER, world_.framebuffers.get({}));
    setDiscard(!hasTargets_);
    if (capture_.isAimed()) capture_.begin(program_->tessellatesTo().value_or(topology()));
    glBindVertexArray(vertexArray);
}

void GlPassContext::draw(uint32_t vertexCount, uint32_t instanceCount, uint32_t firstVertex) {
    if (!program_ || vertexCount == 0 || instanceCount == 0) return;
    prepareDraw(emptyVertexArray_.id());
    glDrawArraysInstanced(topology(), GLint(firstVertex), GLsizei(vertexCount),
                          GLsizei(instanceCount));
}

void GlPassContext::drawIndirect(BufferHandle arguments, uint64_t byteOffset) {
    const gl::Buffer* buffer =
        argumentsAt(arguments, byteOffset, sizeof(DrawArguments), "draw arguments");
    if (!program_ || !buffer) return;
    prepareDraw(emptyVertexArray_.id());
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, buffer->id());
    glDrawArraysIndirect(topology(), reinterpret_cast<const void*>(uintptr_t(byteOffset)));
}

void GlPassContext::drawGeometry(StaticGeometry geometry, uint32_t firstIndex, uint32_t indexCount,
                                 uint32_t instanceCount, uint32_t baseInstance) {
    if (!program_ || indexCount == 0 || instanceCount == 0) return;
    const StaticGeometryEntry& entry = world_.statics.geometry(geometry.id);
    prepareDraw(entry.vertexArray.id());
    if (!entry.indexed) {
        glDrawArraysInstancedBaseInstance(topology(), GLint(firstIndex), GLsizei(indexCount),
                                          GLsizei(instanceCount), baseInstance);
        return;
    }
    const uintptr_t offset =
        uintptr_t(entry.indexOffsetBytes) + uintptr_t(firstIndex) * sizeof(uint32_t);
    glDrawElementsInstancedBaseInstance(topology(), GLsizei(indexCount), GL_UNSIGNED_INT,
                                        reinterpret_cast<const void*>(offset),
                                        GLsizei(instanceCount), baseInstance);
}

// --- clears, copies, uploads ---

/// A pass may clear what it also writes by shaders. GL does not order the two, and the graph's barriers do not know of the clear.
void GlPassContext::aroundClear(uint32_t resource, bool isBuffer, bool before) {
    if (!writesByShader(resource)) return;
    if (isBuffer)
        memoryBarrier(before ? GL_BUFFER_UPDATE_BARRIER_BIT : GL_SHADER_STORAGE_BARRIER_BIT);
    else
        memoryBarrier(before ? GL_TEXTURE_UPDATE_BARRIER_BIT : GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

void GlPassContext::clearTexture(TextureHandle handle, const float rgba[4]) {
    capture_.end();
    check(handle.resource, handle.version, Touch::TransferWrite, "clear");
    gl::Texture& texture = world_.storageOf(handle.resource, handle.version).texture;
    aroundClear(handle.resource, false, true);
    if (isIntegerFormat(desc(handle).format)) {
        const auto integer = [](float value) {
            return value < 0 ? uint32_t(int32_t(value)) : uint32_t(value);
        };
        texture.clearInteger(integer(rgba[0]), integer(rgba[1]), integer(rgba[2]),
                             integer(rgba[3]));
    } else {
        texture.clear(rgba[0], rgba[1], rgba[2], rgba[3]);
    }
    aroundClear(handle.resource, false, false);
}

void GlPassContext::clearBuffer(BufferHandle handle, uint32_t value) {
    capture_.end();
    check(handle.resource, handle.version, Touch::TransferWrite, "clear");
    aroundClear(handle.resource, true, true);
    world_.storageOf(handle.resource, handle.version).buffer.clear(value);
    aroundClear(handle.resource, true, false);
}

void GlPassContext::copyTexture(TextureHandle from, TextureHandle to) {
    capture_.end();
    check(from.resource, from.version, Touch::TransferRead, "copy source");
    check(to.resource, to.version, Touch::TransferWrite, "copy destination");
    const TextureDesc source = desc(from), destination = desc(to);
    TextureDesc sameMips = source;
    sameMips.mips = destination.mips;
    CHECK(
        sameMips == destination,
        fmt::format("pass '{}' copies between textures of different sizes or formats", passName()));
    Storage& target = world_.storageOf(to.resource, to.version);
    if (isAbsent(from)) return world_.poison ? target.poison() : target.clearToZero();
    const Storage& origin = world_.storageOf(from.resource, from.version);
    aroundClear(to.resource, false, true);
    for (int mip = 0; mip < std::min(source.mips, destination.mips); ++mip) {
        const gl::TextureRegion size = origin.texture.mipRegion(mip);
        const GLenum kind = glTarget(source.kind);
        glCopyImageSubData(origin.texture.id(), kind, mip, 0, 0, 0, target.texture.id(), kind, mip,
                           0, 0, 0, size.width, size.height, size.depth);
    }
    aroundClear(to.resource, false, false);
}

void GlPassContext::upload(BufferHandle handle, uint64_t byteOffset, const void* data,
                           size_t bytes) {
    capture_.end();
    check(handle.resource, handle.version, Touch::TransferWrite, "upload");
    if (bytes == 0) return;
    CHECK(byteOffset + bytes <= desc(handle).bytes,
          fmt::format("pass '{}' uploads {} bytes at {} into a buffer of {}", passName(), bytes,
                      byteOffset, desc(handle).bytes));
    const gl::UploadRing::Slice slice = world_.ring.upload(data, bytes, 16);
    aroundClear(handle.resource, true, true);
    world_.storageOf(handle.resource, handle.version)
        .buffer.copyFrom(slice.buffer, slice.offset, byteOffset, bytes);
    aroundClear(handle.resource, true, false);
}

} // namespace tyndall::fg
