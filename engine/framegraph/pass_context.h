#pragma once
// What a pass can do while it runs: commands of compute and raster programs, clears, copies. Plain data across pure-virtual functions (so
// that a plugin in a shared library uses the very same API) and thin command objects on top.
//
//   c.compute("gi/lpv/inject.comp").bind("rsm", d.in).params(d.params).dispatchOver(d.out);
//   c.raster("gbuffer/gbuffer.vert", "gbuffer/gbuffer.frag").colors(targets).drawGeometry(mesh, 0, indices);

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "framegraph/access.h"
#include "framegraph/handle.h"
#include "framegraph/resource_desc.h"

namespace tyndall::fg {

struct Define {
    const char* name;
    int32_t value;
};

enum class CullMode : uint32_t { None = 0, Back = 1, Front = 2 };
/// In targets of 32-bit floats too, where Add is exact for whole numbers below 2^24.
enum class BlendMode : uint32_t { Replace = 0, Premultiplied = 1, Add = 2 };
enum class DepthMode : uint32_t { Off = 0, TestAndWrite = 1, Test = 2, TestEqual = 3 };
enum class CompareMode : uint32_t {
    Greater = 0,
    Less = 1
}; // Greater: reversed z, of cameras and shadow maps; Less: plain z
enum class Topology : uint32_t { Triangles = 0, Lines = 1, Points = 2 };

/// Fixed-function state of one raster command.
struct RasterState {
    CullMode cull = CullMode::None;
    BlendMode blend = BlendMode::Replace;
    DepthMode depth = DepthMode::Off;
    CompareMode compare = CompareMode::Greater;
    Topology topology = Topology::Triangles; // of what does not tessellate
    uint32_t patchVertices = 3;              // of the patches of what does
    bool frontFaceClockwise = false;         // true for mirrored transforms
    bool depthClamp = false;
    float slopeBias = 0, constantBias = 0; // glPolygonOffset factor and units
};

/// One colour or depth attachment of a raster command.
struct Target {
    TextureHandle texture;
    int32_t layer = 0;
    int32_t mip = 0;
};

/// The stages of a raster program, in the pipeline's order, which is also that of their line in shaders/variants.txt.
struct RasterShaders {
    const char* vertex = nullptr;
    const char* tessControl = nullptr; // both or neither
    const char* tessEvaluation = nullptr;
    const char* fragment = nullptr; // none: only depth is drawn; without targets nothing is
};

/// What indirect commands read from a buffer (OpenGL 4.5, sections 19 and 10.4).
struct DispatchArguments {
    uint32_t groupsX = 0, groupsY = 1, groupsZ = 1;
};
struct DrawArguments {
    uint32_t vertexCount = 0, instanceCount = 1, firstVertex = 0, baseInstance = 0;
};

class ComputeCommand;
class RasterCommand;

/// Records the work of one pass. Only valid inside the execute function. Everything bound must have been
/// declared; resources are bound by the name that they have in the shader.
class PassContext {
public:
    // The plain interface; pass authors use the command objects below.
    virtual void beginCompute(const char* shader, const Define* defines, uint32_t defineCount) = 0;
    virtual void beginRaster(const RasterShaders& shaders, const Define* defines,
                             uint32_t defineCount) = 0;
    virtual void bindTexture(const char* name, TextureHandle handle, int32_t mip,
                             int32_t layer) = 0;
    virtual void bindBuffer(const char* name, BufferHandle handle) = 0;
    virtual void bindStaticTexture(const char* name, StaticTexture texture) = 0;
    virtual void bindStaticBuffer(const char* name, StaticBuffer buffer) = 0;
    /// Uploads `bytes` to a ring and binds them as the uniform block `block` (std140).
    virtual void uniformBlock(const char* block, const void* data, size_t bytes) = 0;
    virtual void uniformInt(const char* name, int32_t value) = 0;
    virtual void uniformFloat(const char* name, float value) = 0;
    virtual void dispatch(uint32_t groupsX, uint32_t groupsY, uint32_t groupsZ) = 0;
    /// Groups to cover so many invocations with the shader's own local size.
    virtual void dispatchThreads(uint32_t x, uint32_t y, uint32_t z) = 0;
    virtual void dispatchIndirect(BufferHandle arguments, uint64_t byteOffset) = 0;
    virtual void targets(const Target* colors, uint32_t colorCount, const Target* depth) = 0;
    virtual void viewport(int32_t x, int32_t y, int32_t width, int32_t height) = 0;
    virtual void rasterState(const RasterState& state) = 0;
    virtual void capture(BufferHandle into, BufferHandle count, uint64_t countOffset,
                         uint64_t firstByte) = 0;
    virtual void draw(uint32_t vertexCount, uint32_t instanceCount, uint32_t firstVertex) = 0;
    virtual void drawIndirect(BufferHandle arguments, uint64_t byteOffset) = 0;
    virtual void drawGeometry(StaticGeometry geometry, uint32_t firstIndex, uint32_t indexCount,
                              uint32_t instanceCount, uint32_t baseInstance) = 0;
    virtual void clearTexture(TextureHandle handle, const float rgba[4]) = 0;
    virtual void clearBuffer(BufferHandle handle, uint32_t value) = 0;
    virtual void copyTexture(TextureHandle from, TextureHandle to) = 0;
    /// CPU data into a declared buffer (through the ring; no stall).
    virtual void upload(BufferHandle handle, uint64_t byteOffset, const void* data,
                        size_t bytes) = 0;
    /// Orders the commands of this pass: what was written before is visible to `next` after.
    virtual void barrier(Access next) = 0;
    [[nodiscard]] virtual TextureDesc desc(TextureHandle handle) const = 0;
    [[nodiscard]] virtual BufferDesc desc(BufferHandle handle) const = 0;
    /// True where the producer was skipped: the resource holds nothing (a 1×1 zero; NaN in poison mode).
    [[nodiscard]] virtual bool isAbsent(TextureHandle handle) const = 0;
    [[nodiscard]] virtual bool isAbsent(BufferHandle handle) const = 0;

    template <size_t N> ComputeCommand compute(const char* shader, const Define (&defines)[N]);
    ComputeCommand compute(const char* shader);
    template <size_t N>
    RasterCommand raster(const RasterShaders& shaders, const Define (&defines)[N]);
    RasterCommand raster(const RasterShaders& shaders);
    template <size_t N>
    RasterCommand raster(const char* vertexShader, const char* fragmentShader,
                         const Define (&defines)[N]);
    RasterCommand raster(const char* vertexShader, const char* fragmentShader);

protected:
    ~PassContext() = default;
};

/// What compute and raster commands share: bindings. `Self` is the derived command.
template <typename Self> class BoundCommand {
public:
    explicit BoundCommand(PassContext& context) : context_(&context) {}
    /// mip ≥ 0 binds that level alone; layer ≥ 0 that layer alone (needed to write images of arrays by layer).
    Self& bind(const char* name, TextureHandle handle, int mip = -1, int layer = -1) {
        context_->bindTexture(name, handle, mip, layer);
        return self();
    }
    Self& bind(const char* name, BufferHandle handle) {
        context_->bindBuffer(name, handle);
        return self();
    }
    Self& bind(const char* name, StaticTexture texture) {
        context_->bindStaticTexture(name, texture);
        return self();
    }
    Self& bind(const char* name, StaticBuffer buffer) {
        context_->bindStaticBuffer(name, buffer);
        return self();
    }
    Self& set(const char* name, int value) {
        context_->uniformInt(name, value);
        return self();
    }
    Self& set(const char* name, float value) {
        context_->uniformFloat(name, value);
        return self();
    }
    /// A std140 struct of shaders/shared as the uniform block `Params` (or another block).
    template <typename T> Self& params(const T& values, const char* block = "Params") {
        static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % 16 == 0,
                      "std140 blocks are padded to 16 bytes");
        context_->uniformBlock(block, &values, sizeof values);
        return self();
    }

protected:
    Self& self() { return static_cast<Self&>(*this); }
    PassContext* context_;
};

class ComputeCommand : public BoundCommand<ComputeCommand> {
public:
    using BoundCommand::BoundCommand;
    void dispatch(uint32_t x, uint32_t y = 1, uint32_t z = 1) { context_->dispatch(x, y, z); }
    void dispatchOver(uint32_t x, uint32_t y = 1, uint32_t z = 1) {
        context_->dispatchThreads(x, y, z);
    }
    /// One thread a texel of mip 0.
    void dispatchOver(TextureHandle handle) {
        const TextureDesc d = context_->desc(handle);
        context_->dispatchThreads(uint32_t(d.width), uint32_t(d.height), uint32_t(d.depth));
    }
    /// With DispatchArguments that a pass before this one, or this pass before a barrier, has written.
    void dispatchIndirect(BufferHandle arguments, uint64_t byteOffset = 0) {
        context_->dispatchIndirect(arguments, byteOffset);
    }
};

class RasterCommand : public BoundCommand<RasterCommand> {
public:
    using BoundCommand::BoundCommand;
    template <size_t N>
    RasterCommand& colors(const Target (&targets)[N], const Target* depth = nullptr) {
        context_->targets(targets, N, depth);
        return *this;
    }
    RasterCommand& depthOnly(const Target& depth) {
        context_->targets(nullptr, 0, &depth);
        return *this;
    }
    RasterCommand& viewport(int x, int y, int width, int height) {
        context_->viewport(x, y, width, height);
        return *this;
    }
    RasterCommand& state(const RasterState& s) {
        context_->rasterState(s);
        return *this;
    }
    /// What the last stage before rasterisation declares with `layout(xfb_offset = …) out` goes to `into`: tightly from byte `firstByte` (a multiple of 4) on,
    /// draw after draw of this command, in the order of their primitives. What does not fit is dropped, by whole primitives.
    /// `count`, if given, gets the number of points, lines or triangles that were captured, as a uint at byte `countOffset`, when the
    /// command is over: with the next command, clear, copy, upload or barrier, or with the pass. Both are written as Access::Capture.
    RasterCommand& capture(BufferHandle into, BufferHandle count = {}, uint64_t countOffset = 0,
                           uint64_t firstByte = 0) {
        context_->capture(into, count, countOffset, firstByte);
        return *this;
    }
    void draw(uint32_t vertices, uint32_t instances = 1, uint32_t firstVertex = 0) {
        context_->draw(vertices, instances, firstVertex);
    }
    /// With DrawArguments that a pass before this one, or this pass before a barrier, has written.
    void drawIndirect(BufferHandle arguments, uint64_t byteOffset = 0) {
        context_->drawIndirect(arguments, byteOffset);
    }
    void drawGeometry(StaticGeometry geometry, uint32_t firstIndex, uint32_t indexCount,
                      uint32_t instances = 1, uint32_t baseInstance = 0) {
        context_->drawGeometry(geometry, firstIndex, indexCount, instances, baseInstance);
    }
};

template <size_t N>
ComputeCommand PassContext::compute(const char* shader, const Define (&defines)[N]) {
    beginCompute(shader, defines, uint32_t(N));
    return ComputeCommand(*this);
}
inline ComputeCommand PassContext::compute(const char* shader) {
    beginCompute(shader, nullptr, 0);
    return ComputeCommand(*this);
}
template <size_t N>
RasterCommand PassContext::raster(const RasterShaders& shaders, const Define (&defines)[N]) {
    beginRaster(shaders, defines, uint32_t(N));
    return RasterCommand(*this);
}
inline RasterCommand PassContext::raster(const RasterShaders& shaders) {
    beginRaster(shaders, nullptr, 0);
    return RasterCommand(*this);
}
template <size_t N>
RasterCommand PassContext::raster(const char* vertexShader, const char* fragmentShader,
                                  const Define (&defines)[N]) {
    return raster({.vertex = vertexShader, .fragment = fragmentShader}, defines);
}
inline RasterCommand PassContext::raster(const char* vertexShader, const char* fragmentShader) {
    return raster({.vertex = vertexShader, .fragment = fragmentShader});
}

} // namespace tyndall::fg
