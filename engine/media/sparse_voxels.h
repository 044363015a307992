#pragma once
// Voxels as sparse files have them, blocks of 8³ and constant tiles, on their way into a BrickGrid. No dense array is
// ever made, so a file with a few voxels in a huge box costs little, and one that would cost too much is refused.

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "core/result.h"
#include "media/brick_grid.h"
#include "media/grid_import.h"

namespace tyndall {

inline constexpr int kBlockSize = 8;
inline constexpr int kBlockVoxels = kBlockSize * kBlockSize * kBlockSize;
/// Indices beyond this are refused: sums of them would overflow.
inline constexpr int kMaximumIndex = 1 << 28;

/// Origin of the block that holds the voxel: multiples of 8, rounded towards -∞.
[[nodiscard]] inline ivec3 blockOriginOf(ivec3 voxel) {
    return {voxel.x & ~7, voxel.y & ~7, voxel.z & ~7};
}

/// How many voxels were not a density, and were changed: a tile counts as all of its voxels.
struct VoxelRepairs {
    uint64_t nonFinite = 0; // set to 0
    uint64_t negative = 0;  // set to 0
    uint64_t huge = 0;      // set to kMaximumVoxel
    [[nodiscard]] uint64_t total() const { return nonFinite + negative + huge; }
};

class SparseVoxels {
public:
    explicit SparseVoxels(const GridLimits& limits = {}) : limits_(limits) {}

    /// Takes 8³ values, x fastest. Values that are no density are repaired and counted; denormal ones become 0.
    /// Errors: origin no multiple of 8 or beyond kMaximumIndex; a block given twice; too many for the limits.
    Result<void> addBlock(ivec3 origin, const float* values);
    /// Takes a cube of `size` voxels (a power of two, at least 8) with one value. Errors as addBlock.
    Result<void> addTile(ivec3 origin, int size, float value);

    [[nodiscard]] const VoxelRepairs& repairs() const { return repairs_; }

    /// The bricks of all that was added. Errors: brick table or samples beyond the limits.
    [[nodiscard]] Result<BrickGrid> build(const dmat4& worldFromIndex) const;

private:
    struct Key {
        int x, y, z;
        bool operator==(const Key&) const = default;
    };
    struct KeyHash {
        size_t operator()(const Key& key) const;
    };
    struct Tile {
        ivec3 origin;
        int size;
        float value;
    };
    struct View {            // one block as build() sees it
        const float* values; // null: constant
        float constant;
    };
    float repaired(float value, uint64_t voxels);
    void includeVoxels(ivec3 lowest, ivec3 highest);
    [[nodiscard]] View viewBlock(ivec3 block) const; // in units of blocks
    void gather(ivec3 firstSample, float* samples) const;
    void markBricks(const BrickGrid& grid, ivec3 lowest, ivec3 highest,
                    std::vector<uint8_t>& touched) const;
    void placeTiles(BrickGrid& grid, std::vector<uint8_t>& touched) const;

    GridLimits limits_;
    VoxelRepairs repairs_;
    std::vector<float> values_; // block after block
    std::vector<ivec3> origins_;
    std::unordered_map<Key, uint32_t, KeyHash> blocks_; // by origin/8
    std::vector<Tile> tiles_;
    std::unordered_map<int, std::unordered_map<Key, float, KeyHash>> tilesBySize_; // by origin/size
    ivec3 lowest_{kMaximumIndex + 1}, highest_{-kMaximumIndex - 1}; // of the voxels that are not 0
};

} // namespace tyndall
