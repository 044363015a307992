#pragma once
// An OpenVDB file whose every read is checked. openvdb::io::File reads from a stream whose state it never looks at: where a
// file is cut off, what is missing stays as it was in memory, mostly 0, and a cloud gets thinner without a word. The same
// functions of the library read here from a stream that throws.

#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <openvdb/openvdb.h>

namespace tyndall::reader {

/// Derived for the functions of the library that read from any stream.
class OpenVdbArchive : private openvdb::io::Archive {
public:
    /// Reads the header and the descriptors of all grids. Throws std::exception with a reason for people: no such file, damaged,
    /// or cut off, with the byte where it ends.
    explicit OpenVdbArchive(const std::string& path);

    using Archive::fileVersion;
    /// How many grids there are, in the order of their names.
    [[nodiscard]] size_t size() const { return grids_.size(); }
    /// Its name; of several with one name "density[0]", "density[1]" …
    [[nodiscard]] std::string name(size_t grid) const;
    /// Metadata and transform, with no voxels. Throws as the constructor.
    [[nodiscard]] openvdb::GridBase::Ptr readHeader(size_t grid);
    /// The whole grid. Throws as the constructor.
    [[nodiscard]] openvdb::GridBase::Ptr readGrid(size_t grid);

private:
    void readDescriptors();
    void readAll();
    void checkPlaces(const openvdb::io::GridDescriptor& grid) const;
    [[nodiscard]] openvdb::GridBase::Ptr create(const openvdb::io::GridDescriptor& grid) const;
    [[nodiscard]] openvdb::GridBase::Ptr readOne(const openvdb::io::GridDescriptor& grid);
    template <typename Function> auto explained(const std::string& where, Function function);

    std::ifstream stream_;
    int64_t bytes_ = 0;
    openvdb::io::StreamMetadata::Ptr streamMetadata_; // the stream points to it
    std::vector<openvdb::io::GridDescriptor> grids_;
    std::map<std::string, openvdb::GridBase::Ptr>
        streamed_; // of a file without offsets, which is read at once
};

} // namespace tyndall::reader
