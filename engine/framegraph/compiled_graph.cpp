#include "framegraph/compiled_graph.h"

namespace tyndall::fg {

const char* statusName(PassStatus status) {
    switch (status) {
    case PassStatus::Ran: return "ran";
    case PassStatus::Skipped: return "skipped";
    case PassStatus::Cached: return "cached";
    case PassStatus::Culled: return "culled";
    }
    return "?";
}

const char* originName(ResourceOrigin origin) {
    switch (origin) {
    case ResourceOrigin::Transient: return "transient";
    case ResourceOrigin::Kept: return "kept";
    case ResourceOrigin::Persistent: return "persistent";
    case ResourceOrigin::HistoryPrevious: return "history, previous";
    case ResourceOrigin::HistoryCurrent: return "history, current";
    case ResourceOrigin::Imported: return "imported";
    }
    return "?";
}

uint64_t CompiledGraph::pooledBytes() const {
    uint64_t bytes = 0;
    for (const PoolSlot& slot : slots)
        bytes += slot.isBuffer ? slot.buffer.bytes : byteSize(slot.texture);
    return bytes;
}

uint64_t CompiledGraph::unpooledBytes() const {
    uint64_t bytes = 0;
    for (const CompiledResource& resource : resources)
        if (resource.slot != kNoIndex) bytes += resource.bytes;
    return bytes;
}

} // namespace tyndall::fg
