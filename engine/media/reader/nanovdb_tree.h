#pragma once
// NanoVDB's trees are blocks of memory with offsets in them; every offset is checked against the block here, because NanoVDB
// itself follows them blindly.

#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>

#include <nanovdb/NanoVDB.h>

#include "media/reader/voxel_sink.h"

namespace tyndall::reader {

/// Throws with a reason for people.
[[noreturn]] inline void fail(const std::string& reason) { throw std::runtime_error(reason); }

/// A grid in memory, aligned as NanoVDB wants it.
class GridMemory {
public:
    explicit GridMemory(uint64_t bytes = 0) : bytes_(bytes) {
        if (bytes == 0) return;
        if (bytes > std::numeric_limits<uint64_t>::max() - 64) throw std::bad_alloc();
        data_.reset(
            static_cast<char*>(std::aligned_alloc(32, size_t((bytes + 31) & ~uint64_t(31)))));
        if (!data_) throw std::bad_alloc();
    }
    [[nodiscard]] char* data() const { return data_.get(); }
    [[nodiscard]] uint64_t size() const { return bytes_; }

    /// The T at `pointer`, if it and `further` bytes behind it lie within.
    template <typename T> const T& at(const void* pointer, uint64_t further = 0) const {
        const uint64_t offset = uint64_t(reinterpret_cast<uintptr_t>(pointer) -
                                         reinterpret_cast<uintptr_t>(data_.get()));
        if (offset % alignof(T) != 0 || offset > bytes_ || bytes_ - offset < sizeof(T) ||
            bytes_ - offset - sizeof(T) < further)
            fail("it is damaged (its tree points outside itself)");
        return *static_cast<const T*>(pointer);
    }

private:
    struct Free {
        void operator()(char* pointer) const { std::free(pointer); }
    };
    std::unique_ptr<char, Free> data_;
    uint64_t bytes_;
};

inline const void* moved(const void* pointer, int64_t bytes) {
    return reinterpret_cast<const void*>(reinterpret_cast<uintptr_t>(pointer) + uintptr_t(bytes));
}

/// Walks one tree, checks its offsets and, given a sink, sends its blocks and tiles. Places are those the parents say,
/// whatever a child claims.
template <typename Build> class TreeReader {
public:
    TreeReader(const GridMemory& memory, VoxelSink* sink) : memory_(memory), sink_(sink) {}

    void read() {
        using Tree = nanovdb::TreeData<3>;
        const Tree& tree = memory_.at<Tree>(memory_.data() + sizeof(nanovdb::GridData));
        const auto& root = memory_.at<RootData>(moved(&tree, int64_t(tree.mNodeOffset[3])));
        memory_.at<RootData>(&root, uint64_t(root.mTableSize) * sizeof(typename RootData::Tile));
        background_ = asFloat(root.mBackground);
        for (uint32_t i = 0; i < root.mTableSize; ++i) {
            const auto& tile = *root.tile(i);
            const nanovdb::Coord origin = tile.origin();
            if (tile.child == 0)
                sendTile({origin[0], origin[1], origin[2]}, kUpperSize, asFloat(tile.value),
                         tile.state != 0);
            else
                readInternal<Upper>(moved(&root, tile.child), {origin[0], origin[1], origin[2]});
        }
    }

private:
    using Root = typename nanovdb::NanoTree<Build>::RootType;
    using RootData = typename Root::DataType;
    using Upper = typename Root::ChildNodeType;
    using Lower = typename Upper::ChildNodeType;
    using Leaf = typename Lower::ChildNodeType;
    static constexpr int32_t kUpperSize = 4096;
    using Place = std::array<int32_t, 3>;

    static float asFloat(float value) { return value; }
    static float asFloat(double value) {
        constexpr double kLargest = double(std::numeric_limits<float>::max());
        if (std::isfinite(value) && std::abs(value) > kLargest)
            return value > 0 ? std::numeric_limits<float>::max() : -1.0f;
        return float(value);
    }

    void sendTile(const Place& origin, int32_t size, float value, bool active) {
        if (!sink_ || value == 0 || (!active && value == background_)) return;
        sink_->tile(origin, size, value);
    }

    template <typename Node> void readInternal(const void* pointer, const Place& origin) {
        const auto& node = memory_.at<typename Node::DataType>(pointer);
        constexpr uint32_t kLog = Node::LOG2DIM;
        constexpr int32_t kChildSize = int32_t(Node::ChildNodeType::DIM);
        for (uint32_t n = 0; n < (1u << (3 * kLog)); ++n) {
            // Unsigned sums: a hostile origin may wrap, and the importer then refuses the place.
            const auto along = [&](uint32_t start, uint32_t cell) {
                return int32_t(start + cell * uint32_t(kChildSize));
            };
            constexpr uint32_t kMask = (1u << kLog) - 1;
            const Place place = {along(uint32_t(origin[0]), n >> (2 * kLog)),
                                 along(uint32_t(origin[1]), (n >> kLog) & kMask),
                                 along(uint32_t(origin[2]), n & kMask)};
            if (!node.mChildMask.isOn(n))
                sendTile(place, kChildSize, asFloat(node.mTable[n].value), node.mValueMask.isOn(n));
            else if constexpr (std::is_same_v<Node, Upper>)
                readInternal<Lower>(moved(&node, node.mTable[n].child), place);
            else
                readLeaf(moved(&node, node.mTable[n].child), place);
        }
    }

    void readLeaf(const void* pointer, const Place& origin) {
        using Data = typename Leaf::DataType;
        const Data* leaf;
        if constexpr (std::is_same_v<Build, nanovdb::FpN>) {
            leaf = &memory_.at<Data>(pointer);
            if ((leaf->mFlags >> 5) > 4)
                fail("it is damaged (a leaf has an unknown number of bits)");
            memory_.at<Data>(pointer, uint64_t(leaf->bitWidth()) * 64);
        } else {
            leaf = &memory_.at<Data>(pointer);
        }
        if (!sink_) return;
        float values[512];
        for (uint32_t i = 0; i < 512; ++i) {
            values[i] = asFloat(leaf->getValue(i));
            if (background_ != 0 && values[i] == background_ && !leaf->mValueMask.isOn(i))
                values[i] = 0;
        }
        sink_->block(origin, values);
    }

    const GridMemory& memory_;
    VoxelSink* sink_; // null: only check
    float background_ = 0;
};

} // namespace tyndall::reader
