#include "framegraph/gl/storage.h"

#include <fmt/format.h>

#include <limits>

#include "core/check.h"
#include "core/cpu_profiler.h"
#include "framegraph/gl/gl_format.h"
#include "gl/context.h"

namespace tyndall::fg {

Storage::Storage(std::string_view name, const TextureDesc& desc)
    : texture(name, glSpec(desc)), format(desc.format) {}

// Sizes are rounded up: clearing needs 4 bytes, and some drivers take a block for a multiple of 16.
Storage::Storage(std::string_view name, const BufferDesc& desc)
    : buffer(name, (desc.bytes + 15) / 16 * 16) {}

gl::Texture& Storage::view(int mip, int layer, bool as2D) {
    if (mip < 0 && layer < 0) return texture;
    for (View& view : views_)
        if (view.mip == mip && view.layer == layer && view.as2D == as2D) return *view.texture;
    const gl::TextureSpec& spec = texture.spec();
    CHECK(layer < 0 || spec.target == GL_TEXTURE_2D_ARRAY,
          "only layers of an array can be sampled alone");
    const GLenum target = layer >= 0 && as2D ? GL_TEXTURE_2D : spec.target;
    const int allLayers = spec.target == GL_TEXTURE_2D_ARRAY ? spec.depth : 1;
    View view{mip, layer, as2D, nullptr};
    view.texture = std::make_unique<gl::Texture>(texture.view(
        fmt::format("level {}, layer {}", mip, layer), target, spec.internalFormat,
        std::max(mip, 0), mip < 0 ? spec.mips : 1, std::max(layer, 0), layer < 0 ? allLayers : 1));
    views_.push_back(std::move(view));
    return *views_.back().texture;
}

void Storage::clearToZero() {
    if (buffer)
        buffer.clear(0);
    else if (isIntegerFormat(format))
        texture.clearInteger(0);
    else
        texture.clear(0);
}

void Storage::poison() {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    if (buffer)
        buffer.clear(0xffffffffu);
    else if (isIntegerFormat(format))
        texture.clearInteger(0xffffffffu, 0xffffffffu, 0xffffffffu, 0xffffffffu);
    else if (isFloatColor(format))
        texture.clear(kNan, kNan, kNan, kNan);
    else
        texture.clear(
            1, 1, 1,
            1); // normalised and depth formats have no NaN that survives: something that shows
}

void StorageSet::drop(std::unique_ptr<Storage>& storage) {
    if (storage && storage->texture) framebuffers_.forget(storage->texture);
    storage.reset();
}

void StorageSet::beginFrame(const PersistentTable& table) {
    ++frame_;
    for (size_t i = 0; i < pool_.size();) {
        if (pool_[i].lastFrame + kFramesKept >= frame_) {
            ++i;
            continue;
        }
        drop(pool_[i].storage);
        pool_.erase(pool_.begin() + std::ptrdiff_t(i));
    }
    for (size_t i = 0; i < persistent_.size(); ++i) {
        const PersistentEntry& entry = table.entry(uint32_t(i / 2));
        if (persistent_[i].storage &&
            (!entry.alive || entry.generation != persistent_[i].generation))
            drop(persistent_[i].storage);
    }
}

Storage& StorageSet::takePooled(const PoolSlot& shape) {
    for (Pooled& pooled : pool_) {
        const bool fits = pooled.shape.isBuffer == shape.isBuffer &&
                          pooled.shape.texture == shape.texture &&
                          pooled.shape.buffer == shape.buffer;
        if (!fits || pooled.lastFrame == frame_) continue;
        pooled.lastFrame = frame_;
        return *pooled.storage;
    }
    const std::string name = fmt::format("pool {}", pool_.size());
    pool_.push_back({shape.isBuffer ? std::make_unique<Storage>(name, shape.buffer)
                                    : std::make_unique<Storage>(name, shape.texture),
                     shape, frame_});
    return *pool_.back().storage;
}

void StorageSet::checkRoom(const CompiledGraph& graph) const {
    uint64_t wanted = 0, have = 0;
    for (const PoolSlot& shape : graph.slots)
        wanted +=
            shape.isBuffer ? shape.buffer.bytes : uint64_t(gl::textureBytes(glSpec(shape.texture)));
    for (const Pooled& pooled : pool_) have += pooled.storage->bytes();
    // Below this no machine is in trouble, and the question costs nothing.
    constexpr uint64_t kWorthAsking = uint64_t(1) << 30;
    if (wanted < have + kWorthAsking || !gl::currentCapabilities().isSoftware()) return;
    const uint64_t free = availableMemoryBytes();
    // A quarter is left for what reads the pictures back and writes them.
    if (wanted - have <= free / 4 * 3) return;
    throw gl::NoRoom(
        fmt::format("its passes need {:.1f} GiB of memory at once, of which {:.1f} GiB are free",
                    double(wanted - have) / (1 << 30), double(free) / (1 << 30)));
}

void StorageSet::assignSlots(const CompiledGraph& graph) {
    checkRoom(graph);
    slots_.clear();
    for (const PoolSlot& shape : graph.slots) slots_.push_back(&takePooled(shape));
}

Storage& StorageSet::persistent(const PersistentTable& table, uint32_t storageIndex,
                                std::string_view name) {
    if (storageIndex >= persistent_.size()) persistent_.resize(storageIndex + 1);
    Persistent& place = persistent_[storageIndex];
    const PersistentEntry& entry = table.entry(storageIndex / 2);
    if (place.storage && place.generation == entry.generation) return *place.storage;
    drop(place.storage);
    place.storage = entry.isBuffer ? std::make_unique<Storage>(name, entry.buffer)
                                   : std::make_unique<Storage>(name, entry.texture);
    place.generation = entry.generation;
    return *place.storage;
}

Storage& StorageSet::absentTexture(const TextureDesc& desc, bool poison) {
    for (Absent& absent : absent_)
        if (absent.kind == desc.kind && absent.format == desc.format && absent.poison == poison)
            return *absent.storage;
    const TextureDesc one{desc.kind, desc.format, 1, 1, 1, 1};
    auto storage =
        std::make_unique<Storage>(fmt::format("absent {}", formatName(desc.format)), one);
    poison ? storage->poison() : storage->clearToZero();
    absent_.push_back({desc.kind, desc.format, poison, std::move(storage)});
    return *absent_.back().storage;
}

Storage& StorageSet::absentBuffer(bool poison) {
    std::unique_ptr<Storage>& storage = absentBuffers_[poison ? 1 : 0];
    if (!storage) {
        storage = std::make_unique<Storage>("absent buffer", BufferDesc{kAbsentBytes});
        poison ? storage->poison() : storage->clearToZero();
    }
    return *storage;
}

StorageSet::Totals StorageSet::totals() const {
    Totals totals;
    const auto add = [&](const std::unique_ptr<Storage>& storage) {
        if (!storage) return;
        totals.bytes += storage->bytes();
        storage->texture ? ++totals.textures : ++totals.buffers;
    };
    for (const Pooled& pooled : pool_) add(pooled.storage);
    for (const Persistent& persistent : persistent_) add(persistent.storage);
    for (const Absent& absent : absent_) add(absent.storage);
    for (const auto& storage : absentBuffers_) add(storage);
    return totals;
}

} // namespace tyndall::fg
