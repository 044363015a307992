#pragma once
// Minima and maxima over ever larger cubes of bricks, for skipping empty space and bounding extinction.

#include <vector>

#include "media/brick_grid.h"

namespace tyndall {

struct PyramidCell {
    float minimum = 0, maximum = 0; // of the field anywhere in the cell
};

/// Level 0 has a cell for each brick (8³ cells of the grid); each cell of a further level covers 2³ of the one below;
/// the last level is one cell. Cells that reach beyond the grid count the 0 outside. The bounds are attained: a trilinear
/// field has its extremes at voxels. Empty for an empty grid.
class BrickPyramid {
public:
    BrickPyramid() = default;
    explicit BrickPyramid(const BrickGrid& grid);

    [[nodiscard]] int levelCount() const { return int(levels_.size()); }
    [[nodiscard]] ivec3 size(int level) const { return levels_[size_t(level)].size; }
    /// Edge of a cell in voxels: 8, 16, 32 …
    [[nodiscard]] static int cellEdge(int level) { return kBrickCells << level; }
    /// CHECKs (debug): inside size(level).
    [[nodiscard]] const PyramidCell& cell(int level, ivec3 position) const;
    /// All cells of a level, x fastest.
    [[nodiscard]] const std::vector<PyramidCell>& cells(int level) const {
        return levels_[size_t(level)].cells;
    }

private:
    struct Level {
        ivec3 size{0};
        std::vector<PyramidCell> cells;
    };
    std::vector<Level> levels_;
};

} // namespace tyndall
