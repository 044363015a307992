#include "media/sparse_voxels.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>

namespace tyndall {

namespace {

int floorDivide(int a, int b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

ivec3 floorDivide(ivec3 a, int b) {
    return {floorDivide(a.x, b), floorDivide(a.y, b), floorDivide(a.z, b)};
}

Result<void> checkPlace(ivec3 origin, int size) {
    for (int axis = 0; axis < 3; ++axis) {
        if (origin[axis] % size != 0)
            return Error{
                fmt::format("a block of {0}³ voxels begins at {1}, which is no multiple of {0}",
                            size, origin[axis])};
        if (origin[axis] < -kMaximumIndex || origin[axis] > kMaximumIndex - size)
            return Error{
                fmt::format("voxels lie at index {}, farther out than the {} that can be used",
                            origin[axis], kMaximumIndex)};
    }
    return {};
}

} // namespace

size_t SparseVoxels::KeyHash::operator()(const Key& key) const {
    uint64_t hash = uint64_t(uint32_t(key.x)) * 0x9e3779b97f4a7c15u;
    hash = (hash ^ (hash >> 29) ^ uint32_t(key.y)) * 0xbf58476d1ce4e5b9u;
    hash = (hash ^ (hash >> 32) ^ uint32_t(key.z)) * 0x94d049bb133111ebu;
    return size_t(hash ^ (hash >> 31));
}

float SparseVoxels::repaired(float value, uint64_t voxels) {
    if (!std::isfinite(value)) {
        repairs_.nonFinite += voxels;
        return 0;
    }
    if (value < 0) {
        repairs_.negative += voxels;
        return 0;
    }
    if (value > kMaximumVoxel) {
        repairs_.huge += voxels;
        return kMaximumVoxel;
    }
    return std::fpclassify(value) == FP_SUBNORMAL ? 0.0f : value + 0.0f; // + 0 turns -0 into 0
}

void SparseVoxels::includeVoxels(ivec3 lowest, ivec3 highest) {
    lowest_ = glm::min(lowest_, lowest);
    highest_ = glm::max(highest_, highest);
}

Result<void> SparseVoxels::addBlock(ivec3 origin, const float* values) {
    if (const Result<void> place = checkPlace(origin, kBlockSize); !place) return place.error();
    const size_t begin = values_.size();
    values_.resize(begin + kBlockVoxels);
    bool any = false;
    for (int i = 0; i < kBlockVoxels; ++i) {
        const float value = repaired(values[i], 1);
        values_[begin + size_t(i)] = value;
        if (value == 0) continue;
        any = true;
        const ivec3 voxel = origin + ivec3(i & 7, (i >> 3) & 7, i >> 6);
        includeVoxels(voxel, voxel);
    }
    if (!any) {
        values_.resize(begin);
        return {};
    }
    const ivec3 block = floorDivide(origin, kBlockSize);
    if (!blocks_.emplace(Key{block.x, block.y, block.z}, uint32_t(origins_.size())).second)
        return Error{
            fmt::format("the block at ({}, {}, {}) is given twice", origin.x, origin.y, origin.z)};
    origins_.push_back(origin);
    if (values_.size() * sizeof(float) > limits_.sampleBytes)
        return Error{
            fmt::format("its voxels take more than the {} MiB allowed", limits_.sampleBytes >> 20)};
    return {};
}

Result<void> SparseVoxels::addTile(ivec3 origin, int size, float value) {
    if (size < kBlockSize || size > kMaximumIndex || !std::has_single_bit(unsigned(size)))
        return Error{fmt::format(
            "a tile has an edge of {} voxels; powers of two from 8 on are possible", size)};
    if (const Result<void> place = checkPlace(origin, size); !place) return place.error();
    const float usable = repaired(value, uint64_t(size) * uint64_t(size) * uint64_t(size));
    if (usable == 0) return {};
    const ivec3 key = floorDivide(origin, size);
    if (!tilesBySize_[size].emplace(Key{key.x, key.y, key.z}, usable).second)
        return Error{
            fmt::format("the tile at ({}, {}, {}) is given twice", origin.x, origin.y, origin.z)};
    tiles_.push_back({origin, size, usable});
    includeVoxels(origin, origin + size - 1);
    return {};
}

SparseVoxels::View SparseVoxels::viewBlock(ivec3 block) const {
    if (const auto found = blocks_.find({block.x, block.y, block.z}); found != blocks_.end())
        return {values_.data() + size_t(found->second) * kBlockVoxels, 0};
    for (const auto& [size, tiles] : tilesBySize_) {
        const ivec3 key = floorDivide(block, size / kBlockSize);
        if (const auto found = tiles.find({key.x, key.y, key.z}); found != tiles.end())
            return {nullptr, found->second};
    }
    return {nullptr, 0};
}

void SparseVoxels::gather(ivec3 firstSample, float* samples) const {
    // Nine samples from anywhere span two blocks, or with luck one and the first sample of the next.
    const ivec3 firstBlock = floorDivide(firstSample, kBlockSize);
    View views[2][2][2];
    for (int z = 0; z < 2; ++z)
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 2; ++x) views[z][y][x] = viewBlock(firstBlock + ivec3(x, y, z));

    const ivec3 offset = firstSample - firstBlock * kBlockSize;
    for (int z = 0; z < kBrickSamples; ++z)
        for (int y = 0; y < kBrickSamples; ++y)
            for (int x = 0; x < kBrickSamples; ++x) {
                const ivec3 p = offset + ivec3(x, y, z);
                const View& view = views[p.z >> 3][p.y >> 3][p.x >> 3];
                *samples++ = view.values ? view.values[(p.z & 7) * 64 + (p.y & 7) * 8 + (p.x & 7)]
                                         : view.constant;
            }
}

void SparseVoxels::markBricks(const BrickGrid& grid, ivec3 lowest, ivec3 highest,
                              std::vector<uint8_t>& touched) const {
    // Brick b holds the samples origin + 8b + [0,8]: a voxel on a shared face belongs to both.
    const ivec3 low = glm::max(floorDivide(lowest - grid.origin - 1, kBrickCells), ivec3(0));
    const ivec3 high =
        glm::min(floorDivide(highest - grid.origin, kBrickCells), grid.brickCount - 1);
    for (int z = low.z; z <= high.z; ++z)
        for (int y = low.y; y <= high.y; ++y)
            for (int x = low.x; x <= high.x; ++x)
                touched[(size_t(z) * size_t(grid.brickCount.y) + size_t(y)) *
                            size_t(grid.brickCount.x) +
                        size_t(x)] = 1;
}

void SparseVoxels::placeTiles(BrickGrid& grid, std::vector<uint8_t>& touched) const {
    for (const Tile& tile : tiles_) {
        const ivec3 last = tile.origin + tile.size - 1;
        markBricks(grid, tile.origin, last, touched);
        // Bricks whose nine samples an axis all lie in the tile are constant; nothing is gathered for them.
        const ivec3 low = glm::max(
            floorDivide(tile.origin - grid.origin + kBrickCells - 1, kBrickCells), ivec3(0));
        const ivec3 high = glm::min(floorDivide(last - grid.origin - kBrickCells, kBrickCells),
                                    grid.brickCount - 1);
        for (int z = low.z; z <= high.z; ++z)
            for (int y = low.y; y <= high.y; ++y)
                for (int x = low.x; x <= high.x; ++x) {
                    const size_t i = (size_t(z) * size_t(grid.brickCount.y) + size_t(y)) *
                                         size_t(grid.brickCount.x) +
                                     size_t(x);
                    grid.bricks[i] = {tile.value, tile.value, Brick::kNoSlot};
                    touched[i] = 0;
                }
    }
}

namespace {

double meanOfPositive(const BrickGrid& grid) {
    double sum = 0, count = 0;
    for (const float sample : grid.samples)
        if (sample > 0) {
            sum += double(sample);
            ++count;
        }
    for (const Brick& brick : grid.bricks)
        if (brick.slot == Brick::kNoSlot && brick.maximum > 0) {
            sum += double(brick.maximum) * double(kBrickSampleCount);
            count += double(kBrickSampleCount);
        }
    return count > 0 ? sum / count : 0;
}

} // namespace

Result<BrickGrid> SparseVoxels::build(const dmat4& worldFromIndex) const {
    BrickGrid grid;
    grid.worldFromIndex = worldFromIndex;
    if (origins_.empty() && tiles_.empty()) return grid;

    grid.origin = lowest_ - 1; // the field rises from 0 within the cell below the first voxel
    grid.brickCount = (highest_ - grid.origin) / kBrickCells + 1;
    const uint64_t count = uint64_t(grid.brickCount.x) * uint64_t(grid.brickCount.y); // < 2^54
    if (count > limits_.brickCount || count * uint64_t(grid.brickCount.z) > limits_.brickCount) {
        const ivec3 size = highest_ - lowest_ + 1;
        return Error{fmt::format(
            "its voxels lie in a box of {}×{}×{}, which takes more than the {} bricks of 8³ allowed",
            size.x, size.y, size.z, limits_.brickCount)};
    }
    grid.bricks.resize(size_t(count) * size_t(grid.brickCount.z));
    std::vector<uint8_t> touched(grid.bricks.size(), 0);
    placeTiles(grid, touched);
    for (const ivec3& origin : origins_) markBricks(grid, origin, origin + kBlockSize - 1, touched);

    float samples[kBrickSampleCount];
    size_t i = 0;
    for (int z = 0; z < grid.brickCount.z; ++z)
        for (int y = 0; y < grid.brickCount.y; ++y)
            for (int x = 0; x < grid.brickCount.x; ++x, ++i) {
                if (!touched[i]) continue;
                gather(grid.origin + kBrickCells * ivec3(x, y, z), samples);
                Brick& brick = grid.bricks[i];
                const auto [minimum, maximum] =
                    std::minmax_element(std::begin(samples), std::end(samples));
                brick.minimum = *minimum;
                brick.maximum = *maximum;
                if (brick.minimum == brick.maximum) continue;
                if ((grid.samples.size() + kBrickSampleCount) * sizeof(float) > limits_.sampleBytes)
                    return Error{fmt::format("its bricks take more than the {} MiB allowed",
                                             limits_.sampleBytes >> 20)};
                brick.slot = grid.slotCount();
                grid.samples.insert(grid.samples.end(), std::begin(samples), std::end(samples));
            }
    grid.samples.shrink_to_fit();
    grid.minimum = grid.bricks.front().minimum;
    for (const Brick& brick : grid.bricks) {
        grid.minimum = std::min(grid.minimum, brick.minimum);
        grid.maximum = std::max(grid.maximum, brick.maximum);
    }
    grid.meanOfPositive = meanOfPositive(grid);
    return grid;
}

} // namespace tyndall
