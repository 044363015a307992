#pragma once
// Where the content that a handle means lies in this frame.

#include "framegraph/frame_graph_impl.h"

namespace tyndall::fg {

enum class PlaceKind : uint32_t {
    None = 0,       // no pass that ran made it
    Absent = 1,     // its producer was skipped: a stand-in
    Slot = 2,       // index into CompiledGraph::slots
    Persistent = 3, // storage index of the PersistentTable
    Static = 4,     // id of a registered texture or buffer
};

struct StoragePlace {
    PlaceKind kind = PlaceKind::None;
    uint32_t index = 0;
    bool operator==(const StoragePlace&) const = default;
};

/// The storage of a resource, whatever its version.
StoragePlace placeOf(const CompiledGraph& compiled, uint32_t resource);
/// The storage of one version: as above, but an absent version has a stand-in, and a history that a skipped pass left alone is its past.
StoragePlace placeOf(const FrameGraphImpl& graph, const CompiledGraph& compiled, uint32_t resource,
                     uint32_t version);

} // namespace tyndall::fg
