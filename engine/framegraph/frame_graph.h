#pragma once
// The frame graph as a pass author sees it: Builder declares a pass, PassContext (pass_context.h) runs it, FrameGraph takes both. Pure-virtual
// interfaces with plain data across them (so that a plugin in a shared library uses the very same API) and thin templates on top.
//
//   struct Data { fg::TextureHandle in, out; Params params; };                // trivially copyable
//   const Data& pass = graph.addPass<Data>("gi.lpv.inject",
//       [&](fg::Builder& b, Data& d) { d.in = b.read(rsm); d.out = b.create("gi.lpv.sh", desc); },
//       [](const Data& d, fg::PassContext& c) { c.compute("gi/lpv/inject.comp").bind("rsm", d.in)…; });
//
// Setup runs at once and only declares; execute is captureless and runs later, if at all. The graph is rebuilt
// every frame. Errors (two writers of one version, reading what was never written, binding what was not
// declared) are collected with pass, resource and source line, and reported together by compile().

#include <cstddef>
#include <cstdint>
#include <new>
#include <source_location>
#include <type_traits>

#include "framegraph/access.h"
#include "framegraph/handle.h"
#include "framegraph/pass_context.h"
#include "framegraph/resource_desc.h"

namespace tyndall::fg {

/// Declares what one pass reads and writes. Only valid inside the setup function.
class Builder {
public:
    /// The pass reads `handle`'s content. Returns the handle, to be stored in the pass's data.
    virtual TextureHandle readTexture(TextureHandle handle, Access access,
                                      const std::source_location& where) = 0;
    virtual BufferHandle readBuffer(BufferHandle handle, Access access,
                                    const std::source_location& where) = 0;
    /// The pass writes to the resource; returns the next version, which later readers must use.
    virtual TextureHandle writeTexture(TextureHandle handle, Access access,
                                       const std::source_location& where) = 0;
    virtual BufferHandle writeBuffer(BufferHandle handle, Access access,
                                     const std::source_location& where) = 0;
    /// A new transient resource, written first by this pass. Undefined content (NaN in poison mode).
    virtual TextureHandle createTexture(const char* name, const TextureDesc& desc, Access access,
                                        const std::source_location& where) = 0;
    virtual BufferHandle createBuffer(const char* name, const BufferDesc& desc, Access access,
                                      const std::source_location& where) = 0;

    /// The pass is not needed this frame; `reason` names the cause ("no medium in the scene") and is copied.
    /// Its writes keep the content of the version before; what it creates is *absent* (FrameGraph::isAbsent).
    virtual void skip(const char* reason) = 0;
    /// The pass's result depends on nothing but its inputs' content and `key` (a hash of its settings, a
    /// scene version): when neither changed since it last ran, its created resources are kept and it does not run. What it
    /// writes without reading it must not depend on the old content.
    virtual void cacheBy(uint64_t key) = 0;
    /// Runs even if nobody reads its outputs (read-backs, debug counters).
    virtual void sideEffect() = 0;

    TextureHandle read(TextureHandle h, Access access = Access::Sampled,
                       const std::source_location& where = std::source_location::current()) {
        return readTexture(h, access, where);
    }
    BufferHandle read(BufferHandle h, Access access = Access::StorageRead,
                      const std::source_location& where = std::source_location::current()) {
        return readBuffer(h, access, where);
    }
    TextureHandle write(TextureHandle h, Access access = Access::StorageWrite,
                        const std::source_location& where = std::source_location::current()) {
        return writeTexture(h, access, where);
    }
    BufferHandle write(BufferHandle h, Access access = Access::StorageWrite,
                       const std::source_location& where = std::source_location::current()) {
        return writeBuffer(h, access, where);
    }
    TextureHandle create(const char* name, const TextureDesc& desc,
                         Access access = Access::StorageWrite,
                         const std::source_location& where = std::source_location::current()) {
        return createTexture(name, desc, access, where);
    }
    BufferHandle create(const char* name, const BufferDesc& desc,
                        Access access = Access::StorageWrite,
                        const std::source_location& where = std::source_location::current()) {
        return createBuffer(name, desc, access, where);
    }

protected:
    ~Builder() = default;
};

/// A resource with a past: `previous` holds what `current` held last frame (the same pass must write all of
/// `current`). `wasReset` is true in the first frame, after a change of size, and after resetHistory(). Where the writer of
/// `current` is skipped or culled nothing advances: `current` then reads as `previous`, which stays for the next frame.
struct TextureHistory {
    TextureHandle previous, current;
    bool wasReset;
};

/// A resource that outlives the frame. `wasReset` is true while nothing has been written to it since it was created, changed its
/// description or was reset: it then holds zeros (NaN in poison mode).
struct PersistentTexture {
    TextureHandle handle;
    bool wasReset;
};
struct PersistentBuffer {
    BufferHandle handle;
    bool wasReset;
};

using ExecuteFunction = void (*)(const void* data, PassContext& context);

/// The graph of one frame.
class FrameGraph {
public:
    virtual TextureDesc desc(TextureHandle handle) const = 0;
    virtual BufferDesc desc(BufferHandle handle) const = 0;
    /// True when `handle`'s producer was skipped: readers choose another variant, or skip as well.
    virtual bool isAbsent(TextureHandle handle) const = 0;
    virtual bool isAbsent(BufferHandle handle) const = 0;
    /// A resource that outlives the frame, registered with the executor under `name`.
    virtual TextureHistory historyTexture(const char* name, const TextureDesc& desc) = 0;
    /// A single resource that outlives the frame, found again by `name`: an accumulation buffer. Whoever reads and writes it in
    /// one pass declares both. Passes that write to it are never culled.
    virtual PersistentTexture persistentTexture(const char* name, const TextureDesc& desc) = 0;
    virtual PersistentBuffer persistentBuffer(const char* name, const BufferDesc& desc) = 0;
    /// Brings something registered with the executor under the graph's eyes: ordered, dumped, and an input of cached passes.
    /// `contentVersion` (core/version.h) changes whenever its content does.
    virtual TextureHandle importTexture(const char* name, StaticTexture texture,
                                        const TextureDesc& desc, uint64_t contentVersion) = 0;
    virtual BufferHandle importBuffer(const char* name, StaticBuffer buffer, const BufferDesc& desc,
                                      uint64_t contentVersion) = 0;
    /// Content that must exist at the end: everything that it does not need is culled.
    virtual void markOutput(TextureHandle handle) = 0;
    virtual void markOutput(BufferHandle handle) = 0;

    /// Adds a pass. `Data` is trivially copyable and lives in the graph's arena until the frame ends.
    template <typename Data, typename Setup, typename Execute>
    const Data& addPass(const char* name, Setup&& setup, Execute,
                        const std::source_location& where = std::source_location::current()) {
        static_assert(std::is_trivially_copyable_v<Data> && std::is_trivially_destructible_v<Data>);
        static_assert(std::is_empty_v<Execute>,
                      "execute must not capture: put what it needs into Data");
        Builder& builder = beginPass(name, where);
        Data* data = static_cast<Data*>(allocate(sizeof(Data), alignof(Data)));
        new (data) Data{};
        setup(builder, *data);
        endPass(data, [](const void* d, PassContext& context) {
            Execute{}(*static_cast<const Data*>(d), context);
        });
        return *data;
    }

protected:
    virtual Builder& beginPass(const char* name, const std::source_location& where) = 0;
    virtual void* allocate(size_t bytes, size_t alignment) = 0;
    virtual void endPass(const void* data, ExecuteFunction execute) = 0;
    ~FrameGraph() = default;
};

} // namespace tyndall::fg
