// The part of compile() that gives resources their storage: lifetimes, sharing, and the barriers between uses.

#include <bit>
#include <iterator>

#include "framegraph/compile.h"

namespace tyndall::fg {

void Compiler::fillPasses() {
    const auto& passes = graph_->passes();
    for (const UseRecord& use : graph_->uses()) {
        const VersionRecord& version = graph_->versions()[use.version];
        result_->uses.push_back({version.resource, version.number, use.access, use.where});
    }
    for (uint32_t i = 0; i < passes.size(); ++i) {
        const PassRecord& record = passes[i];
        CompiledPass& pass = result_->passes.emplace_back();
        pass.name = record.name;
        pass.uses = record.uses;
        pass.data = record.data;
        pass.execute = record.execute;
        pass.where = record.where;
        if (record.skipped) {
            pass.status = PassStatus::Skipped;
            pass.reason = record.reason;
        } else if (cached_[i]) {
            pass.status = PassStatus::Cached;
            pass.reason = "its inputs did not change";
        } else if (!live_[i]) {
            pass.status = PassStatus::Culled;
            explainCulling(i);
        }
    }
}

void Compiler::fillResources() {
    for (const ResourceRecord& record : graph_->resources()) {
        const uint32_t index = uint32_t(result_->resources.size());
        CompiledResource& resource = result_->resources.emplace_back();
        resource.name = record.name;
        resource.isBuffer = record.isBuffer;
        resource.texture = record.texture;
        resource.buffer = record.buffer;
        resource.bytes = index == 0        ? 0
                         : record.isBuffer ? record.buffer.bytes
                                           : byteSize(record.texture);
        resource.origin = record.origin;
        resource.isOutput = record.isOutput;
        resource.staticId = record.staticId;
        if (kept_[index] != kNoIndex) {
            resource.persistent = kept_[index];
            if (record.origin == ResourceOrigin::Transient) resource.origin = ResourceOrigin::Kept;
            const bool current = record.origin == ResourceOrigin::HistoryCurrent;
            resource.clearFirst = !current && resource.origin != ResourceOrigin::Kept &&
                                  persistent_->entry(resource.persistent / 2).content == 0;
        }
    }
}

void Compiler::useResource(uint32_t index, uint32_t pass) {
    CompiledResource& resource = result_->resources[index];
    resource.used = true;
    if (resource.firstPass == kNoIndex) resource.firstPass = pass;
    resource.lastPass = pass;
}

/// From the first running pass that uses a resource to the last. A state that a skipped pass left alone belongs to the storage
/// that holds it.
void Compiler::findLifetimes() {
    for (uint32_t i = 0; i < result_->passes.size(); ++i) {
        const CompiledPass& pass = result_->passes[i];
        if (pass.status == PassStatus::Skipped || pass.status == PassStatus::Culled) continue;
        for (uint32_t k = pass.uses.first; k < pass.uses.first + pass.uses.count; ++k) {
            const UseRecord& use = graph_->uses()[k];
            const VersionRecord& version = graph_->versions()[use.version];
            CompiledResource& resource = result_->resources[version.resource];
            if (pass.status == PassStatus::Cached) {
                if (isWrite(use.access)) resource.used = true;
                continue;
            }
            if (version.absent) continue; // a stand-in is bound instead
            if (!isWrite(use.access)) {
                useResource(version.resource, i);
                continue;
            }
            // Something was skipped here before: what this pass does not write must read as nothing.
            if (version.previous != kNoIndex && graph_->versions()[version.previous].absent)
                resource.clearFirst = true;
            useResource(version.resource, i);
            resource.written = true;
            resource.finalContent = content_[use.version];
        }
    }
    for (uint32_t i = 1; i < result_->resources.size(); ++i) {
        CompiledResource& resource = result_->resources[i];
        if (resource.origin == ResourceOrigin::Kept && resource.used)
            persistent_->touch(resource.persistent / 2);
        if (resource.origin == ResourceOrigin::HistoryCurrent && !resource.written)
            resource.aliasOf = graph_->resources()[i].previousHalf;
        if (options_.keepAll && resource.firstPass != kNoIndex)
            resource.lastPass = uint32_t(result_->passes.size());
        if (resource.isOutput && resource.firstPass != kNoIndex)
            resource.lastPass = uint32_t(result_->passes.size());
    }
}

/// The resources that begin (or end) to hold storage at this pass, as a range of resourceLists.
void Compiler::listResourcesOf(uint32_t passIndex, bool acquire, Range& range) {
    range.first = uint32_t(result_->resourceLists.size());
    const CompiledPass& pass = result_->passes[passIndex];
    for (const ResourceUse& use : result_->usesOf(pass)) {
        const CompiledResource& resource = result_->resources[use.resource];
        if ((acquire ? resource.firstPass : resource.lastPass) != passIndex) continue;
        bool listed = false; // a pass may use one resource in several ways
        for (uint32_t i = range.first; i < result_->resourceLists.size(); ++i)
            listed |= result_->resourceLists[i] == use.resource;
        if (!listed) result_->resourceLists.push_back(use.resource);
    }
    range.count = uint32_t(result_->resourceLists.size()) - range.first;
}

uint32_t Compiler::takeSlot(const CompiledResource& resource) {
    auto& slots = result_->slots;
    for (uint32_t i = 0; i < slots.size(); ++i) {
        const bool fits = slots[i].isBuffer == resource.isBuffer &&
                          slots[i].texture == resource.texture &&
                          slots[i].buffer == resource.buffer;
        if (!fits || slotTaken_[i]) continue;
        slotTaken_[i] = 1;
        return i;
    }
    slots.push_back({resource.isBuffer, resource.texture, resource.buffer});
    slotTaken_.push_back(1);
    return uint32_t(slots.size() - 1);
}

void Compiler::assignSlots() {
    slotTaken_.clear();
    for (uint32_t i = 0; i < result_->passes.size(); ++i) {
        if (result_->passes[i].status != PassStatus::Ran) continue;
        Range acquires, releases;
        listResourcesOf(i, true, acquires);
        listResourcesOf(i, false, releases);
        for (const uint32_t index : result_->list(acquires)) {
            CompiledResource& resource = result_->resources[index];
            if (resource.origin == ResourceOrigin::Transient) resource.slot = takeSlot(resource);
        }
        for (const uint32_t index : result_->list(releases))
            if (const uint32_t slot = result_->resources[index].slot;
                slot != kNoIndex && !options_.keepAll)
                slotTaken_[slot] = 0;
        result_->passes[i].acquires = acquires;
        result_->passes[i].releases = releases;
    }
}

/// Nobody acquires these, so nobody would clear them before they are read back.
void Compiler::listUntouchedOutputs() {
    Range& range = result_->untouchedOutputs;
    range.first = uint32_t(result_->resourceLists.size());
    for (uint32_t i = 1; i < result_->resources.size(); ++i) {
        const CompiledResource& resource = result_->resources[i];
        const uint32_t held = resource.aliasOf != kNoIndex ? resource.aliasOf : i;
        const bool untouched =
            resource.firstPass == kNoIndex && result_->resources[held].firstPass == kNoIndex;
        if (resource.isOutput && untouched && result_->resources[held].clearFirst)
            result_->resourceLists.push_back(held);
    }
    range.count = uint32_t(result_->resourceLists.size()) - range.first;
}

/// Uses of one storage are ordered against each other, whatever the resources in it are called.
uint32_t Compiler::storageOf(uint32_t index) const {
    const CompiledResource& resource = result_->resources[index];
    const uint32_t slots = uint32_t(result_->slots.size());
    if (resource.slot != kNoIndex) return resource.slot;
    if (resource.aliasOf != kNoIndex) return slots + resource.aliasOf;
    if (resource.origin == ResourceOrigin::Imported) // may have been imported under several names
        for (uint32_t i = 1; i < index; ++i) {
            const CompiledResource& other = result_->resources[i];
            if (other.origin == ResourceOrigin::Imported && other.staticId == resource.staticId &&
                other.isBuffer == resource.isBuffer)
                return slots + i;
        }
    return slots + index;
}

/// A barrier orders everything before it, so it also serves later passes: a bit is only asked for again after a newer write.
/// Across frames the executor puts one full barrier.
void Compiler::findBarriers() {
    storage_.assign(result_->slots.size() + result_->resources.size(), {-1, -1});
    int32_t issued[32]; // pass before which each bit was last asked for
    for (int32_t& pass : issued) pass = 0;
    for (uint32_t i = 0; i < result_->passes.size(); ++i) {
        CompiledPass& pass = result_->passes[i];
        if (pass.status != PassStatus::Ran) continue;
        for (const ResourceUse& use : result_->usesOf(pass)) {
            const StorageState& state = storage_[storageOf(use.resource)];
            const bool isBuffer = result_->resources[use.resource].isBuffer;
            const bool stores =
                use.access ==
                Access::StorageWrite; // must wait for every earlier use, not for stores alone
            const int32_t since = stores ? state.lastAccess : state.lastStorageWrite;
            if (since < 0) continue;
            const Access before =
                since == state.lastStorageWrite ? Access::StorageWrite : Access::Sampled;
            for (uint32_t bits = barrierBits(before, use.access, isBuffer); bits != 0;
                 bits &= bits - 1)
                if (issued[std::countr_zero(bits)] <= since) pass.barriers |= bits & (~bits + 1);
        }
        for (uint32_t bits = pass.barriers; bits != 0; bits &= bits - 1)
            issued[std::countr_zero(bits)] = int32_t(i);
        for (const ResourceUse& use : result_->usesOf(pass)) {
            StorageState& state = storage_[storageOf(use.resource)];
            state.lastAccess = int32_t(i);
            if (use.access == Access::StorageWrite) state.lastStorageWrite = int32_t(i);
        }
    }
}

} // namespace tyndall::fg
