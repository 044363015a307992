#pragma once
// Runs frame graphs on OpenGL. One executor a context; it owns everything that the graph names: the transient pool,
// persistent and history resources, kept results of cached passes, and the tables of static things.
//
//   fg::Executor executor(shaderLibrary);
//   StaticTexture brdf = executor.registerTexture("lighting.brdf", std::move(texture));
//   …
//   fg::FrameGraph& graph = executor.beginFrame();          // the last frame's handles end here
//   …add passes, graph.markOutput(image)…
//   if (Result<void> done = executor.execute(); !done.ok()) …   // a shader that never compiled
//   const fg::FrameReport& report = executor.report();
//   Image picture = executor.readImage(image);              // outputs can be read until the next beginFrame()
//
// Textures of the graph are read bilinearly (trilinearly where they have mips) and clamped; integers and depth by the nearest texel;
// a sampler2DShadow passes where the reference is at least the stored, reversed depth. Drawing sets the viewport to the whole first
// target until the pass sets another. Depth runs from 0 to 1 without remapping; nothing is dithered, multisampled or scissored.
//
// Errors of pass authors (compile errors of the graph, binding what was not declared) are CHECK failures whose message has a
// sentence for each. Errors in shaders come back from execute().

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/image.h"
#include "core/result.h"
#include "framegraph/compiled_graph.h"
#include "framegraph/frame_graph.h"

namespace tyndall::gl {
class Buffer;
class ShaderLibrary;
class Texture;
struct SamplerSpec;
} // namespace tyndall::gl

namespace tyndall::fg {

struct ExecutorOptions {
    /// Everything that a pass creates, and everything absent, starts as NaN (integers as 0xFFFFFFFF).
    bool poison = false;
    /// Counts the non-finite and negative texels of every float texture that a pass wrote; waits for the GPU, so slow.
    bool checkTexels = false;
    /// Every resource keeps its own storage to the end of the frame, so that any can be read back or inspected.
    bool keepAll = false;
    /// Two timestamps a pass, read some frames later without a stall.
    bool timings = true;
};

/// What became of one pass. Texts live until the next beginFrame().
struct PassReport {
    std::string_view name;
    PassStatus status;
    std::string_view reason; // why it did not run; empty where it ran
    double gpuMs = -1;   // the last measurement of this pass; -1: none yet. Lags some frames behind
    double cpuMs = 0;    // time to record it in this frame
    double savedMs = -1; // of a pass that did not run: the last time measured for it; -1: none
    uint64_t nonFiniteTexels = 0; // with ExecutorOptions::checkTexels
    uint64_t negativeTexels =
        0; // likewise; only of unsigned quantities, see Executor::allowNegative
};

/// One executed frame. Rewritten by execute().
struct FrameReport {
    std::vector<PassReport> passes; // in order of declaration
    double compileMs = 0;           // CPU time of FrameGraph compilation
    double cpuMs = 0;               // CPU time of execute(), compilation included
    double gpuMs =
        -1; // sum over the passes that ran, of their last measurements; -1: not all measured yet
    uint64_t gpuBytes =
        0; // all storage alive in this executor: pool, kept results, persistent, static, rings
    uint64_t nonFiniteTexels = 0, negativeTexels = 0;
    uint32_t barriers = 0;                      // glMemoryBarrier calls
    uint32_t liveTextures = 0, liveBuffers = 0; // objects that this executor holds
};

enum class AttributeType : uint32_t {
    Float32 = 0,
    Unorm8 = 1,
    Unorm16 = 2,
    Snorm8 = 3,
    Snorm16 = 4,
    UInt32 = 5
};

struct VertexAttribute {
    uint32_t location;
    uint32_t components; // 1 to 4
    AttributeType type;
    uint32_t offset; // in the vertex, bytes
};

/// Interleaved vertices and an optional list of 32-bit indices, both in registered buffers, which must outlive it.
struct GeometryDesc {
    StaticBuffer vertices;
    uint32_t strideBytes = 0;
    uint64_t vertexOffsetBytes = 0;
    std::span<const VertexAttribute> attributes;
    StaticBuffer indices; // none: drawGeometry counts vertices
    uint64_t indexOffsetBytes = 0;
};

class Executor {
public:
    /// `shaders` must outlive the executor. Needs a current context, as every other function here.
    explicit Executor(gl::ShaderLibrary& shaders, const ExecutorOptions& options = {});
    ~Executor();
    Executor(const Executor&) = delete;
    Executor& operator=(const Executor&) = delete;

    [[nodiscard]] const ExecutorOptions& options() const;
    /// Takes effect with the next beginFrame(). Poison mode also forgets all kept results.
    void setOptions(const ExecutorOptions& options);

    /// Starts an empty graph. It belongs to the executor; so do the names and the data of its passes.
    FrameGraph& beginFrame();
    /// The newest version of a texture of the frame being recorded, by name, for the inspector; null where there is none.
    [[nodiscard]] TextureHandle findTexture(std::string_view name) const;
    /// Compiles and runs the graph. Errors: a shader that does not compile and has no last good version.
    Result<void> execute();
    /// After execute(): runs one pass of the frame again, and no other. `data` is what addPass() returned for it. For a pass whose
    /// parameters have changed since, such as an exposure. All that it reads and writes must still be there (outputs, persistent
    /// and static resources; a CHECK). What it creates is written anew. Errors: as execute().
    Result<void> runAgain(const void* data);

    [[nodiscard]] const FrameReport& report() const;
    /// Waits for the GPU times of the frames so far and brings report() up to date with them: for the end of a run.
    void waitForTimings();
    /// The graph of the last execute(); see framegraph/dump.h.
    [[nodiscard]] const CompiledGraph& compiled() const;

    /// Persistent and history resources start anew in the next frame (`wasReset`). Kept results of cached passes stay.
    void resetHistory();
    /// Cached passes run again in the next frame.
    void forgetCachedResults();
    /// Texels of this texture may be negative (directions, spherical harmonics): they are not counted. By name of the resource.
    void allowNegative(std::string_view resourceName);

    // Static things: immutable in the eyes of the graph. Ids are never reused.
    StaticTexture registerTexture(std::string_view name, gl::Texture&& texture);
    /// As above, read through this sampler wherever it is bound (without one: bilinear on level 0, clamped).
    StaticTexture registerTexture(std::string_view name, gl::Texture&& texture,
                                  const gl::SamplerSpec& sampler);
    StaticBuffer registerBuffer(std::string_view name, gl::Buffer&& buffer);
    StaticGeometry registerGeometry(std::string_view name, const GeometryDesc& desc);
    void release(StaticTexture texture);
    void release(StaticBuffer buffer);
    void release(StaticGeometry geometry);
    [[nodiscard]] gl::Texture& texture(StaticTexture texture);
    [[nodiscard]] gl::Buffer& buffer(StaticBuffer buffer);

    // After execute(), until the next beginFrame(): outputs, persistent and history resources, results of cached passes; with
    // ExecutorOptions::keepAll everything that was written. Each waits for the GPU.
    /// As floats (integers are converted), top row first: the one place where pictures are turned. One layer or slice of one level.
    [[nodiscard]] Image readImage(TextureHandle handle, int layer = 0, int mip = 0);
    /// The texels as they are stored, GL's order (lower row first), all layers of one level.
    [[nodiscard]] std::vector<std::byte> readTexels(TextureHandle handle, int mip = 0);
    [[nodiscard]] std::vector<std::byte> readBuffer(BufferHandle handle);
    /// The GL name, to show it in a viewport. 0 where the resource is absent.
    [[nodiscard]] uint32_t textureName(TextureHandle handle) const;

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace tyndall::fg
