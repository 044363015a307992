#include "framegraph/persistent_table.h"

#include "core/check.h"
#include "framegraph/hash.h"

namespace tyndall::fg {

void PersistentTable::beginFrame() {
    ++frame_;
    for (uint32_t i = 0; i < entries_.size(); ++i) {
        PersistentEntry& entry = entries_[i];
        if (!entry.alive || entry.lastFrame + kFramesKept >= frame_) continue;
        byKey_.erase(entry.key);
        entry.alive = false;
        entry.content = 0;
        ++entry.generation;
        free_.push_back(i);
    }
}

uint32_t PersistentTable::findTexture(PersistentKind kind, std::string_view name, uint64_t salt,
                                      const TextureDesc& desc) {
    return find(kind, name, salt, false, desc, {});
}

uint32_t PersistentTable::findBuffer(PersistentKind kind, std::string_view name, uint64_t salt,
                                     const BufferDesc& desc) {
    return find(kind, name, salt, true, {}, desc);
}

uint32_t PersistentTable::find(PersistentKind kind, std::string_view name, uint64_t salt,
                               bool isBuffer, const TextureDesc& texture,
                               const BufferDesc& buffer) {
    const uint64_t key =
        mixHash(mixHash(hashName(name), salt), uint64_t(kind) * 2 + (isBuffer ? 1 : 0));
    const auto found = byKey_.find(key);
    if (found != byKey_.end()) {
        PersistentEntry& entry = entries_[found->second];
        CHECK(entry.name == name, "two names of persistent resources have one hash");
        if (kind != PersistentKind::Kept) entry.lastFrame = frame_;
        if (entry.texture == texture && entry.buffer == buffer) return found->second;
        entry.texture = texture;
        entry.buffer = buffer;
        entry.content = 0;
        ++entry.generation;
        return found->second;
    }
    uint32_t index = uint32_t(entries_.size());
    if (free_.empty()) {
        entries_.emplace_back();
    } else {
        index = free_.back();
        free_.pop_back();
    }
    PersistentEntry& entry = entries_[index];
    entry = {std::string(name),    key,    kind, isBuffer, texture, buffer, 0, 0,
             entry.generation + 1, frame_, true};
    byKey_.emplace(key, index);
    return index;
}

void PersistentTable::commit(const CompiledGraph& graph) {
    for (const CompiledResource& resource : graph.resources) {
        if (resource.persistent == kNoIndex || !resource.written) continue;
        PersistentEntry& entry = entries_[resource.persistent / 2];
        entry.content = resource.finalContent;
        if (resource.origin == ResourceOrigin::HistoryCurrent)
            entry.previousHalf = resource.persistent % 2;
    }
}

void PersistentTable::resetHistory() {
    for (PersistentEntry& entry : entries_)
        if (entry.kind != PersistentKind::Kept) entry.content = 0;
}

void PersistentTable::forgetResults() {
    for (PersistentEntry& entry : entries_)
        if (entry.kind == PersistentKind::Kept) entry.content = 0;
}

} // namespace tyndall::fg
