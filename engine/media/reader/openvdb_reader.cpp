// Grids of OpenVDB files. Only this file and openvdb_archive include OpenVDB.

#include "media/reader/openvdb_archive.h"
#include "media/reader/voxel_sink.h"

#include <cmath>
#include <cstring>
#include <limits>

#include <tbb/global_control.h>

namespace tyndall::reader {

namespace {

float toFloat(float value) { return value; }
float toFloat(double value) {
    constexpr double kLargest = double(std::numeric_limits<float>::max());
    if (std::isfinite(value) && std::abs(value) > kLargest)
        return value > 0 ? std::numeric_limits<float>::max() : -std::numeric_limits<float>::max();
    return float(value);
}

std::array<int32_t, 3> asArray(const openvdb::Coord& c) { return {c.x(), c.y(), c.z()}; }

std::string className(const openvdb::GridBase& grid, const std::string& type) {
    if (type == "ptdataidx32" || type == "ptidx32") return "points";
    switch (grid.getGridClass()) {
    case openvdb::GRID_LEVEL_SET: return "level set";
    case openvdb::GRID_FOG_VOLUME: return "fog volume";
    case openvdb::GRID_STAGGERED: return "staggered";
    default: return "unknown";
    }
}

GridDescription describe(const openvdb::GridBase& grid, const std::string& name) {
    GridDescription result;
    result.name = name;
    const std::string type = grid.valueType();
    const bool scalar = grid.isType<openvdb::FloatGrid>() || grid.isType<openvdb::DoubleGrid>();
    result.type = scalar && grid.saveFloatAsHalf() ? type + " (stored as half)" : type;
    result.gridClass = className(grid, type);
    result.record.importable =
        scalar && (result.gridClass == "fog volume" || result.gridClass == "unknown");

    result.record.affine = grid.constTransform().isLinear();
    if (result.record.affine) {
        // OpenVDB multiplies row vectors; its rows are therefore the columns that are sent.
        const openvdb::Mat4d matrix = grid.constTransform().baseMap()->getAffineMap()->getMat4();
        std::memcpy(result.record.worldFromIndex, matrix.asPointer(),
                    sizeof result.record.worldFromIndex);
    }
    return result;
}

void addExtent(GridDescription& grid, const openvdb::CoordBBox& box, uint64_t voxels) {
    grid.record.activeVoxels = voxels;
    if (voxels == 0 || box.empty()) return;
    for (int axis = 0; axis < 3; ++axis) {
        grid.record.first[axis] = box.min()[axis];
        grid.record.last[axis] = box.max()[axis];
    }
}

template <typename Grid> void readScalars(const Grid& grid, VoxelSink& sink) {
    using Tree = typename Grid::TreeType;
    const Tree& tree = grid.tree();
    const auto background = tree.background();
    // The field is 0 where nothing is stored, so a voxel that is merely the background is 0 whatever that may be.
    float values[512];
    for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) {
        for (openvdb::Index i = 0; i < 512; ++i) {
            const auto value = leaf->getValue(i);
            values[i] = !leaf->isValueOn(i) && value == background ? 0.0f : toFloat(value);
        }
        sink.block(asArray(leaf->origin()), values);
    }
    auto tile = tree.cbeginValueAll();
    tile.setMaxDepth(Tree::ValueAllCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        const auto value = tile.getValue();
        if (value == 0 || (!tile.isValueOn() && value == background)) continue;
        openvdb::CoordBBox box;
        tile.getBoundingBox(box);
        sink.tile(asArray(box.min()), box.dim().x(), toFloat(value));
    }
}

class OpenVdbSource final : public GridSource {
public:
    explicit OpenVdbSource(const std::string& path) : file_(path) {}

    std::string format() const override { return "OpenVDB " + std::to_string(file_.fileVersion()); }

    std::vector<GridDescription> list() override {
        std::vector<GridDescription> grids;
        for (size_t i = 0; i < file_.size(); ++i) grids.push_back(describeFromHeader(i));
        return grids;
    }

    GridDescription measure(uint32_t grid) override {
        const openvdb::GridBase::Ptr whole = file_.readGrid(grid);
        GridDescription result = describe(*whole, file_.name(grid));
        addExtent(result, whole->evalActiveVoxelBoundingBox(), whole->activeVoxelCount());
        return result;
    }

    void read(uint32_t grid, VoxelSink& sink) override {
        const openvdb::GridBase::Ptr whole = file_.readGrid(grid);
        if (const auto floats = openvdb::gridConstPtrCast<openvdb::FloatGrid>(whole))
            return readScalars(*floats, sink);
        if (const auto doubles = openvdb::gridConstPtrCast<openvdb::DoubleGrid>(whole))
            return readScalars(*doubles, sink);
        throw std::runtime_error("grid '" + file_.name(grid) + "' holds no scalars");
    }

private:
    GridDescription describeFromHeader(size_t grid) {
        const std::string name = file_.name(grid);
        try {
            const openvdb::GridBase::Ptr header = file_.readHeader(grid);
            GridDescription result = describe(*header, name);
            const auto lowest =
                header->getMetadata<openvdb::Vec3IMetadata>(openvdb::GridBase::META_FILE_BBOX_MIN);
            const auto highest =
                header->getMetadata<openvdb::Vec3IMetadata>(openvdb::GridBase::META_FILE_BBOX_MAX);
            const auto count = header->getMetadata<openvdb::Int64Metadata>(
                openvdb::GridBase::META_FILE_VOXEL_COUNT);
            if (lowest && highest && count && count->value() > 0)
                addExtent(result,
                          {openvdb::Coord(lowest->value()), openvdb::Coord(highest->value())},
                          uint64_t(count->value()));
            return result;
        } catch (const std::runtime_error&) { // of what this version of the library does not know
            GridDescription unknown;
            unknown.name = name;
            unknown.type = "unreadable";
            unknown.gridClass = "unknown";
            return unknown;
        }
    }

    tbb::global_control oneThread_{tbb::global_control::max_allowed_parallelism,
                                   1}; // memory limits count stacks
    OpenVdbArchive file_;
};

} // namespace

std::unique_ptr<GridSource> openOpenVdb(const std::string& path) {
    return std::make_unique<OpenVdbSource>(path);
}

} // namespace tyndall::reader
