#pragma once
// What the graph remembers between frames: which resources outlive the frame and what they hold. It knows descriptions and
// content numbers; the storage itself is the executor's, found by the same index.

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "framegraph/compiled_graph.h"

namespace tyndall::fg {

enum class PersistentKind : uint32_t { Kept = 0, Single = 1, History = 2 };

/// One entry; a history has two halves, the others use half 0. Storage index = entry · 2 + half.
struct PersistentEntry {
    std::string name;
    uint64_t key = 0;
    PersistentKind kind = PersistentKind::Single;
    bool isBuffer = false;
    TextureDesc texture;
    BufferDesc buffer;
    uint64_t content =
        0; // of the half that readers see; 0: nothing was written since creation or reset
    uint32_t previousHalf = 0; // History: the half that holds last frame's content
    uint32_t generation = 0;   // rises when the storage must be made anew
    uint64_t lastFrame = 0;    // in which it was declared or kept
    bool alive = false;
};

class PersistentTable {
public:
    /// Frames after which an entry that nobody asked for gives its storage back.
    static constexpr uint64_t kFramesKept = 8;

    /// Counts frames and drops entries that were not used for kFramesKept frames.
    void beginFrame();
    [[nodiscard]] uint64_t frame() const { return frame_; }

    /// The entry of this name, made or remade where the description differs. `salt` tells equal names apart. Kept entries
    /// must be touched as well, or they go.
    uint32_t findTexture(PersistentKind kind, std::string_view name, uint64_t salt,
                         const TextureDesc& desc);
    uint32_t findBuffer(PersistentKind kind, std::string_view name, uint64_t salt,
                        const BufferDesc& desc);
    void touch(uint32_t index) { entries_[index].lastFrame = frame_; }
    [[nodiscard]] const PersistentEntry& entry(uint32_t index) const { return entries_[index]; }
    [[nodiscard]] const std::vector<PersistentEntry>& entries() const { return entries_; }

    /// Records what the frame wrote; called once the compiled graph has run.
    void commit(const CompiledGraph& graph);

    void resetHistory();  // Single and History
    void forgetResults(); // Kept

private:
    uint32_t find(PersistentKind kind, std::string_view name, uint64_t salt, bool isBuffer,
                  const TextureDesc& texture, const BufferDesc& buffer);
    std::vector<PersistentEntry> entries_;
    std::unordered_map<uint64_t, uint32_t> byKey_;
    std::vector<uint32_t> free_;
    uint64_t frame_ = 0;
};

} // namespace tyndall::fg
