#pragma once
// The reader's end of the stream, and the two libraries behind one interface.

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "media/reader/grid_stream.h"

namespace tyndall::reader {

/// Sends messages; voxels are gathered into large ones. Exits the process when the importer has gone.
class VoxelSink {
public:
    explicit VoxelSink(int socket) : socket_(socket) {}
    void send(stream::MessageType type, const void* head, size_t headBytes,
              std::string_view text = {});
    /// 8³ values at `origin`, the value of (x, y, z) at index x·64 + y·8 + z (the order of both libraries).
    /// Blocks of nothing but zeros are not sent.
    void block(const std::array<int32_t, 3>& origin, const float* valuesZFastest);
    void tile(const std::array<int32_t, 3>& origin, int32_t size, float value);
    void endGrid();

private:
    void flushBlocks();
    void flushTiles();
    int socket_;
    std::vector<stream::BlockRecord> blocks_;
    std::vector<stream::TileRecord> tiles_;
};

struct GridDescription {
    stream::GridRecord record;
    std::string name, type, gridClass;
};

/// A file opened by one of the libraries. Every function may throw: std::exception with a reason for people.
class GridSource {
public:
    virtual ~GridSource() = default;
    [[nodiscard]] virtual std::string format() const = 0;
    [[nodiscard]] virtual std::vector<GridDescription> list() = 0;
    [[nodiscard]] virtual GridDescription measure(uint32_t grid) = 0;
    virtual void read(uint32_t grid, VoxelSink& sink) = 0;
};

std::unique_ptr<GridSource> openOpenVdb(const std::string& path);
std::unique_ptr<GridSource> openNanoVdb(const std::string& path);

} // namespace tyndall::reader
