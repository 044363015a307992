#include "framegraph/storage_place.h"

#include "core/check.h"

namespace tyndall::fg {

StoragePlace placeOf(const CompiledGraph& compiled, uint32_t index) {
    const CompiledResource& resource = compiled.resources[index];
    if (resource.aliasOf != kNoIndex) return placeOf(compiled, resource.aliasOf);
    if (resource.slot != kNoIndex) return {PlaceKind::Slot, resource.slot};
    if (resource.origin == ResourceOrigin::Imported) return {PlaceKind::Static, resource.staticId};
    if (resource.persistent != kNoIndex) return {PlaceKind::Persistent, resource.persistent};
    return {};
}

StoragePlace placeOf(const FrameGraphImpl& graph, const CompiledGraph& compiled, uint32_t index,
                     uint32_t number) {
    const uint32_t version = graph.versionOf(index, number);
    CHECK(version != kNoIndex, "a handle that is not of this frame");
    const VersionRecord& record = graph.versions()[graph.contentVersion(version)];
    if (record.absent) return {PlaceKind::Absent, 0};
    const ResourceRecord& resource = graph.resources()[index];
    const bool past = resource.origin == ResourceOrigin::HistoryCurrent &&
                      record.writer == kNoIndex && number != 0;
    return placeOf(compiled, past ? resource.previousHalf : index);
}

} // namespace tyndall::fg
