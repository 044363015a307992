// The part of compile() that decides which cached passes need not run.
//
// Every version of every resource gets a number that stands for its content. A cached pass promises that its results follow
// from its key and its inputs, so the number of what it writes is a hash of those; the number of anything else that a
// pass writes is new in every frame. Storage remembers the number of what it holds: where that is the number that the frame
// would end with, the passes that write there have nothing to do.

#include "framegraph/compile.h"
#include "framegraph/hash.h"

namespace tyndall::fg {
namespace {

constexpr uint64_t kAbsentContent = 0x5bd1e995u;

uint64_t hashDesc(uint64_t seed, const ResourceRecord& resource) {
    if (resource.isBuffer) return mixHash(seed, resource.buffer.bytes);
    const TextureDesc& d = resource.texture;
    uint64_t h = mixHash(seed, uint64_t(d.kind) << 32 | uint64_t(d.format));
    h = mixHash(h, uint64_t(uint32_t(d.width)) << 32 | uint32_t(d.height));
    return mixHash(h, uint64_t(uint32_t(d.depth)) << 32 | uint32_t(d.mips));
}

} // namespace

/// Storage that stays, for what cached passes create. Found by the names of pass and resource and, among equals, by number.
void Compiler::findKeptEntries() {
    const auto& resources = graph_->resources();
    kept_.assign(resources.size(), kNoIndex);
    for (uint32_t i = 1; i < resources.size(); ++i) {
        const ResourceRecord& resource = resources[i];
        if (resource.origin != ResourceOrigin::Transient) {
            kept_[i] = resource.persistent;
            continue;
        }
        const PassRecord& creator = graph_->passes()[resource.creator];
        if (!creator.cacheable || creator.skipped || !demanded_[resource.creator]) continue;
        const uint64_t salt = hashName(creator.name);
        uint64_t twins = 0;
        for (uint32_t k = 1; k < i; ++k)
            twins += kept_[k] != kNoIndex && resources[k].origin == ResourceOrigin::Transient &&
                     resources[k].isBuffer == resource.isBuffer &&
                     resources[k].name == resource.name &&
                     graph_->passes()[resources[k].creator].name == creator.name;
        const uint32_t entry =
            resource.isBuffer ? persistent_->findBuffer(PersistentKind::Kept, resource.name,
                                                        mixHash(salt, twins), resource.buffer)
                              : persistent_->findTexture(PersistentKind::Kept, resource.name,
                                                         mixHash(salt, twins), resource.texture);
        kept_[i] = entry * 2;
    }
}

void Compiler::numberContents() {
    const auto& versions = graph_->versions();
    content_.assign(versions.size(), 0);
    for (uint32_t v = 0; v < versions.size(); ++v) {
        if (versions[v].writer != kNoIndex) continue;
        const ResourceRecord& resource = graph_->resources()[versions[v].resource];
        // Small numbers name both imports and entries: the kind keeps them apart.
        if (resource.origin == ResourceOrigin::Imported)
            content_[v] = mixHash(mixHash(resource.isBuffer ? 2 : 1, resource.staticId),
                                  resource.importedContent);
        else
            content_[v] = mixHash(mixHash(3, resource.persistent / 2),
                                  persistent_->entry(resource.persistent / 2).content);
    }
    for (uint32_t passIndex = 0; passIndex < graph_->passes().size(); ++passIndex) {
        const PassRecord& pass = graph_->passes()[passIndex];
        const uint64_t signature =
            pass.skipped     ? 0
            : pass.cacheable ? signatureOf(passIndex)
                             : mixHash(mixHash(kHashStart, persistent_->frame()), passIndex);
        for (uint32_t i = pass.uses.first, written = 0; i < pass.uses.first + pass.uses.count;
             ++i) {
            const UseRecord& use = graph_->uses()[i];
            if (!isWrite(use.access)) continue;
            const VersionRecord& version = versions[use.version];
            if (!version.skipped)
                content_[use.version] =
                    mixHash(signature, written++) | 1; // never 0, which means "nothing written"
            else
                content_[use.version] =
                    version.previous == kNoIndex ? kAbsentContent : content_[version.previous];
        }
    }
}

/// What a cached pass's results follow from: its name, its key, its inputs, and the shape of what it writes.
uint64_t Compiler::signatureOf(uint32_t passIndex) const {
    const PassRecord& pass = graph_->passes()[passIndex];
    uint64_t signature = mixHash(hashName(pass.name), pass.key);
    for (uint32_t i = pass.uses.first; i < pass.uses.first + pass.uses.count; ++i) {
        const UseRecord& use = graph_->uses()[i];
        const VersionRecord& version = graph_->versions()[use.version];
        if (!isWrite(use.access)) {
            if (!use.ownVersion) signature = mixHash(signature, content_[use.version]);
            continue;
        }
        signature = hashDesc(signature, graph_->resources()[version.resource]);
        // Old content from this frame shows through; content from outside it may only be written over (see Builder::cacheBy).
        if (version.previous != kNoIndex && graph_->versions()[version.previous].writer != kNoIndex)
            signature = mixHash(signature, content_[version.previous]);
    }
    return signature;
}

/// The version that each resource ends the frame with.
void Compiler::findFinalVersions() {
    const auto& resources = graph_->resources();
    final_.assign(resources.size(), kNoIndex);
    for (uint32_t i = 1; i < resources.size(); ++i) {
        uint32_t version = resources[i].latest;
        while (version != kNoIndex) {
            const VersionRecord& record = graph_->versions()[version];
            if (record.writer == kNoIndex || (!record.skipped && demanded_[record.writer])) break;
            version = record.previous;
        }
        final_[i] = version;
    }
}

void Compiler::findCached() {
    cached_.assign(graph_->passes().size(), 0);
    for (uint32_t i = 0; i < graph_->passes().size(); ++i) {
        const PassRecord& pass = graph_->passes()[i];
        cached_[i] = pass.cacheable && !pass.skipped && demanded_[i] && resultsHeld(i);
    }
    while (dropBrokenChains()) {
    }
}

/// Does the storage of everything that the pass writes hold what the frame would end with?
bool Compiler::resultsHeld(uint32_t passIndex) const {
    const Range range = graph_->passes()[passIndex].uses;
    bool writes = false;
    for (uint32_t i = range.first; i < range.first + range.count; ++i) {
        const UseRecord& use = graph_->uses()[i];
        if (!isWrite(use.access)) continue;
        const uint32_t resource = graph_->versions()[use.version].resource;
        if (kept_[resource] == kNoIndex)
            return false; // imported, or made by a pass that is not cached
        if (persistent_->entry(kept_[resource] / 2).content != content_[final_[resource]])
            return false;
        writes = true;
    }
    return writes;
}

/// Passes that write one resource one after the other are cached together or not at all, and only while no running pass
/// wants a state in between. Returns true where a pass lost its result, which may break another chain.
bool Compiler::dropBrokenChains() {
    bool dropped = false;
    const auto drop = [&](uint32_t pass) {
        dropped |= cached_[pass] != 0;
        cached_[pass] = 0;
    };
    for (uint32_t passIndex = 0; passIndex < graph_->passes().size(); ++passIndex) {
        const PassRecord& pass = graph_->passes()[passIndex];
        if (pass.skipped || cached_[passIndex] || !demanded_[passIndex]) continue;
        for (uint32_t i = pass.uses.first; i < pass.uses.first + pass.uses.count; ++i) {
            const UseRecord& use = graph_->uses()[i];
            const VersionRecord& used = graph_->versions()[use.version];
            const bool wantsFinal = !isWrite(use.access) &&
                                    graph_->contentVersion(use.version) == final_[used.resource];
            if (wantsFinal) continue;
            for (uint32_t v = graph_->resources()[used.resource].latest; v != kNoIndex;
                 v = graph_->versions()[v].previous)
                if (const uint32_t writer = graph_->versions()[v].writer;
                    writer != kNoIndex && writer != passIndex)
                    drop(writer);
        }
    }
    return dropped;
}

} // namespace tyndall::fg
