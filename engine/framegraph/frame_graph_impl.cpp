#include "framegraph/frame_graph_impl.h"

#include <fmt/format.h>

#include "core/check.h"

namespace tyndall::fg {

std::string placeText(const std::source_location& where) {
    std::string_view file = where.file_name();
    for (const std::string_view root :
         {"engine/", "plugins/", "tests/", "editor/"}) // as the repository names it
        if (const size_t at = file.rfind(root); at != std::string_view::npos) {
            file.remove_prefix(at);
            break;
        }
    return fmt::format("{}:{}", file, where.line());
}

FrameGraphImpl::FrameGraphImpl(PersistentTable& persistent) : persistent_(persistent) {
    beginFrame();
}

void FrameGraphImpl::beginFrame() {
    recording_ = false; // a failed check may have left the setup of a pass
    arena_.clear();
    passes_.clear();
    resources_.clear();
    versions_.clear();
    uses_.clear();
    outputs_.clear();
    errors_.clear();
    resources_.emplace_back();
    resources_[0].name = "(none)";
    persistent_.beginFrame();
}

// --- what is known about a handle ---

uint32_t FrameGraphImpl::versionOf(uint32_t resource, uint32_t number) const {
    if (resource == 0 || resource >= resources_.size()) return kNoIndex;
    uint32_t version = resources_[resource].latest;
    while (version != kNoIndex && versions_[version].number > number)
        version = versions_[version].previous;
    return version != kNoIndex && versions_[version].number == number ? version : kNoIndex;
}

uint32_t FrameGraphImpl::contentVersion(uint32_t version) const {
    while (versions_[version].skipped && versions_[version].previous != kNoIndex)
        version = versions_[version].previous;
    return version;
}

bool FrameGraphImpl::absent(uint32_t resource, uint32_t number) const {
    const uint32_t version = versionOf(resource, number);
    return version == kNoIndex || versions_[version].absent;
}

bool FrameGraphImpl::isAbsent(TextureHandle handle) const {
    return absent(handle.resource, handle.version);
}
bool FrameGraphImpl::isAbsent(BufferHandle handle) const {
    return absent(handle.resource, handle.version);
}

TextureDesc FrameGraphImpl::desc(TextureHandle handle) const {
    CHECK(handle.resource != 0 && handle.resource < resources_.size() &&
              !resources_[handle.resource].isBuffer,
          "desc() of a handle that is not a texture of this frame");
    return resources_[handle.resource].texture;
}

BufferDesc FrameGraphImpl::desc(BufferHandle handle) const {
    CHECK(handle.resource != 0 && handle.resource < resources_.size() &&
              resources_[handle.resource].isBuffer,
          "desc() of a handle that is not a buffer of this frame");
    return resources_[handle.resource].buffer;
}

TextureHandle FrameGraphImpl::findTexture(std::string_view name) const {
    for (uint32_t i = uint32_t(resources_.size()); i-- > 1;) {
        if (resources_[i].isBuffer || resources_[i].name != name) continue;
        const uint32_t number = versions_[resources_[i].latest].number;
        // A history that nobody has written yet is known by its past.
        if (resources_[i].origin == ResourceOrigin::HistoryCurrent && number == 0)
            return {resources_[i].previousHalf, 0};
        return {i, number};
    }
    return {};
}

// --- resources ---

uint32_t FrameGraphImpl::addResource(const char* name, ResourceOrigin origin) {
    ResourceRecord& resource = resources_.emplace_back();
    resource.name = arena_.copy(name);
    resource.origin = origin;
    return uint32_t(resources_.size() - 1);
}

uint32_t FrameGraphImpl::addTexture(const char* name, ResourceOrigin origin,
                                    const TextureDesc& desc) {
    const uint32_t index = addResource(name, origin);
    resources_[index].texture = desc;
    return index;
}

uint32_t FrameGraphImpl::addBuffer(const char* name, ResourceOrigin origin,
                                   const BufferDesc& desc) {
    const uint32_t index = addResource(name, origin);
    resources_[index].isBuffer = true;
    resources_[index].buffer = desc;
    return index;
}

/// The next version of `resource`. What came from outside is version 0; the first write to it is 1, as is a creation.
uint32_t FrameGraphImpl::addVersion(uint32_t resource, uint32_t writer) {
    ResourceRecord& record = resources_[resource];
    VersionRecord version;
    version.resource = resource;
    version.writer = writer;
    version.previous = record.latest;
    version.number = record.latest != kNoIndex ? versions_[record.latest].number + 1
                     : writer == kNoIndex      ? 0
                                               : 1;
    record.latest = uint32_t(versions_.size());
    versions_.push_back(version);
    return record.latest;
}

uint32_t FrameGraphImpl::persistentOf(const char* name, bool isBuffer) const {
    for (uint32_t i = 1; i < resources_.size(); ++i)
        if (resources_[i].origin == ResourceOrigin::Persistent &&
            resources_[i].isBuffer == isBuffer && resources_[i].name == name)
            return i;
    return 0;
}

TextureHistory FrameGraphImpl::historyTexture(const char* name, const TextureDesc& desc) {
    for (const ResourceRecord& other : resources_)
        CHECK(other.origin != ResourceOrigin::HistoryCurrent || other.name != name,
              fmt::format("historyTexture('{}') twice in one frame", name));
    const uint32_t entry = persistent_.findTexture(PersistentKind::History, name, 0, desc);
    const uint32_t half = persistent_.entry(entry).previousHalf;
    const uint32_t previous = addTexture(name, ResourceOrigin::HistoryPrevious, desc);
    const uint32_t current = addTexture(name, ResourceOrigin::HistoryCurrent, desc);
    resources_[previous].name = arena_.concatenate(name, ".previous");
    resources_[previous].persistent = entry * 2 + half;
    resources_[current].persistent = entry * 2 + (1 - half);
    resources_[current].previousHalf = previous;
    addVersion(previous, kNoIndex);
    addVersion(current, kNoIndex);
    checkDesc(current, std::source_location::current());
    return {{previous, 0}, {current, 0}, persistent_.entry(entry).content == 0};
}

PersistentTexture FrameGraphImpl::persistentTexture(const char* name, const TextureDesc& desc) {
    const uint32_t entry = persistent_.findTexture(PersistentKind::Single, name, 0, desc);
    uint32_t resource = persistentOf(name, false);
    if (resource == 0) {
        resource = addTexture(name, ResourceOrigin::Persistent, desc);
        resources_[resource].persistent = entry * 2;
        addVersion(resource, kNoIndex);
        checkDesc(resource, std::source_location::current());
    }
    CHECK(resources_[resource].texture == desc,
          fmt::format("persistentTexture('{}') twice, with different sizes or formats", name));
    return {{resource, versions_[resources_[resource].latest].number},
            persistent_.entry(entry).content == 0};
}

PersistentBuffer FrameGraphImpl::persistentBuffer(const char* name, const BufferDesc& desc) {
    const uint32_t entry = persistent_.findBuffer(PersistentKind::Single, name, 0, desc);
    uint32_t resource = persistentOf(name, true);
    if (resource == 0) {
        resource = addBuffer(name, ResourceOrigin::Persistent, desc);
        resources_[resource].persistent = entry * 2;
        addVersion(resource, kNoIndex);
        checkDesc(resource, std::source_location::current());
    }
    CHECK(resources_[resource].buffer == desc,
          fmt::format("persistentBuffer('{}') twice, with different sizes", name));
    return {{resource, versions_[resources_[resource].latest].number},
            persistent_.entry(entry).content == 0};
}

TextureHandle FrameGraphImpl::importTexture(const char* name, StaticTexture texture,
                                            const TextureDesc& desc, uint64_t contentVersion) {
    CHECK(texture.id != 0, fmt::format("importTexture('{}') of no texture", name));
    const uint32_t resource = addTexture(name, ResourceOrigin::Imported, desc);
    resources_[resource].staticId = texture.id;
    resources_[resource].importedContent = contentVersion;
    addVersion(resource, kNoIndex);
    return {resource, 0};
}

BufferHandle FrameGraphImpl::importBuffer(const char* name, StaticBuffer buffer,
                                          const BufferDesc& desc, uint64_t contentVersion) {
    CHECK(buffer.id != 0, fmt::format("importBuffer('{}') of no buffer", name));
    const uint32_t resource = addBuffer(name, ResourceOrigin::Imported, desc);
    resources_[resource].staticId = buffer.id;
    resources_[resource].importedContent = contentVersion;
    addVersion(resource, kNoIndex);
    return {resource, 0};
}

void FrameGraphImpl::markOutput(uint32_t resource, uint32_t number) {
    const uint32_t version = versionOf(resource, number);
    CHECK(version != kNoIndex, "markOutput() of a handle that is not of this frame");
    resources_[resource].isOutput = true;
    outputs_.push_back(version);
}
void FrameGraphImpl::markOutput(TextureHandle handle) {
    markOutput(handle.resource, handle.version);
}
void FrameGraphImpl::markOutput(BufferHandle handle) {
    markOutput(handle.resource, handle.version);
}

// --- passes ---

std::string_view FrameGraphImpl::passName() const { return passes_.back().name; }

Builder& FrameGraphImpl::beginPass(const char* name, const std::source_location& where) {
    CHECK(!recording_,
          fmt::format("pass '{}' is added inside the setup of pass '{}'", name, passName()));
    recording_ = true;
    PassRecord& pass = passes_.emplace_back();
    pass.name = arena_.copy(name);
    pass.where = where;
    pass.uses.first = uint32_t(uses_.size());
    return *this;
}

void* FrameGraphImpl::allocate(size_t bytes, size_t alignment) {
    return arena_.allocate(bytes, alignment);
}

void FrameGraphImpl::endPass(const void* data, ExecuteFunction execute) {
    CHECK(recording_, "endPass() without beginPass()");
    recording_ = false;
    PassRecord& pass = passes_.back();
    pass.data = data;
    pass.execute = execute;
    pass.uses.count = uint32_t(uses_.size()) - pass.uses.first;
    for (uint32_t i = pass.uses.first; i < uses_.size(); ++i) {
        VersionRecord& version = versions_[uses_[i].version];
        if (!isWrite(uses_[i].access) || !pass.skipped) continue;
        version.skipped = true;
        version.absent = version.previous == kNoIndex || versions_[version.previous].absent;
    }
}

void FrameGraphImpl::skip(const char* reason) {
    CHECK(recording_, "skip() outside of a setup");
    passes_.back().skipped = true;
    passes_.back().reason = arena_.copy(reason);
}

void FrameGraphImpl::cacheBy(uint64_t key) {
    CHECK(recording_, "cacheBy() outside of a setup");
    passes_.back().cacheable = true;
    passes_.back().key = key;
}

void FrameGraphImpl::sideEffect() {
    CHECK(recording_, "sideEffect() outside of a setup");
    passes_.back().sideEffect = true;
}

TextureHandle FrameGraphImpl::readTexture(TextureHandle handle, Access access,
                                          const std::source_location& where) {
    read(handle.resource, handle.version, access, where);
    return handle;
}
BufferHandle FrameGraphImpl::readBuffer(BufferHandle handle, Access access,
                                        const std::source_location& where) {
    read(handle.resource, handle.version, access, where);
    return handle;
}
TextureHandle FrameGraphImpl::writeTexture(TextureHandle handle, Access access,
                                           const std::source_location& where) {
    return {handle.resource, write(handle.resource, handle.version, access, where)};
}
BufferHandle FrameGraphImpl::writeBuffer(BufferHandle handle, Access access,
                                         const std::source_location& where) {
    return {handle.resource, write(handle.resource, handle.version, access, where)};
}
TextureHandle FrameGraphImpl::createTexture(const char* name, const TextureDesc& desc,
                                            Access access, const std::source_location& where) {
    const uint32_t resource = addTexture(name, ResourceOrigin::Transient, desc);
    return {resource, create(resource, access, where)};
}
BufferHandle FrameGraphImpl::createBuffer(const char* name, const BufferDesc& desc, Access access,
                                          const std::source_location& where) {
    const uint32_t resource = addBuffer(name, ResourceOrigin::Transient, desc);
    return {resource, create(resource, access, where)};
}

uint32_t FrameGraphImpl::create(uint32_t resource, Access access,
                                const std::source_location& where) {
    CHECK(recording_, "create() outside of a setup");
    checkDesc(resource, where);
    checkAccess(resource, access, true, where);
    const uint32_t pass = uint32_t(passes_.size() - 1);
    resources_[resource].creator = pass;
    const uint32_t version = addVersion(resource, pass);
    uses_.push_back({version, access, false, where});
    return versions_[version].number;
}

/// The pass that, before the one being recorded, wrote over `version`; kNoIndex where its content is still there.
uint32_t FrameGraphImpl::overwriterOf(uint32_t version) const {
    const uint32_t self = uint32_t(passes_.size() - 1);
    uint32_t overwriter = kNoIndex;
    for (uint32_t newer = resources_[versions_[version].resource].latest; newer != version;
         newer = versions_[newer].previous)
        if (!versions_[newer].skipped && versions_[newer].writer != self)
            overwriter = versions_[newer].writer;
    return overwriter;
}

void FrameGraphImpl::read(uint32_t resource, uint32_t number, Access access,
                          const std::source_location& where) {
    CHECK(recording_, "read() outside of a setup");
    if (!checkHandle(resource, number, "reads", where)) return;
    checkAccess(resource, access, false, where);
    const uint32_t version = versionOf(resource, number);
    const bool own = versions_[version].writer == passes_.size() - 1;
    const ResourceRecord& record = resources_[resource];
    if (record.origin == ResourceOrigin::HistoryCurrent && number == 0)
        errors_.push_back(fmt::format(
            "pass '{}' reads '{}', which no pass has written in this frame ({}): read the handle that the "
            "write returned, or the history's previous",
            passName(), record.name, placeText(where)));
    if (const uint32_t overwriter = overwriterOf(version); overwriter != kNoIndex)
        errors_.push_back(fmt::format(
            "pass '{}' reads version {} of '{}' ({}), but pass '{}' has written over it: add the reader "
            "before that pass, or read the newer handle",
            passName(), number, record.name, placeText(where), passes_[overwriter].name));
    uses_.push_back({version, access, own, where});
}

uint32_t FrameGraphImpl::write(uint32_t resource, uint32_t number, Access access,
                               const std::source_location& where) {
    CHECK(recording_, "write() outside of a setup");
    if (!checkHandle(resource, number, "writes", where)) return number;
    checkAccess(resource, access, true, where);
    const uint32_t self = uint32_t(passes_.size() - 1);
    const uint32_t version = versionOf(resource, number);
    if (versions_[version].writer ==
        self) { // a second kind of write by the same pass makes no new version
        uses_.push_back({version, access, false, where});
        return number;
    }
    if (const uint32_t overwriter = overwriterOf(version); overwriter != kNoIndex)
        errors_.push_back(fmt::format(
            "passes '{}' ({}) and '{}' ({}) both write over version {} of '{}': the second must write "
            "the handle that the first returned",
            passes_[overwriter].name, placeText(passes_[overwriter].where), passName(),
            placeText(where), number, resources_[resource].name));
    const uint32_t latest = resources_[resource].latest;
    if (versions_[latest].writer == self) { // written twice from one old handle: the same write
        uses_.push_back({latest, access, false, where});
        return versions_[latest].number;
    }
    const uint32_t next = addVersion(resource, self);
    uses_.push_back({next, access, false, where});
    return versions_[next].number;
}

} // namespace tyndall::fg
