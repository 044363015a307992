#pragma once
// The textures and buffers behind the graph's resources: a pool for transient ones, one place each for those that outlive the frame,
// and stand-ins for absent ones.

#include <cstdint>
#include <memory>
#include <vector>

#include "framegraph/compiled_graph.h"
#include "framegraph/persistent_table.h"
#include "gl/buffer.h"
#include "gl/framebuffer.h"
#include "gl/texture.h"

namespace tyndall::fg {

/// A texture or a buffer, with the views of the texture that were asked for.
class Storage {
public:
    Storage() = default;
    Storage(std::string_view name, const TextureDesc& desc);
    Storage(std::string_view name, const BufferDesc& desc);

    gl::Texture texture; // one of the two
    gl::Buffer buffer;
    Format format = Format::RGBA32F;

    /// Level `mip` (−1: all levels) and layer `layer` (−1: all) as a texture; a single layer as 2D where `as2D`.
    gl::Texture& view(int mip, int layer, bool as2D);
    /// All texels, levels and bytes become zero.
    void clearToZero();
    /// All texels and bytes become what nobody should read: NaN, or all bits set.
    void poison();
    [[nodiscard]] uint64_t bytes() const {
        return texture ? uint64_t(texture.bytes()) : buffer.bytes();
    }

private:
    struct View {
        int mip, layer;
        bool as2D;
        std::unique_ptr<gl::Texture> texture;
    };
    std::vector<View> views_;
};

class StorageSet {
public:
    /// Frames after which pooled storage that nothing used is freed.
    static constexpr uint64_t kFramesKept = 8;

    /// `framebuffers` forgets textures that go.
    explicit StorageSet(gl::FramebufferCache& framebuffers) : framebuffers_(framebuffers) {}

    /// All pooled storage is free again; what was unused for long goes, as does persistent storage whose entry changed.
    void beginFrame(const PersistentTable& table);
    /// Storage for every slot of the frame, from the pool or new.
    /// Throws gl::NoRoom where a driver on the processor would take more memory than there is: it hands out what nobody has.
    void assignSlots(const CompiledGraph& graph);

    Storage& slot(uint32_t index) { return *slots_[index]; }
    /// The storage of a persistent entry's half, made on first use.
    Storage& persistent(const PersistentTable& table, uint32_t storageIndex, std::string_view name);
    /// 1×1 of zeros, or NaN in poison mode.
    Storage& absentTexture(const TextureDesc& desc, bool poison);
    /// kAbsentBytes of zeros, or of set bits.
    Storage& absentBuffer(bool poison);
    static constexpr uint64_t kAbsentBytes =
        64 * 1024; // no uniform block is larger on every driver

    struct Totals {
        uint64_t bytes = 0;
        uint32_t textures = 0, buffers = 0;
    };
    [[nodiscard]] Totals totals() const;

private:
    void checkRoom(const CompiledGraph& graph) const;
    struct Pooled {
        std::unique_ptr<Storage> storage;
        PoolSlot shape;
        uint64_t lastFrame = 0;
    };
    struct Persistent {
        std::unique_ptr<Storage> storage;
        uint32_t generation = 0;
    };
    struct Absent {
        TextureKind kind;
        Format format;
        bool poison;
        std::unique_ptr<Storage> storage;
    };
    Storage& takePooled(const PoolSlot& shape);
    void drop(std::unique_ptr<Storage>& storage);

    gl::FramebufferCache& framebuffers_;
    std::vector<Pooled> pool_;
    std::vector<Storage*> slots_;
    std::vector<Persistent> persistent_;
    std::vector<Absent> absent_;
    std::unique_ptr<Storage> absentBuffers_[2];
    uint64_t frame_ = 1;
};

} // namespace tyndall::fg
