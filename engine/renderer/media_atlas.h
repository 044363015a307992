#pragma once
// The grids of a scene on the GPU: one 3D texture of 9³-sample bricks and one buffer of brick tables.

#include <memory>
#include <span>
#include <vector>

#include "core/result.h"
#include "core/version.h"
#include "framegraph/gl/executor.h"
#include "media/brick_grid.h"

namespace tyndall {

class MediaAtlas {
public:
    /// `executor` must outlive the atlas, and its context be current.
    explicit MediaAtlas(fg::Executor& executor);
    ~MediaAtlas();
    MediaAtlas(const MediaAtlas&) = delete;
    MediaAtlas& operator=(const MediaAtlas&) = delete;

    /// Uploads these grids (repeats are stored once) unless they are the ones that are there already.
    /// Errors: more bricks than a 3D texture of this GL holds, or no memory for them.
    Result<void> update(std::span<const std::shared_ptr<const BrickGrid>> grids);
    /// Where the grid's table begins in `Bricks`. CHECKs that update() was given the grid.
    [[nodiscard]] uint32_t firstBrick(const BrickGrid& grid) const;

    [[nodiscard]] fg::StaticTexture texture() const { return texture_; }
    [[nodiscard]] fg::StaticBuffer bricks() const { return bricks_; }
    [[nodiscard]] uint64_t brickBytes() const { return brickBytes_; }
    /// Changes with the content.
    [[nodiscard]] Version version() const { return version_; }

private:
    struct Entry {
        std::shared_ptr<const BrickGrid> grid;
        uint32_t firstBrick, firstSlot;
    };
    Result<void> uploadSamples(uint64_t slotCount);
    void uploadTables(uint64_t brickCount);

    fg::Executor& executor_;
    std::vector<Entry> entries_;
    ivec3 slotsPerAxis_{1};
    fg::StaticTexture texture_;
    fg::StaticBuffer bricks_;
    uint64_t brickBytes_ = 0;
    Version version_ = 0;
};

} // namespace tyndall
