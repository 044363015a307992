#pragma once
// What compile() makes of a recorded frame: plain data, read by the executor, the dumps and the editor.
// Names and reasons point into the graph's arena and live until the next frame begins.

#include <cstdint>
#include <source_location>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "framegraph/frame_graph.h"

namespace tyndall::fg {

enum class PassStatus : uint32_t {
    Ran = 0,     // will run, or did
    Skipped = 1, // the scene or the settings do not need it
    Cached = 2,  // its inputs did not change: the result is kept
    Culled = 3,  // nobody reads what it writes
};
const char* statusName(PassStatus status); // "ran", "skipped", "cached", "culled"

enum class ResourceOrigin : uint32_t {
    Transient = 0,       // pooled storage for this frame
    Kept = 1,            // created by a cached pass: its storage stays
    Persistent = 2,      // found again by name
    HistoryPrevious = 3, // the older half of a history
    HistoryCurrent = 4,  // the newer half
    Imported = 5,        // registered with the executor
};
const char* originName(ResourceOrigin origin);

inline constexpr uint32_t kNoIndex = 0xffffffffu;

/// One declared use of a resource by a pass.
struct ResourceUse {
    uint32_t resource; // index into CompiledGraph::resources
    uint32_t version;  // that is read, or that the write makes
    Access access;
    std::source_location where;
};

/// A range of one of CompiledGraph's flat lists.
struct Range {
    uint32_t first = 0, count = 0;
};

struct CompiledPass {
    std::string_view name;
    PassStatus status = PassStatus::Ran;
    std::string_view reason; // empty where it runs
    uint32_t barriers = 0;   // GL memory barrier bits before it
    Range uses;              // CompiledGraph::uses
    Range acquires,
        releases; // CompiledGraph::resourceLists: resources that get and lose their storage here
    const void* data = nullptr;
    ExecuteFunction execute = nullptr;
    std::source_location where;
};

struct CompiledResource {
    std::string_view name;
    bool isBuffer = false;
    TextureDesc texture; // where !isBuffer
    BufferDesc buffer;   // where isBuffer
    uint64_t bytes = 0;
    ResourceOrigin origin = ResourceOrigin::Transient;
    bool isOutput = false;
    bool used = false;    // a pass that runs touches it, or its content is kept
    bool written = false; // by a pass that runs
    bool clearFirst =
        false; // must hold zeros when it gets its storage: its creator was skipped, a later pass writes
    uint32_t firstPass = kNoIndex; // first and last pass that runs and uses it
    uint32_t lastPass = kNoIndex;
    uint32_t slot =
        kNoIndex; // Transient: storage, shared by resources with one description and disjoint lifetimes
    uint32_t persistent =
        kNoIndex; // Kept, Persistent, History…: storage index of the PersistentTable
    uint32_t aliasOf =
        kNoIndex; // HistoryCurrent that no pass writes in this frame: index of its HistoryPrevious
    uint32_t staticId = 0;     // Imported
    uint64_t finalContent = 0; // identifies its content at the end of the frame
};

/// Storage that transient resources share.
struct PoolSlot {
    bool isBuffer;
    TextureDesc texture;
    BufferDesc buffer;
};

/// Vectors keep their capacity from frame to frame, so that compiling stops allocating after the first frames.
struct CompiledGraph {
    std::vector<CompiledPass> passes; // in order of execution, which is the order of declaration
    std::vector<CompiledResource> resources; // index 0 is the null resource
    std::vector<ResourceUse> uses;
    std::vector<uint32_t> resourceLists;
    Range
        untouchedOutputs; // of resourceLists: outputs that must hold zeros and that no running pass uses
    std::vector<PoolSlot> slots;
    std::vector<std::string> errors; // sentences; empty when the graph can run

    [[nodiscard]] std::span<const ResourceUse> usesOf(const CompiledPass& pass) const {
        return std::span(uses).subspan(pass.uses.first, pass.uses.count);
    }
    [[nodiscard]] std::span<const uint32_t> list(Range range) const {
        return std::span(resourceLists).subspan(range.first, range.count);
    }
    /// Bytes of all pool slots: what transient resources take together.
    [[nodiscard]] uint64_t pooledBytes() const;
    /// Bytes that transient resources would take without sharing.
    [[nodiscard]] uint64_t unpooledBytes() const;
};

} // namespace tyndall::fg
