// The only source file that includes NanoVDB. Its trees are blocks of memory with offsets in them; every offset is
// checked against the block here, because NanoVDB itself follows them blindly.

#include "media/reader/voxel_sink.h"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <stdexcept>

#include <nanovdb/NanoVDB.h>
#include <nanovdb/util/GridChecksum.h>
#include <nanovdb/util/IO.h>

#include <blosc.h>
#include <zlib.h>

namespace tyndall::reader {

namespace {

[[noreturn]] void fail(const std::string& reason) { throw std::runtime_error(reason); }

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

const void* moved(const void* pointer, int64_t bytes) {
    return reinterpret_cast<const void*>(reinterpret_cast<uintptr_t>(pointer) + uintptr_t(bytes));
}

struct Entry {
    nanovdb::io::MetaData meta;
    nanovdb::io::Codec codec;
    uint64_t offset; // of the grid in the file
    std::string name;
};

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

class NanoVdbSource final : public GridSource {
public:
    explicit NanoVdbSource(const std::string& path) : file_(path, std::ios::binary) {
        file_.seekg(0, std::ios::end);
        fileBytes_ = uint64_t(file_.tellg());
        readDirectory();
    }

    std::string format() const override {
        return "NanoVDB " + std::to_string(version_.getMajor()) + "." +
               std::to_string(version_.getMinor()) + "." + std::to_string(version_.getPatch());
    }

    std::vector<GridDescription> list() override {
        std::vector<GridDescription> grids;
        for (uint32_t i = 0; i < entries_.size(); ++i) grids.push_back(measure(i));
        return grids;
    }

    GridDescription measure(uint32_t grid) override {
        const nanovdb::GridData& data = load(grid);
        GridDescription result;
        result.name = entries_[grid].name;
        result.type =
            data.mGridType < nanovdb::GridType::End ? typeName(data.mGridType) : "unreadable";
        result.gridClass = className(data.mGridClass);
        result.record.importable =
            (result.gridClass == "fog volume" || result.gridClass == "unknown") &&
            isScalar(data.mGridType);
        result.record.activeVoxels = entries_[grid].meta.voxelCount;
        if (result.record.activeVoxels > 0)
            for (int axis = 0; axis < 3; ++axis) {
                result.record.first[axis] = entries_[grid].meta.indexBBox.min()[axis];
                result.record.last[axis] = entries_[grid].meta.indexBBox.max()[axis];
            }
        for (int column = 0; column < 3; ++column)
            for (int row = 0; row < 3; ++row)
                result.record.worldFromIndex[column * 4 + row] = data.mMap.mMatD[row * 3 + column];
        for (int row = 0; row < 3; ++row)
            result.record.worldFromIndex[12 + row] = data.mMap.mVecD[row];
        return result;
    }

    void read(uint32_t grid, VoxelSink& sink) override {
        switch (load(grid).mGridType) {
        case nanovdb::GridType::Float: return readTree<float>(sink);
        case nanovdb::GridType::Double: return readTree<double>(sink);
        case nanovdb::GridType::Fp4: return readTree<nanovdb::Fp4>(sink);
        case nanovdb::GridType::Fp8: return readTree<nanovdb::Fp8>(sink);
        case nanovdb::GridType::Fp16: return readTree<nanovdb::Fp16>(sink);
        case nanovdb::GridType::FpN: return readTree<nanovdb::FpN>(sink);
        default: fail("grid '" + entries_[grid].name + "' holds no scalars");
        }
    }

private:
    template <typename Build> void readTree(VoxelSink& sink) {
        const auto& grid = memory_.at<nanovdb::NanoGrid<Build>>(memory_.data());
        TreeReader<Build>(memory_, nullptr)
            .read(); // first, because the checksum's own walk trusts the offsets
        // "Full" compares as much as the file has: some record a checksum of the head alone, or none.
        if (!nanovdb::validateChecksum(grid, nanovdb::ChecksumMode::Full))
            fail("it is damaged (its checksum does not match its content)");
        TreeReader<Build>(memory_, &sink).read();
    }

    static bool isScalar(nanovdb::GridType type) {
        using nanovdb::GridType;
        return type == GridType::Float || type == GridType::Double || type == GridType::Fp4 ||
               type == GridType::Fp8 || type == GridType::Fp16 || type == GridType::FpN;
    }

    static std::string typeName(nanovdb::GridType type) {
        switch (type) {
        case nanovdb::GridType::Fp4: return "Fp4";
        case nanovdb::GridType::Fp8: return "Fp8";
        case nanovdb::GridType::Fp16: return "Fp16";
        case nanovdb::GridType::FpN: return "FpN";
        case nanovdb::GridType::Vec3f: return "vec3s";
        case nanovdb::GridType::Vec3d: return "vec3d";
        default: return nanovdb::toStr(type);
        }
    }

    static std::string className(nanovdb::GridClass gridClass) {
        switch (gridClass) {
        case nanovdb::GridClass::Unknown: return "unknown";
        case nanovdb::GridClass::LevelSet: return "level set";
        case nanovdb::GridClass::FogVolume: return "fog volume";
        case nanovdb::GridClass::Staggered: return "staggered";
        case nanovdb::GridClass::PointIndex:
        case nanovdb::GridClass::PointData: return "points";
        case nanovdb::GridClass::Topology: return "topology";
        case nanovdb::GridClass::VoxelVolume: return "voxel volume";
        case nanovdb::GridClass::IndexGrid: return "index grid";
        default: return "unknown class";
        }
    }

    void readBytes(void* out, uint64_t bytes) {
        file_.read(static_cast<char*>(out), std::streamsize(bytes));
        if (!file_ || uint64_t(file_.gcount()) != bytes) fail("it is damaged (it ends too early)");
    }

    /// The heads of all segments, and where their grids lie.
    void readDirectory() {
        uint64_t position = 0;
        while (position < fileBytes_) {
            file_.seekg(std::streamoff(position));
            nanovdb::io::Header header;
            readBytes(&header, sizeof header);
            if (header.magic != NANOVDB_MAGIC_NUMBER)
                fail(
                    position > 0
                        ? "it is damaged (a segment of it does not begin as it should)"
                        : "it was written by a version of NanoVDB that is not understood; 32.3 to 32.5 are");
            if (header.version.getMajor() != NANOVDB_MAJOR_VERSION_NUMBER)
                fail("it was written by NanoVDB " + std::to_string(header.version.getMajor()) +
                     "; version " + std::to_string(NANOVDB_MAJOR_VERSION_NUMBER) +
                     " is understood");
            version_ = header.version;
            const size_t firstOfSegment = entries_.size();
            for (uint16_t i = 0; i < header.gridCount; ++i) readEntry(header.codec);
            position = uint64_t(file_.tellg());
            for (size_t i = firstOfSegment; i < entries_.size(); ++i) {
                entries_[i].offset = position;
                if (entries_[i].meta.fileSize > fileBytes_ - position)
                    fail("it is damaged (it ends too early)");
                position += entries_[i].meta.fileSize;
            }
        }
    }

    void readEntry(nanovdb::io::Codec codec) {
        if (entries_.size() >= stream::kMaximumGrids)
            fail("it is damaged (it claims to hold too many grids)");
        Entry entry{};
        readBytes(&entry.meta, sizeof entry.meta);
        entry.codec = codec;
        if (entry.meta.nameSize > stream::kMaximumTextBytes)
            fail("it is damaged (a grid's name is too long)");
        std::string name(entry.meta.nameSize, '\0');
        readBytes(name.data(), name.size());
        entry.name = name.c_str(); // up to its terminator
        entries_.push_back(std::move(entry));
    }

    const nanovdb::GridData& load(uint32_t grid) {
        if (loaded_ != int64_t(grid)) {
            loaded_ = -1;
            memory_ = GridMemory(); // before the next one is made
            memory_ = unpack(entries_.at(grid));
            loaded_ = int64_t(grid);
        }
        const auto& data = memory_.at<nanovdb::GridData>(memory_.data());
        if (data.mMagic != NANOVDB_MAGIC_NUMBER || data.mGridSize != memory_.size())
            fail("it is damaged (a grid does not begin as it should)");
        return data;
    }

    GridMemory unpack(const Entry& entry) {
        const uint64_t gridBytes = entry.meta.gridSize, packedBytes = entry.meta.fileSize;
        file_.clear();
        file_.seekg(std::streamoff(entry.offset));
        if (entry.codec == nanovdb::io::Codec::NONE) {
            if (gridBytes > packedBytes)
                fail("it is damaged (a grid is larger than its part of the file)");
            GridMemory grid(gridBytes);
            readBytes(grid.data(), gridBytes);
            return grid;
        }
        std::vector<char> packed(packedBytes);
        readBytes(packed.data(), packedBytes);
        GridMemory grid(gridBytes);
        if (entry.codec == nanovdb::io::Codec::ZIP)
            unzip(packed, grid);
        else if (entry.codec == nanovdb::io::Codec::BLOSC)
            unblosc(packed, grid);
        else
            fail("it is compressed in an unknown way");
        return grid;
    }

    /// The next length-prefixed part of `packed` from `position` on.
    static std::pair<const char*, uint64_t> nextPart(const std::vector<char>& packed,
                                                     uint64_t& position) {
        uint64_t bytes = 0;
        if (packed.size() - position < sizeof bytes)
            fail("it is damaged (its compressed part ends too early)");
        std::memcpy(&bytes, packed.data() + position, sizeof bytes);
        position += sizeof bytes;
        if (bytes > packed.size() - position)
            fail("it is damaged (its compressed part ends too early)");
        const char* start = packed.data() + position;
        position += bytes;
        return {start, bytes};
    }

    static void unzip(const std::vector<char>& packed, const GridMemory& grid) {
        uint64_t position = 0;
        const auto [start, bytes] = nextPart(packed, position);
        uLongf unpacked = uLongf(grid.size());
        if (uncompress(reinterpret_cast<Bytef*>(grid.data()), &unpacked,
                       reinterpret_cast<const Bytef*>(start), uLong(bytes)) != Z_OK ||
            unpacked != grid.size())
            fail("it is damaged (its compressed part does not unpack)");
    }

    static void unblosc(const std::vector<char>& packed, const GridMemory& grid) {
        constexpr uint64_t kChunk = uint64_t(1) << 30; // NanoVDB compresses a gibibyte at a time
        uint64_t position = 0;
        for (uint64_t done = 0; done < grid.size();) {
            const uint64_t expected = std::min(kChunk, grid.size() - done);
            const auto [start, bytes] = nextPart(packed, position);
            size_t unpacked = 0;
            if (blosc_cbuffer_validate(start, bytes, &unpacked) < 0 || unpacked != expected ||
                blosc_decompress_ctx(start, grid.data() + done, expected, 1) != int(expected))
                fail("it is damaged (its compressed part does not unpack)");
            done += expected;
        }
    }

    std::ifstream file_;
    uint64_t fileBytes_ = 0;
    nanovdb::Version version_;
    std::vector<Entry> entries_;
    GridMemory memory_;
    int64_t loaded_ = -1;
};

} // namespace

std::unique_ptr<GridSource> openNanoVdb(const std::string& path) {
    return std::make_unique<NanoVdbSource>(path);
}

} // namespace tyndall::reader
