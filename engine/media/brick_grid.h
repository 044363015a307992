#pragma once
// A scalar field in bricks: the one form in which grids reach the renderer, whatever file they came from.
//
// Voxel (i,j,k) lies at index position (i,j,k); the field between voxels is trilinear; outside the stored voxels
// it is 0. A *cell* is the cube between eight voxels. Brick (bx,by,bz) covers the 8³ cells
// whose lowest voxels are origin + 8·(bx,by,bz) + [0,8)³, and so needs 9³ samples: bricks repeat the
// samples on their shared faces, hardware trilinear filtering never leaves a brick, and the minimum and
// maximum of the samples bound the field inside exactly (a trilinear field has its extremes at corners).

#include <cstdint>
#include <vector>

#include "core/math.h"

namespace tyndall {

inline constexpr int kBrickCells = 8;
inline constexpr int kBrickSamples = 9;
inline constexpr int kBrickSampleCount = kBrickSamples * kBrickSamples * kBrickSamples;

/// One brick. minimum == maximum: constant, and no samples are stored (slot == kNoSlot).
struct Brick {
    static constexpr uint32_t kNoSlot = 0xffffffffu;
    float minimum = 0, maximum = 0;
    uint32_t slot = kNoSlot;
};

/// Immutable after construction; shared between scene, renderer and reference.
struct BrickGrid {
    ivec3 origin{0}; // index of the lowest voxel of brick (0,0,0); one below the first stored voxel
    ivec3 brickCount{0};
    std::vector<Brick> bricks;  // x fastest, then y, then z
    std::vector<float> samples; // slotCount × 9³, x fastest
    dmat4 worldFromIndex{
        1.0}; // the file's transform, any affine one ("world" is the medium's node space)
    float minimum = 0, maximum = 0;
    double meanOfPositive = 0; // of all samples above 0; 0 where there are none

    [[nodiscard]] uint32_t slotCount() const {
        return uint32_t(samples.size() / kBrickSampleCount);
    }
    [[nodiscard]] const Brick& brick(ivec3 b) const {
        return bricks[(size_t(b.z) * size_t(brickCount.y) + size_t(b.y)) * size_t(brickCount.x) +
                      size_t(b.x)];
    }
    /// The field at an index position, trilinear, in double precision; 0 outside.
    [[nodiscard]] double sample(const dvec3& index) const;
    /// Index-space box outside which the field is 0.
    [[nodiscard]] Bounds indexBounds() const;
};

/// Builds bricks from dense voxels (x fastest), `first` being the index of the first one.
/// Bricks whose samples are all equal store nothing; leading and trailing empty voxels are trimmed.
/// CHECKs: one value a voxel; all finite, not negative, at most kMaximumVoxel (grid_import.h).
BrickGrid makeBrickGrid(const std::vector<float>& voxels, ivec3 first, ivec3 size,
                        const dmat4& worldFromIndex);

} // namespace tyndall
