#pragma once
// The recorder behind FrameGraph and Builder: it keeps what passes declare, in order, and finds the errors that can be
// found at once. compile() makes the rest of it.

#include <cstdint>
#include <source_location>
#include <string>
#include <string_view>
#include <vector>

#include "framegraph/arena.h"
#include "framegraph/compiled_graph.h"
#include "framegraph/frame_graph.h"
#include "framegraph/persistent_table.h"

namespace tyndall::fg {

/// One state of a resource's content: as imported, or as a pass left it.
struct VersionRecord {
    uint32_t resource = 0;
    uint32_t number = 0;          // as in handles
    uint32_t writer = kNoIndex;   // pass; kNoIndex: it came from outside
    uint32_t previous = kNoIndex; // index of the version that was overwritten
    bool skipped = false;         // the writer was skipped: the content is that of `previous`
    bool absent = false;          // holds nothing: created by a skipped pass and not written since
};

struct ResourceRecord {
    std::string_view name;
    bool isBuffer = false;
    TextureDesc texture;
    BufferDesc buffer;
    ResourceOrigin origin = ResourceOrigin::Transient;
    uint32_t latest = kNoIndex;       // index into versions
    uint32_t creator = kNoIndex;      // pass, for transient resources
    uint32_t persistent = kNoIndex;   // storage index in the persistent table
    uint32_t previousHalf = kNoIndex; // HistoryCurrent: its HistoryPrevious
    uint32_t staticId = 0;
    uint64_t importedContent = 0;
    bool isOutput = false;
};

/// One declared access, in order of declaration.
struct UseRecord {
    uint32_t version; // index into versions: that is read, or that the write makes
    Access access;
    bool ownVersion; // reads what the same pass writes: no dependency
    std::source_location where;
};

struct PassRecord {
    std::string_view name, reason;
    bool skipped = false, cacheable = false, sideEffect = false;
    uint64_t key = 0;
    Range uses;
    const void* data = nullptr;
    ExecuteFunction execute = nullptr;
    std::source_location where;
};

class FrameGraphImpl final : public FrameGraph, private Builder {
public:
    /// `persistent` remembers what outlives the frame.
    explicit FrameGraphImpl(PersistentTable& persistent);

    /// Forgets the frame before; its handles, names and data end here.
    void beginFrame();

    TextureDesc desc(TextureHandle handle) const override;
    BufferDesc desc(BufferHandle handle) const override;
    bool isAbsent(TextureHandle handle) const override;
    bool isAbsent(BufferHandle handle) const override;
    TextureHistory historyTexture(const char* name, const TextureDesc& desc) override;
    PersistentTexture persistentTexture(const char* name, const TextureDesc& desc) override;
    PersistentBuffer persistentBuffer(const char* name, const BufferDesc& desc) override;
    TextureHandle importTexture(const char* name, StaticTexture texture, const TextureDesc& desc,
                                uint64_t contentVersion) override;
    BufferHandle importBuffer(const char* name, StaticBuffer buffer, const BufferDesc& desc,
                              uint64_t contentVersion) override;
    void markOutput(TextureHandle handle) override;
    void markOutput(BufferHandle handle) override;

    /// The newest version of the last resource of this name; null where there is none.
    [[nodiscard]] TextureHandle findTexture(std::string_view name) const;

    // For compile() and the executor.
    [[nodiscard]] const std::vector<PassRecord>& passes() const { return passes_; }
    [[nodiscard]] const std::vector<ResourceRecord>& resources() const { return resources_; }
    [[nodiscard]] const std::vector<VersionRecord>& versions() const { return versions_; }
    [[nodiscard]] const std::vector<UseRecord>& uses() const { return uses_; }
    [[nodiscard]] const std::vector<uint32_t>& outputs() const { return outputs_; } // versions
    [[nodiscard]] const std::vector<std::string>& errors() const { return errors_; }
    /// Index of a handle's version, kNoIndex where the handle is not of this frame.
    [[nodiscard]] uint32_t versionOf(uint32_t resource, uint32_t number) const;
    /// The version whose content `version` shows: itself, or what a skipped pass left alone.
    [[nodiscard]] uint32_t contentVersion(uint32_t version) const;
    /// The two texts as one that lives as long as the frame.
    [[nodiscard]] std::string_view concatenateText(std::string_view first,
                                                   std::string_view second) {
        return arena_.concatenate(first, second);
    }

private:
    Builder& beginPass(const char* name, const std::source_location& where) override;
    void* allocate(size_t bytes, size_t alignment) override;
    void endPass(const void* data, ExecuteFunction execute) override;

    TextureHandle readTexture(TextureHandle handle, Access access,
                              const std::source_location& where) override;
    BufferHandle readBuffer(BufferHandle handle, Access access,
                            const std::source_location& where) override;
    TextureHandle writeTexture(TextureHandle handle, Access access,
                               const std::source_location& where) override;
    BufferHandle writeBuffer(BufferHandle handle, Access access,
                             const std::source_location& where) override;
    TextureHandle createTexture(const char* name, const TextureDesc& desc, Access access,
                                const std::source_location& where) override;
    BufferHandle createBuffer(const char* name, const BufferDesc& desc, Access access,
                              const std::source_location& where) override;
    void skip(const char* reason) override;
    void cacheBy(uint64_t key) override;
    void sideEffect() override;

    uint32_t addResource(const char* name, ResourceOrigin origin);
    uint32_t addTexture(const char* name, ResourceOrigin origin, const TextureDesc& desc);
    uint32_t addBuffer(const char* name, ResourceOrigin origin, const BufferDesc& desc);
    uint32_t addVersion(uint32_t resource, uint32_t writer);
    uint32_t create(uint32_t resource, Access access, const std::source_location& where);
    void read(uint32_t resource, uint32_t number, Access access, const std::source_location& where);
    uint32_t write(uint32_t resource, uint32_t number, Access access,
                   const std::source_location& where);
    void markOutput(uint32_t resource, uint32_t number);
    [[nodiscard]] uint32_t overwriterOf(uint32_t version) const;
    [[nodiscard]] uint32_t persistentOf(const char* name, bool isBuffer) const;
    bool checkHandle(uint32_t resource, uint32_t number, const char* verb,
                     const std::source_location& where);
    void checkDesc(uint32_t resource, const std::source_location& where);
    void checkAccess(uint32_t resource, Access access, bool wantWrite,
                     const std::source_location& where);
    [[nodiscard]] bool absent(uint32_t resource, uint32_t number) const;
    [[nodiscard]] std::string_view passName() const;

    PersistentTable& persistent_;
    Arena arena_;
    std::vector<PassRecord> passes_;
    std::vector<ResourceRecord> resources_; // [0] is the null resource
    std::vector<VersionRecord> versions_;
    std::vector<UseRecord> uses_;
    std::vector<uint32_t> outputs_;
    std::vector<std::string> errors_;
    bool recording_ = false; // between beginPass and endPass
};

/// "engine/renderer/frame.cpp:12", for error sentences.
std::string placeText(const std::source_location& where);

} // namespace tyndall::fg
