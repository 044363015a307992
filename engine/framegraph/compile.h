#pragma once
// From a recorded frame to one that can run. In order: validate, give every content a number, see which cached results still
// hold, cull from the outputs back, then lifetimes, storage and barriers.

#include <cstdint>
#include <vector>

#include "framegraph/compiled_graph.h"
#include "framegraph/frame_graph_impl.h"

namespace tyndall::fg {

struct CompileOptions {
    bool keepAll =
        false; // no sharing of storage, and nothing is released before the end of the frame
};

/// Keeps its scratch memory, so that compiling a graph that does not grow allocates nothing.
class Compiler {
public:
    /// Rewrites `result`. Where result.errors is not empty the graph must not run; the rest of `result` is then unspecified.
    void compile(FrameGraphImpl& graph, PersistentTable& persistent, CompiledGraph& result,
                 const CompileOptions& options = {});

private:
    // compile.cpp
    void validate();
    void findFeedback(uint32_t pass);
    void verifyOrder();
    void markDemanded();
    void cull();
    void demandPass(uint32_t pass, std::vector<uint8_t>& marks, bool throughCached);
    void demandVersion(uint32_t version, std::vector<uint8_t>& marks, bool throughCached);
    void drainStack(std::vector<uint8_t>& marks, bool throughCached);
    void pushRoots(std::vector<uint8_t>& marks, bool throughCached);
    void explainCulling(uint32_t pass);

    // compile_cache.cpp
    void findKeptEntries();
    void numberContents();
    uint64_t signatureOf(uint32_t pass) const;
    void findFinalVersions();
    void findCached();
    bool resultsHeld(uint32_t pass) const;
    bool dropBrokenChains();

    // compile_storage.cpp
    void fillPasses();
    void fillResources();
    void findLifetimes();
    void useResource(uint32_t resource, uint32_t pass);
    void assignSlots();
    void listResourcesOf(uint32_t pass, bool acquire, Range& range);
    void listUntouchedOutputs();
    void findBarriers();
    uint32_t takeSlot(const CompiledResource& resource);
    [[nodiscard]] uint32_t storageOf(uint32_t resource) const;

    [[nodiscard]] bool isExternal(uint32_t resource) const;

    FrameGraphImpl* graph_ = nullptr;
    PersistentTable* persistent_ = nullptr;
    CompiledGraph* result_ = nullptr;
    CompileOptions options_;

    std::vector<uint8_t> demanded_; // per pass: would run if nothing were cached
    std::vector<uint8_t> live_;     // per pass: an output needs it in this frame
    std::vector<uint8_t> cached_;   // per pass: its results still hold
    std::vector<uint8_t> isRead_;   // per version
    std::vector<uint32_t> stack_;
    std::vector<uint32_t>
        currentOf_; // per resource: HistoryCurrent that belongs to a HistoryPrevious
    std::vector<uint64_t> content_; // per version: number of its content
    std::vector<uint32_t> kept_;    // per resource: storage index in the persistent table
    std::vector<uint32_t> final_;   // per resource: the last version that a demanded pass makes

    std::vector<uint8_t> slotTaken_; // per slot
    struct StorageState {
        int32_t lastAccess, lastStorageWrite; // pass, -1: none in this frame
    };
    std::vector<StorageState> storage_;
};

} // namespace tyndall::fg
