#pragma once
// The grids of a scene on the GPU: one 3D texture of 9³-sample bricks and one buffer of brick tables. Grids come and go one by one: what
// stays keeps its place and is not uploaded again.
//
// A brick lies in any free slot of the texture, so that slots cannot be too scattered to use. A grid's table lies in one piece; where the
// free pieces are all too small, the tables are laid out anew (16 bytes a brick).

#include <memory>
#include <span>
#include <vector>

#include "core/result.h"
#include "core/version.h"
#include "framegraph/gl/executor.h"
#include "media/brick_grid.h"
#include "renderer/free_ranges.h"
#include "shared/medium.h"

namespace tyndall::gl {
class Texture;
}

namespace tyndall {

class MediaAtlas {
public:
    /// `executor` must outlive the atlas, and its context be current.
    explicit MediaAtlas(fg::Executor& executor);
    ~MediaAtlas();
    MediaAtlas(const MediaAtlas&) = delete;
    MediaAtlas& operator=(const MediaAtlas&) = delete;

    /// Makes these the atlas's grids (repeats are stored once): uploads those that are new, and gives the places of those that are gone
    /// to others. Errors, after which the atlas is as it was: more bricks than a 3D texture of this GL holds, or no memory for them.
    Result<void> update(std::span<const std::shared_ptr<const BrickGrid>> grids);
    /// Where the grid's table begins in `Bricks`. CHECKs that update() was given the grid.
    [[nodiscard]] uint32_t firstBrick(const BrickGrid& grid) const;

    [[nodiscard]] fg::StaticTexture texture() const { return texture_; }
    [[nodiscard]] fg::StaticBuffer bricks() const { return bricks_; }
    [[nodiscard]] uint64_t brickBytes() const { return table_.size() * sizeof(gpu::BrickData); }
    /// Changes with the content.
    [[nodiscard]] Version version() const { return version_; }

    /// Bricks that the texture has room for: at most some five quarters of the most that were in use together, and at most four times
    /// those that are in use now.
    [[nodiscard]] uint64_t slotCapacity() const;
    /// Sent to the GPU since the start, bytes.
    struct Uploaded {
        uint64_t samples = 0, tables = 0;
    };
    [[nodiscard]] const Uploaded& uploaded() const { return uploaded_; }

private:
    using Grid = std::shared_ptr<const BrickGrid>;
    struct Entry {
        Grid grid;
        uint32_t firstBrick = 0;
        std::vector<uint32_t> slots; // of the texture, by slot of the grid
    };
    /// Room for other samples than there is now.
    [[nodiscard]] bool wantsOtherTexture(uint64_t slotCount) const;
    Result<gl::Texture> makeTexture(uint64_t slotCount, ivec3& slotsPerAxis) const;
    void dropAllBut(const std::vector<Grid>& wanted);
    void moveInto(gl::Texture&& texture, const ivec3& slotsPerAxis);
    void addGrids(const std::vector<Grid>& wanted);
    void uploadSamples(Entry& entry);
    void layOutTables();
    void fillTable(const Entry& entry);

    fg::Executor& executor_;
    std::vector<Entry> entries_;
    ivec3 slotsPerAxis_{0};
    std::vector<uint32_t> freeSlots_;   // the lowest last
    std::vector<gpu::BrickData> table_; // as in `bricks_`
    FreeRanges freeBricks_;             // of table_
    fg::StaticTexture texture_;
    fg::StaticBuffer bricks_;
    Uploaded uploaded_;
    Version version_ = 0;
};

} // namespace tyndall
