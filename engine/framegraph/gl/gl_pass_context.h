#pragma once
// PassContext on OpenGL: finds programs, checks every binding against what the pass declared, and records commands.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "framegraph/binding_check.h"
#include "framegraph/gl/capture.h"
#include "framegraph/gl/program_cache.h"
#include "framegraph/gl/static_table.h"
#include "framegraph/gl/storage.h"
#include "framegraph/storage_place.h"
#include "gl/buffer.h"
#include "gl/framebuffer.h"
#include "gl/sampler.h"

namespace tyndall::fg {

/// What the context works with; owned by the executor.
struct GlWorld {
    const FrameGraphImpl& graph;
    const CompiledGraph& compiled;
    const PersistentTable& persistentTable;
    StorageSet& storage;
    StaticTable& statics;
    ProgramCache& programs;
    gl::FramebufferCache& framebuffers;
    gl::SamplerCache& samplers;
    gl::UploadRing& ring;
    const bool& poison;

    /// The storage that holds the resource in this frame. CHECKs that there is one.
    [[nodiscard]] Storage& storageOf(uint32_t resource) const {
        return storageAt(placeOf(compiled, resource), resource);
    }
    [[nodiscard]] Storage& storageOf(uint32_t resource, uint32_t version) const {
        return storageAt(placeOf(graph, compiled, resource, version), resource);
    }
    [[nodiscard]] Storage& storageAt(StoragePlace place, uint32_t resource) const;
};

class GlPassContext final : public PassContext {
public:
    explicit GlPassContext(const GlWorld& world);

    /// Sets GL's state to what passes rely on; before the first pass of a frame.
    void beginFrame();
    void beginPass(uint32_t pass);
    /// Finishes the last command; also after a pass that threw.
    void endPass();
    /// The message of the first shader that failed in this frame; the rest of its pass did nothing.
    [[nodiscard]] const std::optional<Error>& failure() const { return failure_; }
    [[nodiscard]] uint32_t barrierCount() const { return barrierCount_; }
    void memoryBarrier(uint32_t bits);

    void beginCompute(const char* shader, const Define* defines, uint32_t defineCount) override;
    void beginRaster(const RasterShaders& shaders, const Define* defines,
                     uint32_t defineCount) override;
    void bindTexture(const char* name, TextureHandle handle, int32_t mip, int32_t layer) override;
    void bindBuffer(const char* name, BufferHandle handle) override;
    void bindStaticTexture(const char* name, StaticTexture texture) override;
    void bindStaticBuffer(const char* name, StaticBuffer buffer) override;
    void uniformBlock(const char* block, const void* data, size_t bytes) override;
    void uniformInt(const char* name, int32_t value) override;
    void uniformFloat(const char* name, float value) override;
    void dispatch(uint32_t groupsX, uint32_t groupsY, uint32_t groupsZ) override;
    void dispatchThreads(uint32_t x, uint32_t y, uint32_t z) override;
    void dispatchIndirect(BufferHandle arguments, uint64_t byteOffset) override;
    void targets(const Target* colors, uint32_t colorCount, const Target* depth) override;
    void viewport(int32_t x, int32_t y, int32_t width, int32_t height) override;
    void rasterState(const RasterState& state) override;
    void capture(BufferHandle into, BufferHandle count, uint64_t countOffset,
                 uint64_t firstByte) override;
    void draw(uint32_t vertexCount, uint32_t instanceCount, uint32_t firstVertex) override;
    void drawIndirect(BufferHandle arguments, uint64_t byteOffset) override;
    void drawGeometry(StaticGeometry geometry, uint32_t firstIndex, uint32_t indexCount,
                      uint32_t instanceCount, uint32_t baseInstance) override;
    void clearTexture(TextureHandle handle, const float rgba[4]) override;
    void clearBuffer(BufferHandle handle, uint32_t value) override;
    void copyTexture(TextureHandle from, TextureHandle to) override;
    void upload(BufferHandle handle, uint64_t byteOffset, const void* data, size_t bytes) override;
    void barrier(Access next) override;
    [[nodiscard]] TextureDesc desc(TextureHandle handle) const override {
        return world_.graph.desc(handle);
    }
    [[nodiscard]] BufferDesc desc(BufferHandle handle) const override {
        return world_.graph.desc(handle);
    }
    [[nodiscard]] bool isAbsent(TextureHandle handle) const override {
        return world_.graph.isAbsent(handle);
    }
    [[nodiscard]] bool isAbsent(BufferHandle handle) const override {
        return world_.graph.isAbsent(handle);
    }

private:
    void begin(std::span<const char* const> files, const Define* defines, uint32_t defineCount);
    /// The program's resource of this name; null where the shader compiler has removed it. CHECKs that the source has the name.
    const gl::ProgramResource* resourceOf(const char* name);
    void markBound(const gl::ProgramResource& resource);
    void checkAllBound();
    void check(uint32_t resource, uint32_t version, Touch touch, std::string_view place) const;
    [[nodiscard]] bool writesByShader(uint32_t resource) const;
    void bindSampler(const gl::ProgramResource& sampler, Storage& storage,
                     const gl::SamplerSpec* spec, int32_t mip, int32_t layer);
    void bindImage(const gl::ProgramResource& image, const Storage& storage, bool writes,
                   int32_t mip, int32_t layer);
    void bindBlock(const gl::ProgramResource& block, const gl::Buffer& buffer, uint64_t bytes);
    void aroundClear(uint32_t resource, bool isBuffer, bool before);
    /// Where the arguments of an indirect command are; null where the buffer is absent, and with it the command.
    const gl::Buffer* argumentsAt(BufferHandle arguments, uint64_t byteOffset, size_t bytes,
                                  const char* place) const;
    void prepareDraw(GLuint vertexArray);
    [[nodiscard]] GLenum topology() const;
    void setDiscard(bool on);
    void applyState();
    [[nodiscard]] std::string_view passName() const { return world_.graph.passes()[pass_].name; }

    const GlWorld& world_;
    gl::Object emptyVertexArray_;
    uint32_t pass_ = 0;
    const gl::Program* program_ = nullptr; // null: it failed, and nothing is done
    std::array<bool, 128> bound_{};        // per resource of the program
    bool allBound_ = false;
    bool hasTargets_ = false;
    TextureHandle depthTarget_;
    RasterState state_;
    bool stateApplied_ = false;
    bool discards_ = false; // nothing is rasterised
    Capture capture_;
    std::optional<Error> failure_;
    uint32_t barrierCount_ = 0;
};

} // namespace tyndall::fg
