// Grids of NanoVDB files, versions 32.x: they share one layout, but not the numbers that they begin with, nor the checksum.
// Only this file and the nanovdb_ ones beside it include NanoVDB.

#include "media/reader/nanovdb_checksum.h"
#include "media/reader/nanovdb_tree.h"
#include "media/reader/voxel_sink.h"

#include <cstring>
#include <fstream>

#include <nanovdb/NanoVDB.h>
#include <nanovdb/util/IO.h>

#include <blosc.h>
#include <zlib.h>

namespace tyndall::reader {

namespace {

struct Entry {
    nanovdb::io::MetaData meta;
    nanovdb::io::Codec codec;
    uint64_t offset; // of the grid in the file
    std::string name;
};

/// "NanoVDB1": a grid of version 32.6 and later. "NanoVDB2": a file of 32.7 and later. "NanoVDB0" was both.
constexpr uint64_t kMagic = NANOVDB_MAGIC_NUMBER, kGridMagic = kMagic + (uint64_t(1) << 56),
                   kFileMagic = kMagic + (uint64_t(2) << 56);

std::string versionText(const nanovdb::Version& version) {
    return std::to_string(version.getMajor()) + "." + std::to_string(version.getMinor()) + "." +
           std::to_string(version.getPatch());
}

class NanoVdbSource final : public GridSource {
public:
    explicit NanoVdbSource(const std::string& path) : file_(path, std::ios::binary) {
        file_.seekg(0, std::ios::end);
        fileBytes_ = uint64_t(file_.tellg());
        readDirectory();
    }

    std::string format() const override { return "NanoVDB " + versionText(version_); }

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
        // First, because the checksum's own walk trusts the offsets.
        TreeReader<Build>(memory_, nullptr).read();
        if (!checksumMatches<Build>(memory_))
            fail(
                "it is damaged (its checksum does not match its content): convert the volume again");
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

    [[noreturn]] void failCutOff() const {
        fail("it is cut off: it ends after " + std::to_string(fileBytes_) + " bytes");
    }

    void readBytes(void* out, uint64_t bytes) {
        file_.read(static_cast<char*>(out), std::streamsize(bytes));
        if (!file_ || uint64_t(file_.gcount()) != bytes) failCutOff();
    }

    /// A grid's bytes begin like the file's header in all versions before 32.7: with the same magic number. What follows tells
    /// them apart: version, count and codec here; a checksum there, and the version behind it.
    void refuseBareGrid(const nanovdb::io::Header& header) {
        const bool isHeader = header.version.getMajor() == NANOVDB_MAJOR_VERSION_NUMBER &&
                              header.codec < nanovdb::io::Codec::END;
        if (header.magic != kGridMagic && (header.magic != kMagic || isHeader)) return;
        struct {
            nanovdb::Version version;
            uint32_t flags, index, count;
            uint64_t bytes;
        } grid;
        static_assert(offsetof(nanovdb::GridData, mVersion) == sizeof header &&
                      offsetof(nanovdb::GridData, mGridSize) == sizeof header + 16);
        readBytes(&grid, sizeof grid);
        const bool isGrid = grid.version.getMajor() == NANOVDB_MAJOR_VERSION_NUMBER &&
                            grid.index < grid.count && grid.bytes >= sizeof(nanovdb::GridData);
        if (header.magic == kGridMagic || isGrid)
            fail("it is a bare grid: the bytes of a NanoVDB " + versionText(grid.version) +
                 " grid without the header of a file; write it with nanovdb::io::writeGrid");
    }

    void checkHeader(const nanovdb::io::Header& header, uint64_t position) {
        constexpr const char* kRemedy =
            " is understood: convert the volume again with such a version, or use its .vdb file";
        const std::string major = std::to_string(NANOVDB_MAJOR_VERSION_NUMBER);
        if (position == 0) refuseBareGrid(header);
        if (header.magic != kMagic && header.magic != kFileMagic)
            fail(position > 0 ? "it is damaged (a segment of it does not begin as it should)"
                              : "it was written by an unknown version of NanoVDB; version " +
                                    major + kRemedy);
        if (header.version.getMajor() != NANOVDB_MAJOR_VERSION_NUMBER)
            fail("it was written by NanoVDB " + versionText(header.version) + "; version " + major +
                 kRemedy);
    }

    /// The heads of all segments, and where their grids lie.
    void readDirectory() {
        uint64_t position = 0;
        while (position < fileBytes_) {
            file_.seekg(std::streamoff(position));
            nanovdb::io::Header header;
            readBytes(&header, sizeof header);
            checkHeader(header, position);
            version_ = header.version;
            const size_t firstOfSegment = entries_.size();
            for (uint16_t i = 0; i < header.gridCount; ++i) readEntry(header.codec);
            position = uint64_t(file_.tellg());
            for (size_t i = firstOfSegment; i < entries_.size(); ++i) {
                entries_[i].offset = position;
                if (entries_[i].meta.fileSize > fileBytes_ - position) failCutOff();
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
        if ((data.mMagic != kMagic && data.mMagic != kGridMagic) ||
            data.mGridSize != memory_.size())
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
