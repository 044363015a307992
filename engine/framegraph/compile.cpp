#include "framegraph/compile.h"

#include <fmt/format.h>

#include "core/check.h"

namespace tyndall::fg {

void Compiler::compile(FrameGraphImpl& graph, PersistentTable& persistent, CompiledGraph& result,
                       const CompileOptions& options) {
    graph_ = &graph;
    persistent_ = &persistent;
    result_ = &result;
    options_ = options;
    result.passes.clear();
    result.resources.clear();
    result.uses.clear();
    result.resourceLists.clear();
    result.slots.clear();
    result.errors.clear();

    validate();
    if (!result.errors.empty()) return;

    markDemanded();
    findKeptEntries();
    numberContents();
    findFinalVersions();
    findCached();
    cull();

    fillPasses();
    fillResources();
    findLifetimes();
    assignSlots();
    listUntouchedOutputs();
    findBarriers();
}

bool Compiler::isExternal(uint32_t resource) const {
    const ResourceOrigin origin = graph_->resources()[resource].origin;
    return origin == ResourceOrigin::Persistent || origin == ResourceOrigin::Imported;
}

// --- validate ---

/// Most errors were found while recording; those that need the whole pass are found here.
void Compiler::validate() {
    result_->errors.assign(graph_->errors().begin(), graph_->errors().end());
    for (uint32_t pass = 0; pass < graph_->passes().size(); ++pass) findFeedback(pass);
    verifyOrder();
}

/// A texture of one level and layer cannot be sampled while it is rendered to: the result is undefined.
void Compiler::findFeedback(uint32_t passIndex) {
    const PassRecord& pass = graph_->passes()[passIndex];
    const auto& uses = graph_->uses();
    for (uint32_t i = pass.uses.first; i < pass.uses.first + pass.uses.count; ++i) {
        if (uses[i].access != Access::ColorTarget && uses[i].access != Access::DepthTarget)
            continue;
        const uint32_t resource = graph_->versions()[uses[i].version].resource;
        const ResourceRecord& record = graph_->resources()[resource];
        if (record.texture.mips > 1 || record.texture.depth > 1) continue;
        for (uint32_t k = pass.uses.first; k < pass.uses.first + pass.uses.count; ++k) {
            if (graph_->versions()[uses[k].version].resource != resource) continue;
            if (uses[k].access != Access::Sampled && uses[k].access != Access::StorageRead)
                continue;
            result_->errors.push_back(fmt::format(
                "pass '{}' reads '{}' as {} ({}) while it renders to it ({}): write to a new "
                "texture instead",
                pass.name, record.name, accessName(uses[k].access), placeText(uses[k].where),
                placeText(uses[i].where)));
        }
    }
}

/// The order of declaration is an order of execution: handles exist only after their writer was declared.
void Compiler::verifyOrder() {
    for (uint32_t pass = 0; pass < graph_->passes().size(); ++pass) {
        const Range range = graph_->passes()[pass].uses;
        for (uint32_t i = range.first; i < range.first + range.count; ++i) {
            const VersionRecord& version = graph_->versions()[graph_->uses()[i].version];
            CHECK(version.writer == kNoIndex || version.writer <= pass,
                  "a pass reads what a later pass writes");
        }
    }
}

// --- cull ---

/// Which passes the outputs need, if nothing were cached.
void Compiler::markDemanded() {
    const size_t resourceCount = graph_->resources().size();
    currentOf_.assign(resourceCount, kNoIndex);
    for (uint32_t i = 0; i < resourceCount; ++i)
        if (const uint32_t previous = graph_->resources()[i].previousHalf; previous != kNoIndex)
            currentOf_[previous] = i;
    isRead_.assign(graph_->versions().size(), 0);
    for (const UseRecord& use : graph_->uses())
        if (!isWrite(use.access) && !use.ownVersion) isRead_[use.version] = 1;
    demanded_.assign(graph_->passes().size(), 0);
    pushRoots(demanded_, true);
    drainStack(demanded_, true);
}

/// Which passes must run: the results of cached passes are there, so they need no inputs.
void Compiler::cull() {
    live_.assign(graph_->passes().size(), 0);
    pushRoots(live_, false);
    drainStack(live_, false);
}

/// Outputs, side effects, and writes to what outlives the frame.
void Compiler::pushRoots(std::vector<uint8_t>& marks, bool throughCached) {
    for (const uint32_t version : graph_->outputs()) demandVersion(version, marks, throughCached);
    for (uint32_t i = 0; i < graph_->passes().size(); ++i) {
        const PassRecord& pass = graph_->passes()[i];
        bool root = pass.sideEffect;
        for (uint32_t k = pass.uses.first; k < pass.uses.first + pass.uses.count && !root; ++k) {
            const UseRecord& use = graph_->uses()[k];
            root = isWrite(use.access) && isExternal(graph_->versions()[use.version].resource);
        }
        if (root) demandPass(i, marks, throughCached);
    }
}

void Compiler::demandVersion(uint32_t version, std::vector<uint8_t>& marks, bool throughCached) {
    const VersionRecord& record = graph_->versions()[graph_->contentVersion(version)];
    if (record.writer != kNoIndex) demandPass(record.writer, marks, throughCached);
}

void Compiler::demandPass(uint32_t pass, std::vector<uint8_t>& marks, bool throughCached) {
    if (marks[pass] || graph_->passes()[pass].skipped) return;
    marks[pass] = 1;
    if (throughCached || !cached_[pass]) stack_.push_back(pass);
}

void Compiler::drainStack(std::vector<uint8_t>& marks, bool throughCached) {
    while (!stack_.empty()) {
        const Range range = graph_->passes()[stack_.back()].uses;
        stack_.pop_back();
        for (uint32_t i = range.first; i < range.first + range.count; ++i) {
            const UseRecord& use = graph_->uses()[i];
            const VersionRecord& version = graph_->versions()[use.version];
            if (!isWrite(use.access)) {
                demandVersion(use.version, marks, throughCached);
                // Whoever reads the past needs somebody to make the next frame's past.
                if (const uint32_t current = currentOf_[version.resource]; current != kNoIndex)
                    demandVersion(graph_->resources()[current].latest, marks, throughCached);
            } else if (version.previous != kNoIndex) { // what is not written over shows through
                demandVersion(version.previous, marks, throughCached);
            }
        }
    }
}

/// The sentence for a pass that nobody needs.
void Compiler::explainCulling(uint32_t passIndex) {
    CompiledPass& pass = result_->passes[passIndex];
    if (demanded_[passIndex]) {
        pass.reason = "only cached passes read what it writes";
        return;
    }
    const Range range = graph_->passes()[passIndex].uses;
    std::string_view written;
    bool read = false;
    for (uint32_t i = range.first; i < range.first + range.count; ++i) {
        const UseRecord& use = graph_->uses()[i];
        if (!isWrite(use.access)) continue;
        const uint32_t resource = graph_->versions()[use.version].resource;
        if (written.empty()) written = graph_->resources()[resource].name;
        read |= isRead_[use.version] != 0;
    }
    if (written.empty())
        pass.reason = "it writes nothing";
    else if (read)
        pass.reason = "only passes that do not run read what it writes";
    else
        pass.reason = graph_->concatenateText("nobody reads ", written);
}

} // namespace tyndall::fg
