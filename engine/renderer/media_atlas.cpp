#include "renderer/media_atlas.h"

#include <algorithm>
#include <cmath>

#include "gl/buffer.h"
#include "gl/texture.h"
#include "shared/medium.h"

namespace tyndall {
namespace {

constexpr int kMostSlotsPerAxis =
    2048 / kBrickSamples; // GL 4.5 grants 3D textures of 2048³; also fits ten bits

ivec3 arrange(uint64_t slots) {
    const int edge = std::clamp(int(std::ceil(std::cbrt(double(slots)))), 1, kMostSlotsPerAxis);
    const int x = int(std::min<uint64_t>(uint64_t(edge), std::max<uint64_t>(slots, 1)));
    const int y =
        int(std::clamp<uint64_t>((slots + uint64_t(x) - 1) / uint64_t(x), 1, uint64_t(edge)));
    const uint64_t layer = uint64_t(x) * uint64_t(y);
    return {x, y, int(std::max<uint64_t>((slots + layer - 1) / layer, 1))};
}

ivec3 place(uint64_t slot, const ivec3& perAxis) {
    const uint64_t x = uint64_t(perAxis.x), y = uint64_t(perAxis.y);
    return {int(slot % x), int(slot / x % y), int(slot / (x * y))};
}

uint32_t packed(const ivec3& p) {
    return uint32_t(p.x) | uint32_t(p.y) << 10 | uint32_t(p.z) << 20;
}

} // namespace

MediaAtlas::MediaAtlas(fg::Executor& executor) : executor_(executor) {}

MediaAtlas::~MediaAtlas() {
    if (texture_.id) executor_.release(texture_);
    if (bricks_.id) executor_.release(bricks_);
}

Result<void> MediaAtlas::update(std::span<const std::shared_ptr<const BrickGrid>> grids) {
    std::vector<Entry> wanted;
    uint64_t brickCount = 0, slotCount = 0;
    for (const std::shared_ptr<const BrickGrid>& grid : grids) {
        if (std::any_of(wanted.begin(), wanted.end(),
                        [&](const Entry& e) { return e.grid == grid; }))
            continue;
        wanted.push_back({grid, uint32_t(brickCount), uint32_t(slotCount)});
        brickCount += grid->bricks.size();
        slotCount += grid->slotCount();
    }
    const bool same = version_ != 0 &&
                      std::equal(wanted.begin(), wanted.end(), entries_.begin(), entries_.end(),
                                 [](const Entry& a, const Entry& b) { return a.grid == b.grid; });
    if (same) return {};
    entries_ = std::move(wanted);
    if (Result<void> done = uploadSamples(slotCount); !done) {
        entries_.clear();
        return done;
    }
    uploadTables(brickCount);
    version_ = nextVersion();
    return {};
}

uint32_t MediaAtlas::firstBrick(const BrickGrid& grid) const {
    const auto found = std::find_if(entries_.begin(), entries_.end(),
                                    [&](const Entry& e) { return e.grid.get() == &grid; });
    CHECK(found != entries_.end(), "the atlas was not given this grid");
    return found->firstBrick;
}

Result<void> MediaAtlas::uploadSamples(uint64_t slotCount) {
    constexpr uint64_t kMost = uint64_t(kMostSlotsPerAxis) * kMostSlotsPerAxis * kMostSlotsPerAxis;
    if (slotCount > kMost)
        return Error{"the scene's grids have " + std::to_string(slotCount) +
                     " bricks that are not constant; at most " + std::to_string(kMost) +
                     " can be rendered"};
    slotsPerAxis_ = arrange(slotCount);
    const ivec3 texels = slotsPerAxis_ * kBrickSamples;
    Result<gl::Texture> texture = gl::Texture::create(
        "media.atlas", {GL_TEXTURE_3D, GL_R32F, texels.x, texels.y, texels.z, 1});
    if (!texture) return texture.error();
    for (const Entry& entry : entries_)
        for (uint32_t slot = 0; slot < entry.grid->slotCount(); ++slot) {
            const ivec3 first = kBrickSamples * place(entry.firstSlot + slot, slotsPerAxis_);
            texture->write(
                {0, first.x, first.y, first.z, kBrickSamples, kBrickSamples, kBrickSamples},
                entry.grid->samples.data() + size_t(slot) * kBrickSampleCount,
                kBrickSampleCount * sizeof(float));
        }
    if (texture_.id) executor_.release(texture_);
    texture_ = executor_.registerTexture("media.atlas", std::move(*texture));
    return {};
}

void MediaAtlas::uploadTables(uint64_t brickCount) {
    std::vector<gpu::BrickData> table(std::max<uint64_t>(brickCount, 1),
                                      gpu::BrickData{0, 0, gpu::kNoSlot, 0});
    for (const Entry& entry : entries_)
        for (size_t i = 0; i < entry.grid->bricks.size(); ++i) {
            const Brick& brick = entry.grid->bricks[i];
            const uint32_t slot = brick.slot == Brick::kNoSlot
                                      ? gpu::kNoSlot
                                      : packed(place(entry.firstSlot + brick.slot, slotsPerAxis_));
            table[entry.firstBrick + i] = {brick.minimum, brick.maximum, slot, 0};
        }
    if (bricks_.id) executor_.release(bricks_);
    brickBytes_ = table.size() * sizeof(gpu::BrickData);
    bricks_ = executor_.registerBuffer("media.bricks",
                                       gl::Buffer("media.bricks", std::as_bytes(std::span(table))));
}

} // namespace tyndall
