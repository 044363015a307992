#include "media/brick_grid.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "media/sparse_voxels.h"

namespace tyndall {

namespace {

struct CellPosition {
    int cell;        // lowest voxel of the cell, relative to the grid's origin
    double fraction; // 0..1 within it
};

CellPosition cellAt(double index, int origin) {
    const double relative = index - double(origin);
    const double cell = std::floor(relative);
    return {int(cell), relative - cell};
}

} // namespace

double BrickGrid::sample(const dvec3& index) const {
    const Bounds bounds = indexBounds();
    for (int axis = 0; axis < 3; ++axis) // written so that NaN is outside
        if (!(index[axis] >= bounds.minimum[axis] && index[axis] < bounds.maximum[axis])) return 0;

    const CellPosition x = cellAt(index.x, origin.x), y = cellAt(index.y, origin.y),
                       z = cellAt(index.z, origin.z);
    const Brick& found = brick({x.cell / kBrickCells, y.cell / kBrickCells, z.cell / kBrickCells});
    if (found.slot == Brick::kNoSlot) return double(found.minimum);

    const int lx = x.cell % kBrickCells, ly = y.cell % kBrickCells, lz = z.cell % kBrickCells;
    constexpr int kRow = kBrickSamples, kSlice = kBrickSamples * kBrickSamples;
    const float* corner = samples.data() + size_t(found.slot) * kBrickSampleCount +
                          size_t(lz * kSlice + ly * kRow + lx);
    const auto alongX = [&](int offset) {
        return double(corner[offset]) * (1 - x.fraction) + double(corner[offset + 1]) * x.fraction;
    };
    const double front = alongX(0) * (1 - y.fraction) + alongX(kRow) * y.fraction;
    const double back = alongX(kSlice) * (1 - y.fraction) + alongX(kSlice + kRow) * y.fraction;
    return front * (1 - z.fraction) + back * z.fraction;
}

Bounds BrickGrid::indexBounds() const {
    if (bricks.empty()) return {};
    Bounds bounds;
    bounds.include(dvec3(origin));
    bounds.include(dvec3(origin) + double(kBrickCells) * dvec3(brickCount));
    return bounds;
}

BrickGrid makeBrickGrid(const std::vector<float>& voxels, ivec3 first, ivec3 size,
                        const dmat4& worldFromIndex) {
    CHECK(size.x >= 0 && size.y >= 0 && size.z >= 0, "a grid has no negative size");
    CHECK(voxels.size() == size_t(size.x) * size_t(size.y) * size_t(size.z), "one value a voxel");
    SparseVoxels sparse;
    const ivec3 last = first + size - 1;
    float block[kBlockVoxels];
    const auto fillBlock = [&](ivec3 blockOrigin) {
        size_t out = 0;
        for (int z = 0; z < kBlockSize; ++z)
            for (int y = 0; y < kBlockSize; ++y)
                for (int x = 0; x < kBlockSize; ++x, ++out) {
                    const ivec3 p = blockOrigin + ivec3(x, y, z) - first;
                    const bool inside = p.x >= 0 && p.y >= 0 && p.z >= 0 && p.x < size.x &&
                                        p.y < size.y && p.z < size.z;
                    block[out] =
                        !inside
                            ? 0.0f
                            : voxels[(size_t(p.z) * size_t(size.y) + size_t(p.y)) * size_t(size.x) +
                                     size_t(p.x)];
                }
    };
    const ivec3 begin = blockOriginOf(first);
    for (int z = begin.z; z <= last.z; z += kBlockSize)
        for (int y = begin.y; y <= last.y; y += kBlockSize)
            for (int x = begin.x; x <= last.x; x += kBlockSize) {
                fillBlock({x, y, z});
                const Result<void> added = sparse.addBlock({x, y, z}, block);
                CHECK(added.ok(), added.ok() ? "" : added.message());
            }
    CHECK(sparse.repairs().total() == 0,
          "voxels are finite, not negative and at most kMaximumVoxel");
    Result<BrickGrid> grid = sparse.build(worldFromIndex);
    CHECK(grid.ok(), grid.ok() ? "" : grid.message());
    return std::move(grid).value();
}

} // namespace tyndall
