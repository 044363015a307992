#include "media_volume_files.h"

#include <fstream>

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>

#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>

namespace tyndall::test {
namespace fs = std::filesystem;

namespace {

openvdb::Coord coord(ivec3 p) { return {p.x, p.y, p.z}; }

openvdb::math::Transform::Ptr transformOf(const VolumeSpec& spec) {
    if (spec.frustum)
        return std::make_shared<openvdb::math::Transform>(
            openvdb::math::MapBase::Ptr(new openvdb::math::NonlinearFrustumMap(
                openvdb::BBoxd(openvdb::Vec3d(0), openvdb::Vec3d(10)), 0.5, 2.0)));
    openvdb::Mat4d matrix; // row vectors: glm's columns are its rows
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) matrix(column, row) = spec.worldFromIndex[column][row];
    return openvdb::math::Transform::createLinearTransform(matrix);
}

template <typename Grid> typename Grid::Ptr makeGrid(const VolumeSpec& spec) {
    using Value = typename Grid::ValueType;
    typename Grid::Ptr grid = Grid::create(Value(spec.background));
    grid->setName(spec.name);
    grid->setTransform(transformOf(spec));
    if (spec.gridClass != VolumeSpec::Class::Unknown)
        grid->setGridClass(spec.gridClass == VolumeSpec::Class::Fog ? openvdb::GRID_FOG_VOLUME
                                                                    : openvdb::GRID_LEVEL_SET);
    for (const VolumeSpec::Tile& tile : spec.tiles)
        grid->sparseFill(openvdb::CoordBBox(coord(tile.first), coord(tile.last)), Value(tile.value),
                         true);
    for (const auto& [index, value] : spec.voxels)
        grid->tree().setValueOn(coord(index), Value(value));
    for (const auto& [index, value] : spec.inactiveVoxels)
        grid->tree().setValueOff(coord(index), Value(value));
    return grid;
}

openvdb::GridBase::Ptr makeAnyGrid(const VolumeSpec& spec) {
    switch (spec.type) {
    case VolumeSpec::Type::Double: return makeGrid<openvdb::DoubleGrid>(spec);
    case VolumeSpec::Type::Vector: return makeGrid<openvdb::Vec3SGrid>(spec);
    case VolumeSpec::Type::Integer: return makeGrid<openvdb::Int32Grid>(spec);
    default: break;
    }
    const openvdb::FloatGrid::Ptr grid = makeGrid<openvdb::FloatGrid>(spec);
    grid->setSaveFloatAsHalf(spec.type == VolumeSpec::Type::HalfStored);
    return grid;
}

template <typename Build>
void writeAs(const fs::path& path, const openvdb::FloatGrid& grid, nanovdb::io::Codec codec) {
    // Full checksums, as the converter program makes them.
    const auto handle = nanovdb::openToNanoVDB<nanovdb::HostBuffer, openvdb::FloatTree, Build>(
        grid, nanovdb::StatsMode::All, nanovdb::ChecksumMode::Full);
    nanovdb::io::writeGrid(path.string(), handle, codec);
}

void writeFloats(const fs::path& path, const openvdb::FloatGrid& grid, NanoType type,
                 nanovdb::io::Codec codec) {
    switch (type) {
    case NanoType::Fp4: return writeAs<nanovdb::Fp4>(path, grid, codec);
    case NanoType::Fp8: return writeAs<nanovdb::Fp8>(path, grid, codec);
    case NanoType::Fp16: return writeAs<nanovdb::Fp16>(path, grid, codec);
    case NanoType::FpN: return writeAs<nanovdb::FpN>(path, grid, codec);
    default: return writeAs<float>(path, grid, codec);
    }
}

nanovdb::io::Codec codecOf(NanoCodec codec) {
    return codec == NanoCodec::Zip     ? nanovdb::io::Codec::ZIP
           : codec == NanoCodec::Blosc ? nanovdb::io::Codec::BLOSC
                                       : nanovdb::io::Codec::NONE;
}

openvdb::GridBase::Ptr readGrid(const fs::path& path, const std::string& name) {
    openvdb::initialize();
    openvdb::io::File file(path.string());
    file.open(false);
    return file.readGrid(name.empty() ? file.beginName().gridName() : name);
}

} // namespace

void writeOpenVdb(const fs::path& path, const std::vector<VolumeSpec>& specs,
                  const VdbLayout& layout) {
    openvdb::initialize();
    openvdb::GridPtrVec grids;
    for (const VolumeSpec& spec : specs) grids.push_back(makeAnyGrid(spec));
    const auto write = [&](auto& file) {
        using Codec = VdbLayout::Codec;
        if (layout.codec != Codec::Default)
            file.setCompression(openvdb::io::COMPRESS_ACTIVE_MASK |
                                (layout.codec == Codec::Zip     ? openvdb::io::COMPRESS_ZIP
                                 : layout.codec == Codec::Blosc ? openvdb::io::COMPRESS_BLOSC
                                                                : openvdb::io::COMPRESS_NONE));
        file.write(grids);
    };
    if (layout.offsets) {
        openvdb::io::File file(path.string());
        write(file);
    } else {
        std::ofstream output(path, std::ios::binary);
        openvdb::io::Stream stream(output);
        write(stream);
    }
}

void writeInstances(const fs::path& path, const VolumeSpec& spec,
                    const std::vector<std::string>& names) {
    openvdb::initialize();
    const openvdb::FloatGrid::Ptr first = makeGrid<openvdb::FloatGrid>(spec);
    openvdb::GridPtrVec grids;
    for (const std::string& name : names) {
        grids.push_back(first->copy());
        grids.back()->setName(name);
    }
    openvdb::io::File(path.string()).write(grids);
}

void writeNanoVdb(const fs::path& path, const VolumeSpec& spec, NanoType type, NanoCodec codec) {
    openvdb::initialize();
    if (type == NanoType::Double) {
        const auto handle = nanovdb::openToNanoVDB<nanovdb::HostBuffer, openvdb::DoubleTree>(
            *makeGrid<openvdb::DoubleGrid>(spec));
        return nanovdb::io::writeGrid(path.string(), handle, codecOf(codec));
    }
    writeFloats(path, *makeGrid<openvdb::FloatGrid>(spec), type, codecOf(codec));
}

void convertToNanoVdb(const fs::path& from, const fs::path& to, NanoType type, NanoCodec codec) {
    const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(readGrid(from, ""));
    writeFloats(to, *grid, type, codecOf(codec));
}

struct VolumeOracle::Impl {
    openvdb::DoubleGrid::Ptr grid;
};

VolumeOracle::VolumeOracle(const fs::path& path, const std::string& name)
    : impl_(std::make_unique<Impl>()) {
    const openvdb::GridBase::Ptr grid = readGrid(path, name);
    if (const auto floats = openvdb::gridPtrCast<openvdb::FloatGrid>(grid))
        impl_->grid = std::make_shared<openvdb::DoubleGrid>(*floats);
    else
        impl_->grid = openvdb::gridPtrCast<openvdb::DoubleGrid>(grid);
}

VolumeOracle::~VolumeOracle() = default;

double VolumeOracle::sample(const dvec3& world) const {
    const openvdb::tools::GridSampler<openvdb::DoubleGrid, openvdb::tools::BoxSampler> sampler(
        *impl_->grid);
    return sampler.wsSample({world.x, world.y, world.z});
}

double VolumeOracle::integrate(const dvec3& origin, const dvec3& direction, double length,
                               int steps) const {
    const auto accessor = impl_->grid->getConstAccessor();
    const openvdb::tools::GridSampler<openvdb::DoubleGrid::ConstAccessor,
                                      openvdb::tools::BoxSampler>
        sampler(accessor, impl_->grid->transform());
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const dvec3 p = origin + (i + 0.5) / steps * length * direction;
        sum += sampler.wsSample({p.x, p.y, p.z});
    }
    return sum * length / steps;
}

dvec3 VolumeOracle::world(const dvec3& index) const {
    const openvdb::Vec3d p = impl_->grid->indexToWorld(openvdb::Vec3d(index.x, index.y, index.z));
    return {p.x(), p.y(), p.z()};
}

std::pair<ivec3, ivec3> VolumeOracle::activeBox() const {
    const openvdb::CoordBBox box = impl_->grid->evalActiveVoxelBoundingBox();
    return {{box.min().x(), box.min().y(), box.min().z()},
            {box.max().x(), box.max().y(), box.max().z()}};
}

double VolumeOracle::voxel(ivec3 index) const { return impl_->grid->tree().getValue(coord(index)); }

uint64_t VolumeOracle::activeVoxels() const { return impl_->grid->activeVoxelCount(); }

} // namespace tyndall::test
