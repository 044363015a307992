#include "media/brick_pyramid.h"

#include <algorithm>

#include "core/check.h"

namespace tyndall {

namespace {

size_t indexOf(ivec3 position, ivec3 size) {
    return (size_t(position.z) * size_t(size.y) + size_t(position.y)) * size_t(size.x) +
           size_t(position.x);
}

} // namespace

BrickPyramid::BrickPyramid(const BrickGrid& grid) {
    if (grid.bricks.empty()) return;
    Level& bricks = levels_.emplace_back();
    bricks.size = grid.brickCount;
    for (const Brick& brick : grid.bricks) bricks.cells.push_back({brick.minimum, brick.maximum});

    while (levels_.back().size != ivec3(1)) {
        const Level& below = levels_.back();
        Level level;
        level.size = (below.size + 1) / 2;
        for (int z = 0; z < level.size.z; ++z)
            for (int y = 0; y < level.size.y; ++y)
                for (int x = 0; x < level.size.x; ++x) {
                    const ivec3 first = 2 * ivec3(x, y, z);
                    PyramidCell merged = below.cells[indexOf(first, below.size)];
                    for (int child = 1; child < 8; ++child) {
                        const ivec3 p = first + ivec3(child & 1, (child >> 1) & 1, child >> 2);
                        const bool inside =
                            p.x < below.size.x && p.y < below.size.y && p.z < below.size.z;
                        const PyramidCell& part =
                            inside ? below.cells[indexOf(p, below.size)] : PyramidCell{};
                        merged.minimum = std::min(merged.minimum, part.minimum);
                        merged.maximum = std::max(merged.maximum, part.maximum);
                    }
                    level.cells.push_back(merged);
                }
        levels_.push_back(std::move(level));
    }
}

const PyramidCell& BrickPyramid::cell(int level, ivec3 position) const {
    const Level& found = levels_[size_t(level)];
    ASSERT(position.x >= 0 && position.y >= 0 && position.z >= 0 && position.x < found.size.x &&
           position.y < found.size.y && position.z < found.size.z);
    return found.cells[indexOf(position, found.size)];
}

} // namespace tyndall
