#include "framegraph/gl/executor.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <unordered_set>

#include "core/check.h"
#include "framegraph/compile.h"
#include "framegraph/gl/gl_format.h"
#include "framegraph/gl/gl_pass_context.h"
#include "framegraph/gl/pass_timings.h"
#include "framegraph/gl/texel_check.h"
#include "framegraph/hash.h"
#include "gl/debug.h"
#include "gl/read_back.h"

namespace tyndall::fg {
namespace {

using Clock = std::chrono::steady_clock;
double millisecondsSince(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

constexpr uint64_t kRingBytes = 4 * 1024 * 1024; // grows where a frame uploads more

} // namespace

class Executor::Impl {
public:
    Impl(gl::ShaderLibrary& shaders, const ExecutorOptions& options)
        : options_(options), next_(options), programs_(shaders), ring_("upload ring", kRingBytes),
          timings_(options.timings) {}

    void beginFrame();
    Result<void> execute();
    Result<void> runAgain(const void* data);
    void compile();
    Result<void> runPasses();
    void runPass(uint32_t index, uint64_t key);
    void finishCommands();
    void prepareStorage(const CompiledPass& pass);
    Result<void> countTexels(uint32_t index);
    void report(const CompiledPass& pass, uint64_t key);
    void sumTimings();
    void finishReport();
    void waitForTimings();
    bool stays(const CompiledResource& resource) const;
    const Storage& readable(uint32_t resource, uint32_t version, const char* what) const;

    ExecutorOptions options_, next_;
    PersistentTable persistent_;
    FrameGraphImpl graph_{persistent_};
    Compiler compiler_;
    CompiledGraph compiled_;
    gl::FramebufferCache framebuffers_;
    gl::SamplerCache samplers_;
    StorageSet storage_{framebuffers_};
    StaticTable statics_;
    ProgramCache programs_;
    gl::UploadRing ring_;
    PassTimings timings_;
    TexelCheck texelCheck_;
    std::unordered_set<uint64_t> signed_; // hashes of names of resources that may be negative
    GlWorld world_{graph_,    compiled_,     persistent_, storage_, statics_,
                   programs_, framebuffers_, samplers_,   ring_,    options_.poison};
    GlPassContext context_{world_};
    FrameReport report_;
    std::vector<uint64_t> reportKeys_; // of report_.passes, for the timings
    bool executed_ = false;
};

void Executor::Impl::beginFrame() {
    if (next_.poison != options_.poison) persistent_.forgetResults();
    if (next_.timings != options_.timings) timings_ = PassTimings(next_.timings);
    options_ = next_;
    graph_.beginFrame();
    storage_.beginFrame(persistent_);
    report_.passes.clear(); // its texts go with the frame
    reportKeys_.clear();
    executed_ = false;
}

void Executor::Impl::compile() {
    const Clock::time_point start = Clock::now();
    compiler_.compile(graph_, persistent_, compiled_, {.keepAll = options_.keepAll});
    report_.compileMs = millisecondsSince(start);
    std::string all;
    for (const std::string& error : compiled_.errors) all += (all.empty() ? "" : "\n") + error;
    CHECK(all.empty(), all);
}

Result<void> Executor::Impl::execute() {
    CHECK(!executed_, "execute() twice without beginFrame()");
    const Clock::time_point start = Clock::now();
    executed_ = true;
    compile();
    Result<void> done;
    try {
        done = runPasses();
    } catch (...) { // a failed check inside a pass: what it was to write is unknown
        context_.endPass();
        timings_ = PassTimings(options_.timings);
        persistent_.forgetResults();
        persistent_.resetHistory();
        throw;
    }
    if (done.ok())
        persistent_.commit(compiled_);
    else
        persistent_.forgetResults();
    report_.cpuMs = millisecondsSince(start);
    finishReport();
    return done;
}

Result<void> Executor::Impl::runPasses() {
    storage_.assignSlots(compiled_);
    context_.beginFrame();
    for (const uint32_t index : compiled_.list(compiled_.untouchedOutputs))
        options_.poison ? world_.storageOf(index).poison() : world_.storageOf(index).clearToZero();
    timings_.beginFrame();
    if (options_.checkTexels) texelCheck_.begin(compiled_.passes.size());
    report_.passes.clear();
    reportKeys_.clear();
    Result<void> done;
    for (uint32_t i = 0; i < compiled_.passes.size(); ++i) {
        const CompiledPass& pass = compiled_.passes[i];
        const uint64_t key = timings_.keyOf(pass.name);
        const Clock::time_point start = Clock::now();
        const bool runs = pass.status == PassStatus::Ran && done.ok();
        if (runs) runPass(i, key);
        report(pass, key);
        report_.passes.back().cpuMs = runs ? millisecondsSince(start) : 0;
        if (done.ok() && context_.failure()) done = *context_.failure();
        if (runs && done.ok() && options_.checkTexels) done = countTexels(i);
    }
    finishCommands();
    framebuffers_.endFrame();
    return done;
}

void Executor::Impl::finishCommands() {
    // What shaders wrote in this frame is there for the next, for read-backs, and for whoever draws with GL himself.
    context_.memoryBarrier(GL_ALL_BARRIER_BITS);
    timings_.endFrame();
    ring_.endFrame();
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

Result<void> Executor::Impl::runAgain(const void* data) {
    CHECK(executed_, "runAgain() before execute()");
    const auto found = std::find_if(compiled_.passes.begin(), compiled_.passes.end(),
                                    [&](const CompiledPass& pass) { return pass.data == data; });
    CHECK(found != compiled_.passes.end() && found->status == PassStatus::Ran,
          "runAgain() of a pass that did not run in this frame");
    for (const ResourceUse& use : compiled_.usesOf(*found))
        CHECK(stays(compiled_.resources[use.resource]),
              fmt::format("pass '{}' cannot run again: mark '{}' as an output", found->name,
                          compiled_.resources[use.resource].name));
    const Clock::time_point start = Clock::now();
    const auto index = size_t(found - compiled_.passes.begin());
    context_.beginFrame();
    timings_.beginFrame();
    const uint64_t key = timings_.keyOf(found->name);
    runPass(uint32_t(index), key);
    finishCommands();
    report_.passes[index].cpuMs = millisecondsSince(start);
    report_.passes[index].gpuMs = timings_.lastMs(key);
    sumTimings();
    if (context_.failure()) return *context_.failure();
    return {};
}

void Executor::Impl::runPass(uint32_t index, uint64_t key) {
    const CompiledPass& pass = compiled_.passes[index];
    const gl::DebugGroup group(pass.name);
    timings_.begin(key, pass.name);
    prepareStorage(pass);
    context_.memoryBarrier(pass.barriers);
    context_.beginPass(index);
    pass.execute(pass.data, context_);
    context_.endPass();
    timings_.end();
}

/// New storage starts as nothing, or as NaN where nobody may rely on that.
void Executor::Impl::prepareStorage(const CompiledPass& pass) {
    bool cleared = false;
    for (const uint32_t index : compiled_.list(pass.acquires)) {
        const CompiledResource& resource = compiled_.resources[index];
        const uint32_t held = resource.aliasOf != kNoIndex ? resource.aliasOf : index;
        const ResourceOrigin origin = compiled_.resources[held].origin;
        bool writes = false;
        for (const ResourceUse& use : compiled_.usesOf(pass))
            writes |= use.resource == index && isWrite(use.access);
        // The result of a cached pass is only new where the pass itself, its first user, writes it.
        const bool fresh =
            origin == ResourceOrigin::Transient ||
            ((origin == ResourceOrigin::Kept || origin == ResourceOrigin::HistoryCurrent) &&
             writes);
        const bool clear = compiled_.resources[held].clearFirst;
        if (!clear && !(options_.poison && fresh)) continue;
        if (!cleared)
            context_.memoryBarrier(
                GL_ALL_BARRIER_BITS); // the storage may still be in use under another name
        cleared = true;
        options_.poison ? world_.storageOf(index).poison() : world_.storageOf(index).clearToZero();
    }
    if (cleared) context_.memoryBarrier(GL_ALL_BARRIER_BITS);
}

Result<void> Executor::Impl::countTexels(uint32_t index) {
    uint32_t last = 0;
    for (const ResourceUse& use : compiled_.usesOf(compiled_.passes[index])) {
        const CompiledResource& resource = compiled_.resources[use.resource];
        if (!isWrite(use.access) || resource.isBuffer || use.resource == last ||
            !isFloatColor(resource.texture.format))
            continue;
        last = use.resource;
        const bool negative = !signed_.contains(hashName(resource.name));
        if (Result<void> done =
                texelCheck_.add(programs_, world_.storageOf(use.resource).texture, negative, index);
            !done.ok())
            return done;
    }
    return {};
}

void Executor::Impl::waitForTimings() {
    timings_.finish();
    for (size_t i = 0; i < report_.passes.size(); ++i) {
        PassReport& pass = report_.passes[i];
        (pass.status == PassStatus::Ran ? pass.gpuMs : pass.savedMs) =
            timings_.lastMs(reportKeys_[i]);
    }
    sumTimings();
}

void Executor::Impl::report(const CompiledPass& pass, uint64_t key) {
    reportKeys_.push_back(key);
    PassReport& out = report_.passes.emplace_back();
    out.name = pass.name;
    out.status = pass.status;
    out.reason = pass.reason;
    const double last = timings_.lastMs(key);
    (pass.status == PassStatus::Ran ? out.gpuMs : out.savedMs) = last;
}

void Executor::Impl::sumTimings() {
    report_.gpuMs = 0;
    for (const PassReport& pass : report_.passes)
        if (pass.status == PassStatus::Ran)
            report_.gpuMs = pass.gpuMs < 0 || report_.gpuMs < 0 ? -1 : report_.gpuMs + pass.gpuMs;
}

void Executor::Impl::finishReport() {
    report_.nonFiniteTexels = report_.negativeTexels = 0;
    sumTimings();
    if (options_.checkTexels) {
        const std::vector<TexelCheck::Counts>& counts = texelCheck_.read();
        for (size_t i = 0; i < counts.size(); ++i) {
            report_.nonFiniteTexels += report_.passes[i].nonFiniteTexels = counts[i].nonFinite;
            report_.negativeTexels += report_.passes[i].negativeTexels = counts[i].negative;
        }
    }
    const StorageSet::Totals storage = storage_.totals(), statics = statics_.totals();
    report_.gpuBytes = storage.bytes + statics.bytes + ring_.capacity();
    report_.liveTextures = storage.textures + statics.textures;
    report_.liveBuffers = storage.buffers + statics.buffers + 1; // the ring
    report_.barriers = context_.barrierCount();
}

/// Has no other resource taken its storage since?
bool Executor::Impl::stays(const CompiledResource& resource) const {
    return resource.slot == kNoIndex || resource.isOutput || options_.keepAll;
}

/// The storage of something that still holds what the frame wrote.
const Storage& Executor::Impl::readable(uint32_t index, uint32_t version, const char* what) const {
    CHECK(executed_, fmt::format("{} before execute()", what));
    CHECK(graph_.versionOf(index, version) != kNoIndex,
          fmt::format("{} of a handle that is not of this frame", what));
    const CompiledResource& resource = compiled_.resources[index];
    CHECK(stays(resource),
          fmt::format("{} of '{}', whose storage other resources use: mark it as an output", what,
                      resource.name));
    return world_.storageOf(index, version);
}

// --- the public side ---

Executor::Executor(gl::ShaderLibrary& shaders, const ExecutorOptions& options)
    : impl_(std::make_unique<Impl>(shaders, options)) {}
Executor::~Executor() = default;

const ExecutorOptions& Executor::options() const { return impl_->next_; }
void Executor::setOptions(const ExecutorOptions& options) { impl_->next_ = options; }
FrameGraph& Executor::beginFrame() {
    impl_->beginFrame();
    return impl_->graph_;
}
TextureHandle Executor::findTexture(std::string_view name) const {
    return impl_->graph_.findTexture(name);
}
Result<void> Executor::execute() { return impl_->execute(); }
Result<void> Executor::runAgain(const void* data) { return impl_->runAgain(data); }
const FrameReport& Executor::report() const { return impl_->report_; }
void Executor::waitForTimings() { impl_->waitForTimings(); }
const CompiledGraph& Executor::compiled() const { return impl_->compiled_; }
void Executor::resetHistory() { impl_->persistent_.resetHistory(); }
void Executor::forgetCachedResults() { impl_->persistent_.forgetResults(); }
void Executor::allowNegative(std::string_view resourceName) {
    impl_->signed_.insert(hashName(resourceName));
}

StaticTexture Executor::registerTexture(std::string_view name, gl::Texture&& texture) {
    return impl_->statics_.add(name, std::move(texture), nullptr);
}
StaticTexture Executor::registerTexture(std::string_view name, gl::Texture&& texture,
                                        const gl::SamplerSpec& sampler) {
    return impl_->statics_.add(name, std::move(texture), &sampler);
}
StaticBuffer Executor::registerBuffer(std::string_view name, gl::Buffer&& buffer) {
    return impl_->statics_.add(name, std::move(buffer));
}
StaticGeometry Executor::registerGeometry(std::string_view name, const GeometryDesc& desc) {
    return impl_->statics_.add(name, desc);
}
void Executor::release(StaticTexture texture) {
    impl_->statics_.release(texture, impl_->framebuffers_);
}
void Executor::release(StaticBuffer buffer) { impl_->statics_.release(buffer); }
void Executor::release(StaticGeometry geometry) { impl_->statics_.release(geometry); }
gl::Texture& Executor::texture(StaticTexture texture) {
    return impl_->statics_.texture(texture.id).storage.texture;
}
gl::Buffer& Executor::buffer(StaticBuffer buffer) {
    return impl_->statics_.buffer(buffer.id).storage.buffer;
}

Image Executor::readImage(TextureHandle handle, int layer, int mip) {
    const Storage& storage = impl_->readable(handle.resource, handle.version, "readImage()");
    gl::ReadBack readBack = gl::ReadBack::start(storage.texture, mip);
    const Format format = impl_->graph_.desc(handle).format;
    if (!isIntegerFormat(format)) return gl::takeImage(readBack, layer);
    const gl::TextureRegion region = readBack.region();
    CHECK(layer >= 0 && layer < region.depth,
          fmt::format("layer {} of a texture with {}", layer, region.depth));
    Image image(region.width, region.height, readBack.channels());
    const std::vector<uint32_t> values = readBack.takeIntegers();
    const bool isSigned = format == Format::R32I;
    const size_t row = size_t(image.width) * size_t(image.channels);
    for (int y = 0; y < image.height; ++y)
        for (size_t x = 0; x < row; ++x) {
            const uint32_t value =
                values[(size_t(layer) * size_t(image.height) + size_t(y)) * row + x];
            image.at(0, image.height - 1 - y)[x] = isSigned ? float(int32_t(value)) : float(value);
        }
    return image;
}

std::vector<std::byte> Executor::readTexels(TextureHandle handle, int mip) {
    const Storage& storage = impl_->readable(handle.resource, handle.version, "readTexels()");
    const gl::TextureRegion region = storage.texture.mipRegion(mip);
    const gl::FormatInfo& info = gl::formatInfo(storage.texture.spec().internalFormat);
    std::vector<std::byte> texels(size_t(region.width) * size_t(region.height) *
                                  size_t(region.depth) * info.bytesPerTexel);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTextureImage(storage.texture.id(), mip, info.transferFormat, info.transferType,
                      GLsizei(texels.size()), texels.data());
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    return texels;
}

std::vector<std::byte> Executor::readBuffer(BufferHandle handle) {
    const Storage& storage = impl_->readable(handle.resource, handle.version, "readBuffer()");
    std::vector<std::byte> bytes(
        size_t(impl_->graph_.isAbsent(handle) ? 0 : impl_->graph_.desc(handle).bytes));
    if (!bytes.empty()) storage.buffer.read(0, bytes.data(), bytes.size());
    return bytes;
}

uint32_t Executor::textureName(TextureHandle handle) const {
    if (impl_->graph_.isAbsent(handle)) return 0;
    return impl_->readable(handle.resource, handle.version, "textureName()").texture.id();
}

} // namespace tyndall::fg
