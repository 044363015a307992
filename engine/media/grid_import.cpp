#include "media/grid_import.h"

#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "media/grid_selection.h"
#include "media/reader_process.h"
#include "media/sparse_voxels.h"

namespace tyndall {
namespace fs = std::filesystem;

namespace {

Result<void> checkFile(const fs::path& path) {
    const std::string file = printable(path.string());
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (!fs::exists(status)) return Error{fmt::format("'{}' does not exist", file)};
    if (!fs::is_regular_file(status)) return Error{fmt::format("'{}' is not a file", file)};
    if (fs::file_size(path, error) == 0 && !error) return Error{fmt::format("'{}' is empty", file)};
    return {};
}

/// A reader whose list of grids has been received.
struct OpenFile {
    ReaderProcess reader;
    std::string file; // for sentences
    GridFileInfo info;
};

Result<GridInfo> parseGrid(const ReaderMessage& message, const std::string& file) {
    stream::GridRecord record;
    const Error nonsense{
        fmt::format("'{}' is damaged: its reader describes a grid that makes no sense", file)};
    if (message.type != stream::MessageType::Grid || message.payload.size() < sizeof record)
        return nonsense;
    std::memcpy(&record, message.payload.data(), sizeof record);
    const std::string_view text(message.payload.data() + sizeof record,
                                message.payload.size() - sizeof record);
    if (uint64_t(record.nameBytes) + record.typeBytes + record.classBytes != text.size())
        return nonsense;

    GridInfo grid;
    grid.name = printable(text.substr(0, record.nameBytes));
    grid.type = printable(text.substr(record.nameBytes, record.typeBytes));
    grid.gridClass = printable(text.substr(record.nameBytes + record.typeBytes));
    grid.activeVoxels = record.activeVoxels;
    grid.first = {record.first[0], record.first[1], record.first[2]};
    grid.last = {record.last[0], record.last[1], record.last[2]};
    grid.affine = record.affine != 0;
    grid.importable = record.importable != 0;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            grid.worldFromIndex[column][row] = record.worldFromIndex[column * 4 + row];
    return grid;
}

Result<OpenFile> openFile(const fs::path& path, const GridLimits& limits) {
    if (const Result<void> usable = checkFile(path); !usable) return usable.error();
    Result<ReaderProcess> reader = ReaderProcess::start(path, limits);
    if (!reader) return reader.error();
    OpenFile open{std::move(reader).value(), printable(path.string()), {}};
    const Result<ReaderMessage> hello = open.reader.receive();
    if (!hello) return hello.error();
    if (hello->type != stream::MessageType::Hello)
        return Error{
            fmt::format("'{}' cannot be used: its reader does not introduce itself", open.file)};
    open.info.format = printable(
        std::string_view(hello->payload.data(), hello->payload.size()).substr(sizeof(uint32_t)));
    while (true) {
        const Result<ReaderMessage> message = open.reader.receive();
        if (!message) return message.error();
        if (message->type == stream::MessageType::ListEnd) return open;
        if (open.info.grids.size() >= stream::kMaximumGrids)
            return Error{fmt::format("'{}' is damaged: it lists grids without end", open.file)};
        Result<GridInfo> grid = parseGrid(*message, open.file);
        if (!grid) return grid.error();
        open.info.grids.push_back(std::move(grid).value());
    }
}

/// Calls `each` with every record of the payload.
template <typename Record, typename Function>
Result<void> forEachRecord(const ReaderMessage& message, Function each) {
    if (message.payload.size() % sizeof(Record) != 0)
        return Error{"its reader sent part of a block"};
    Record record;
    for (size_t offset = 0; offset < message.payload.size(); offset += sizeof(Record)) {
        std::memcpy(&record, message.payload.data() + offset, sizeof record);
        if (const Result<void> taken = each(record); !taken) return taken;
    }
    return {};
}

Result<void> takeVoxels(const ReaderMessage& message, SparseVoxels& voxels) {
    switch (message.type) {
    case stream::MessageType::Blocks:
        return forEachRecord<stream::BlockRecord>(message, [&](const stream::BlockRecord& block) {
            return voxels.addBlock({block.origin[0], block.origin[1], block.origin[2]},
                                   block.values);
        });
    case stream::MessageType::Tiles:
        return forEachRecord<stream::TileRecord>(message, [&](const stream::TileRecord& tile) {
            return voxels.addTile({tile.origin[0], tile.origin[1], tile.origin[2]}, tile.size,
                                  tile.value);
        });
    default: return Error{"its reader sent something unexpected"};
    }
}

void noteRepairs(const VoxelRepairs& repairs, const std::string& place,
                 std::vector<std::string>& notes) {
    const auto note = [&](uint64_t count, const char* kind, const std::string& what) {
        if (count > 0)
            notes.push_back(fmt::format("{}: {} {} voxel{} set to {}", place, count, kind,
                                        count == 1 ? " was" : "s were", what));
    };
    note(repairs.nonFinite, "non-finite", "0");
    note(repairs.negative, "negative", "0");
    note(repairs.huge, "huge", fmt::format("{:g}", double(kMaximumVoxel)));
}

Result<void> checkTransform(const GridInfo& grid, const std::string& place) {
    const dmat4& m = grid.worldFromIndex;
    bool finite = true;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) finite = finite && std::isfinite(m[column][row]);
    if (!finite || m[0][3] != 0 || m[1][3] != 0 || m[2][3] != 0 || m[3][3] != 1)
        return Error{fmt::format("{} has a transform that is not affine", place)};
    // Relative to the columns' lengths, so that a grid in nanometres is as good as one in parsecs.
    const double lengths =
        glm::length(dvec3(m[0])) * glm::length(dvec3(m[1])) * glm::length(dvec3(m[2]));
    if (!(lengths > 0) || !std::isfinite(lengths) ||
        !(std::abs(glm::determinant(dmat3(m))) > 1e-9 * lengths))
        return Error{
            fmt::format("{} has a transform without an inverse: its voxels have no volume", place)};
    return {};
}

Result<std::shared_ptr<const BrickGrid>>
readGrid(OpenFile& open, size_t index, const GridLimits& limits, std::vector<std::string>& notes) {
    const GridInfo& grid = open.info.grids[index];
    const std::string place = fmt::format("'{}': grid '{}'", open.file, grid.name);
    if (const Result<void> usable = checkTransform(grid, place); !usable) return usable.error();
    if (const Result<void> asked = open.reader.send(stream::CommandType::Read, uint32_t(index));
        !asked)
        return asked.error();
    SparseVoxels voxels(limits);
    while (true) {
        const Result<ReaderMessage> message = open.reader.receive();
        if (!message) return message.error();
        if (message->type == stream::MessageType::GridEnd) break;
        if (const Result<void> taken = takeVoxels(*message, voxels); !taken)
            return Error{fmt::format("{} cannot be used: {}", place, taken.message())};
    }
    noteRepairs(voxels.repairs(), place, notes);
    Result<BrickGrid> bricks = voxels.build(grid.worldFromIndex);
    if (!bricks) return Error{fmt::format("{} cannot be used: {}", place, bricks.message())};
    return std::make_shared<const BrickGrid>(std::move(bricks).value());
}

} // namespace

Result<GridFile> importGrid(const fs::path& path, const GridRequest& request) {
    Result<OpenFile> open = openFile(path, request.limits);
    if (!open) return open.error();
    Result<GridSelection> selection = selectGrids(open->info.grids, request, open->file);
    if (!selection) return selection.error();

    GridFile file;
    file.notes = std::move(selection->notes);
    file.densityName = open->info.grids[selection->density].name;
    Result<std::shared_ptr<const BrickGrid>> density =
        readGrid(*open, selection->density, request.limits, file.notes);
    if (!density) return density.error();
    file.density = *density;
    if (selection->temperature) {
        file.temperatureName = open->info.grids[*selection->temperature].name;
        Result<std::shared_ptr<const BrickGrid>> temperature =
            readGrid(*open, *selection->temperature, request.limits, file.notes);
        if (!temperature) return temperature.error();
        file.temperature = *temperature;
    }
    return file;
}

Result<GridFileInfo> gridInfo(const fs::path& path, const GridLimits& limits) {
    Result<OpenFile> open = openFile(path, limits);
    if (!open) return open.error();
    for (size_t i = 0; i < open->info.grids.size(); ++i) {
        GridInfo& grid = open->info.grids[i];
        if (!grid.importable || grid.activeVoxels > 0)
            continue; // older files do not record the count
        if (const Result<void> asked = open->reader.send(stream::CommandType::Measure, uint32_t(i));
            !asked)
            return asked.error();
        const Result<ReaderMessage> message = open->reader.receive();
        if (!message) return message.error();
        Result<GridInfo> measured = parseGrid(*message, open->file);
        if (!measured) return measured.error();
        grid = std::move(measured).value();
    }
    return std::move(open->info);
}

} // namespace tyndall
