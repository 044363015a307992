#include "renderer/media_atlas.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "gl/buffer.h"
#include "gl/texture.h"

namespace tyndall {
namespace {

constexpr int kMostSlotsPerAxis =
    2048 / kBrickSamples; // GL 4.5 grants 3D textures of 2048³; also fits ten bits
constexpr uint64_t kMostSlots = uint64_t(kMostSlotsPerAxis) * kMostSlotsPerAxis * kMostSlotsPerAxis;
/// What has to grow grows by a quarter more than it must: a sequence of ever larger grids moves it few times.
constexpr uint64_t withHeadroom(uint64_t count) { return count + count / 4; }
/// A texture of more than so many times what is in use is given back.
constexpr uint64_t kMostUnused = 4;

ivec3 arrange(uint64_t slots) {
    const int edge = std::clamp(int(std::ceil(std::cbrt(double(slots)))), 1, kMostSlotsPerAxis);
    const int x = int(std::min<uint64_t>(uint64_t(edge), std::max<uint64_t>(slots, 1)));
    const int y =
        int(std::clamp<uint64_t>((slots + uint64_t(x) - 1) / uint64_t(x), 1, uint64_t(edge)));
    const uint64_t layer = uint64_t(x) * uint64_t(y);
    return {x, y, int(std::max<uint64_t>((slots + layer - 1) / layer, 1))};
}

uint64_t slotsOf(const ivec3& perAxis) {
    return uint64_t(perAxis.x) * uint64_t(perAxis.y) * uint64_t(perAxis.z);
}

ivec3 place(uint32_t slot, const ivec3& perAxis) {
    const uint32_t x = uint32_t(perAxis.x), y = uint32_t(perAxis.y);
    return {int(slot % x), int(slot / x % y), int(slot / (x * y))};
}

uint32_t packed(const ivec3& p) {
    return uint32_t(p.x) | uint32_t(p.y) << 10 | uint32_t(p.z) << 20;
}

gl::TextureRegion regionOf(uint32_t slot, const ivec3& perAxis) {
    const ivec3 first = kBrickSamples * place(slot, perAxis);
    return {0, first.x, first.y, first.z, kBrickSamples, kBrickSamples, kBrickSamples};
}

bool holds(std::span<const std::shared_ptr<const BrickGrid>> grids, const BrickGrid* grid) {
    return std::any_of(grids.begin(), grids.end(),
                       [&](const auto& other) { return other.get() == grid; });
}

} // namespace

MediaAtlas::MediaAtlas(fg::Executor& executor) : executor_(executor) {}

MediaAtlas::~MediaAtlas() {
    if (texture_.id) executor_.release(texture_);
    if (bricks_.id) executor_.release(bricks_);
}

uint64_t MediaAtlas::slotCapacity() const { return slotsOf(slotsPerAxis_); }

Result<void> MediaAtlas::update(std::span<const Grid> grids) {
    std::vector<Grid> wanted;
    for (const Grid& grid : grids)
        if (!holds(wanted, grid.get())) wanted.push_back(grid);
    const bool same = version_ != 0 && wanted.size() == entries_.size() &&
                      std::all_of(entries_.begin(), entries_.end(),
                                  [&](const Entry& e) { return holds(wanted, e.grid.get()); });
    if (same) return {};
    uint64_t slotCount = 0;
    for (const Grid& grid : wanted) slotCount += grid->slotCount();
    if (slotCount > kMostSlots)
        return Error{"the scene's grids have " + std::to_string(slotCount) +
                     " bricks that are not constant; at most " + std::to_string(kMostSlots) +
                     " can be rendered"};

    if (wantsOtherTexture(slotCount)) {
        ivec3 slotsPerAxis(0);
        Result<gl::Texture> texture = makeTexture(slotCount, slotsPerAxis);
        if (!texture) return texture.error();
        dropAllBut(wanted);
        moveInto(std::move(*texture), slotsPerAxis);
    } else {
        dropAllBut(wanted);
    }
    addGrids(wanted);
    version_ = nextVersion();
    return {};
}

uint32_t MediaAtlas::firstBrick(const BrickGrid& grid) const {
    const auto found = std::find_if(entries_.begin(), entries_.end(),
                                    [&](const Entry& e) { return e.grid.get() == &grid; });
    CHECK(found != entries_.end(), "the atlas was not given this grid");
    return found->firstBrick;
}

bool MediaAtlas::wantsOtherTexture(uint64_t slotCount) const {
    return !texture_.id || slotCount > slotCapacity() ||
           kMostUnused * slotsOf(arrange(slotCount)) < slotCapacity();
}

Result<gl::Texture> MediaAtlas::makeTexture(uint64_t slotCount, ivec3& slotsPerAxis) const {
    const auto make = [&](uint64_t slots) {
        slotsPerAxis = arrange(slots);
        const ivec3 texels = slotsPerAxis * kBrickSamples;
        return gl::Texture::create("media.atlas",
                                   {GL_TEXTURE_3D, GL_R32F, texels.x, texels.y, texels.z, 1});
    };
    const uint64_t most = std::min(withHeadroom(slotCount), kMostSlots);
    if (texture_.id && slotCount > slotCapacity())
        if (Result<gl::Texture> texture = make(most)) return texture;
    return make(slotCount);
}

void MediaAtlas::dropAllBut(const std::vector<Grid>& wanted) {
    std::erase_if(entries_, [&](const Entry& entry) {
        if (holds(wanted, entry.grid.get())) return false;
        freeSlots_.insert(freeSlots_.end(), entry.slots.begin(), entry.slots.end());
        freeBricks_.give(entry.firstBrick, uint32_t(entry.grid->bricks.size()));
        return true;
    });
    std::sort(freeSlots_.begin(), freeSlots_.end(), std::greater<>());
}

/// The samples of the grids that stay go over from GPU to GPU, to the first slots; their tables must be made anew.
void MediaAtlas::moveInto(gl::Texture&& texture, const ivec3& slotsPerAxis) {
    uint32_t next = 0;
    for (Entry& entry : entries_)
        for (uint32_t& slot : entry.slots) {
            const gl::TextureRegion to = regionOf(next, slotsPerAxis);
            texture.copyFrom(executor_.texture(texture_), regionOf(slot, slotsPerAxis_), to.x, to.y,
                             to.z);
            slot = next++;
        }
    slotsPerAxis_ = slotsPerAxis;
    freeSlots_.clear();
    for (uint32_t slot = uint32_t(slotCapacity()); slot-- > next;) freeSlots_.push_back(slot);
    if (texture_.id) executor_.release(texture_);
    texture_ = executor_.registerTexture("media.atlas", std::move(texture));
    table_.clear();
}

void MediaAtlas::addGrids(const std::vector<Grid>& wanted) {
    const size_t kept = entries_.size();
    for (const Grid& grid : wanted) {
        const bool there = std::any_of(entries_.begin(), entries_.end(),
                                       [&](const Entry& e) { return e.grid == grid; });
        if (there) continue;
        entries_.push_back({grid, 0, {}});
        uploadSamples(entries_.back());
    }
    uint64_t brickCount = 0;
    for (const Entry& entry : entries_) brickCount += entry.grid->bricks.size();
    if (table_.size() > kMostUnused * std::max<uint64_t>(brickCount, 1)) table_.clear();
    for (size_t i = kept; i < entries_.size() && !table_.empty(); ++i) {
        Entry& entry = entries_[i];
        const auto first = freeBricks_.take(uint32_t(entry.grid->bricks.size()));
        if (!first) return layOutTables();
        entry.firstBrick = *first;
        fillTable(entry);
        const auto bytes =
            std::as_bytes(std::span(table_).subspan(entry.firstBrick, entry.grid->bricks.size()));
        if (bytes.empty()) continue;
        executor_.buffer(bricks_).write(entry.firstBrick * sizeof(gpu::BrickData), bytes.data(),
                                        bytes.size());
        uploaded_.tables += bytes.size();
    }
    if (table_.empty()) layOutTables();
}

void MediaAtlas::uploadSamples(Entry& entry) {
    gl::Texture& texture = executor_.texture(texture_);
    constexpr size_t kBytes = kBrickSampleCount * sizeof(float);
    for (uint32_t i = 0; i < entry.grid->slotCount(); ++i) {
        const uint32_t slot = freeSlots_.back();
        freeSlots_.pop_back();
        entry.slots.push_back(slot);
        texture.write(regionOf(slot, slotsPerAxis_),
                      entry.grid->samples.data() + size_t(i) * kBrickSampleCount, kBytes);
        uploaded_.samples += kBytes;
    }
}

/// All tables in a row, in a buffer of their own.
void MediaAtlas::layOutTables() {
    uint64_t count = 0;
    for (Entry& entry : entries_) {
        entry.firstBrick = uint32_t(count);
        count += entry.grid->bricks.size();
    }
    const uint64_t size = std::max<uint64_t>(bricks_.id ? withHeadroom(count) : count, 1);
    table_.assign(size, gpu::BrickData{0, 0, gpu::kNoSlot, 0});
    freeBricks_ = FreeRanges(uint32_t(size));
    if (count > 0) (void)freeBricks_.take(uint32_t(count));
    for (const Entry& entry : entries_) fillTable(entry);
    if (bricks_.id) executor_.release(bricks_);
    bricks_ = executor_.registerBuffer(
        "media.bricks",
        gl::Buffer("media.bricks", std::as_bytes(std::span(table_)), gl::BufferAccess::CpuUpdates));
    uploaded_.tables += table_.size() * sizeof(gpu::BrickData);
}

void MediaAtlas::fillTable(const Entry& entry) {
    for (size_t i = 0; i < entry.grid->bricks.size(); ++i) {
        const Brick& brick = entry.grid->bricks[i];
        const uint32_t slot = brick.slot == Brick::kNoSlot
                                  ? gpu::kNoSlot
                                  : packed(place(entry.slots[brick.slot], slotsPerAxis_));
        table_[entry.firstBrick + i] = {brick.minimum, brick.maximum, slot, 0};
    }
}

} // namespace tyndall
