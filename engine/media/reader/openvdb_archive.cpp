#include "media/reader/openvdb_archive.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "media/reader/grid_stream.h"

namespace tyndall::reader {

namespace vdb = openvdb;
using vdb::io::GridDescriptor;

namespace {

std::string nameOf(const GridDescriptor& grid) {
    return GridDescriptor::nameAsString(grid.uniqueName());
}

/// A reason for people.
struct Reason : std::runtime_error {
    using std::runtime_error::runtime_error;
};
[[noreturn]] void fail(const std::string& reason) { throw Reason(reason); }

} // namespace

/// Calls functions of the library; what they throw becomes a reason for people. Lack of memory stays what it is.
template <typename Function>
auto OpenVdbArchive::explained(const std::string& where, Function function) {
    try {
        return function();
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const Reason&) {
        throw;
    } catch (const std::ios_base::failure&) {
        fail("it is cut off: it ends after " + std::to_string(bytes_) + " bytes, inside " + where);
    } catch (const std::exception& failure) {
        // The library begins its messages with the name of the exception's class.
        std::string reason = failure.what();
        if (const size_t colon = reason.find(": "); colon < 20) reason.erase(0, colon + 2);
        fail("it is damaged (OpenVDB says: " + reason + ")");
    }
}

OpenVdbArchive::OpenVdbArchive(const std::string& path) : stream_(path, std::ios::binary) {
    if (!stream_) fail("it cannot be opened");
    vdb::initialize();
    bytes_ = int64_t(std::filesystem::file_size(path));
    stream_.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
    explained("its header", [&] {
        Archive::readHeader(stream_);
        streamMetadata_ = std::make_shared<vdb::io::StreamMetadata>();
        streamMetadata_->setSeekable(true);
        vdb::io::setStreamMetadataPtr(stream_, streamMetadata_, /*transfer=*/false);
        setFormatVersion(stream_);
        setLibraryVersion(stream_);
        setDataCompression(stream_);
        vdb::MetaMap().readMeta(stream_);
    });
    if (inputHasGridOffsets())
        readDescriptors();
    else
        readAll();
    std::stable_sort(grids_.begin(), grids_.end(),
                     [](const GridDescriptor& a, const GridDescriptor& b) {
                         return a.gridName() < b.gridName();
                     });
}

void OpenVdbArchive::readDescriptors() {
    const int32_t count = explained("its header", [&] { return readGridCount(stream_); });
    if (count < 0 || uint32_t(count) > stream::kMaximumGrids)
        fail("it claims to hold " + std::to_string(count) + " grids");
    for (int32_t i = 0; i < count; ++i) {
        const std::string ordinal =
            "the description of grid " + std::to_string(i + 1) + " of " + std::to_string(count);
        explained(ordinal, [&] {
            grids_.emplace_back().read(stream_);
            checkPlaces(grids_.back());
            grids_.back().seekToEnd(stream_);
        });
    }
}

/// Every grid of a file says where it ends, so that a cut is seen before any voxel is read.
void OpenVdbArchive::checkPlaces(const GridDescriptor& grid) const {
    for (const int64_t place : {grid.getGridPos(), grid.getBlockPos(), grid.getEndPos()})
        if (place < 0) fail("it is damaged (grid '" + nameOf(grid) + "' begins before the file)");
    if (grid.getEndPos() > bytes_)
        fail("it is cut off: it ends after " + std::to_string(bytes_) + " bytes, and its grid '" +
             nameOf(grid) + "' goes on to byte " + std::to_string(grid.getEndPos()));
}

/// A file without offsets can only be read from its beginning to its end.
void OpenVdbArchive::readAll() {
    const int32_t count = explained("its header", [&] { return readGridCount(stream_); });
    if (count < 0 || uint32_t(count) > stream::kMaximumGrids)
        fail("it claims to hold " + std::to_string(count) + " grids");
    for (int32_t i = 0; i < count; ++i) {
        GridDescriptor& grid = grids_.emplace_back();
        const std::string ordinal =
            "grid " + std::to_string(i + 1) + " of " + std::to_string(count);
        explained(ordinal, [&] {
            grid.read(stream_);
            const vdb::GridBase::Ptr read = create(grid);
            Archive::readGrid(read, grid, stream_);
            streamed_[grid.uniqueName()] = read;
        });
    }
    explained("its header", [&] {
        for (const GridDescriptor& grid : grids_) connectInstance(grid, streamed_);
    });
}

std::string OpenVdbArchive::name(size_t grid) const { return nameOf(grids_.at(grid)); }

vdb::GridBase::Ptr OpenVdbArchive::create(const GridDescriptor& descriptor) const {
    vdb::GridBase::Ptr grid = vdb::GridBase::createGrid(descriptor.gridType());
    grid->setSaveFloatAsHalf(descriptor.saveFloatAsHalf());
    return grid;
}

vdb::GridBase::Ptr OpenVdbArchive::readHeader(size_t grid) {
    const GridDescriptor& descriptor = grids_.at(grid);
    if (!inputHasGridOffsets()) return streamed_.at(descriptor.uniqueName())->copyGridWithNewTree();
    return explained("grid '" + nameOf(descriptor) + "'", [&] {
        const vdb::GridBase::Ptr header = create(descriptor);
        descriptor.seekToGrid(stream_);
        readGridCompression(stream_);
        header->readMeta(stream_);
        // Older versions of the library stored the transform behind the topology.
        if (vdb::io::getFormatVersion(stream_) < vdb::OPENVDB_FILE_VERSION_GRID_INSTANCING)
            header->readTopology(stream_);
        header->readTransform(stream_);
        return header->copyGridWithNewTree();
    });
}

vdb::GridBase::Ptr OpenVdbArchive::readOne(const GridDescriptor& descriptor) {
    vdb::GridBase::Ptr grid = create(descriptor);
    descriptor.seekToGrid(stream_);
    Archive::readGrid(grid, descriptor, stream_);
    return grid;
}

vdb::GridBase::Ptr OpenVdbArchive::readGrid(size_t grid) {
    const GridDescriptor& descriptor = grids_.at(grid);
    if (!inputHasGridOffsets()) return streamed_.at(descriptor.uniqueName());
    return explained("grid '" + nameOf(descriptor) + "'", [&] {
        const vdb::GridBase::Ptr result = readOne(descriptor);
        if (!descriptor.isInstance()) return result;
        // Grids of one tree: the tree is stored once, with the parent.
        const auto parent = std::find_if(grids_.begin(), grids_.end(), [&](const auto& other) {
            return other.uniqueName() == descriptor.instanceParentName();
        });
        if (parent == grids_.end()) fail("it is damaged (a grid's tree is missing)");
        result->setTree(readOne(*parent)->baseTreePtr());
        return result;
    });
}

} // namespace tyndall::reader
