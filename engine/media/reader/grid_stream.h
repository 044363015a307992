#pragma once
// What tyndall-grid-reader and the importer say to each other over one socket (the reader's standard input).
// The reader lists the file's grids at once, then answers commands until the socket closes. Both ends are built
// together and run on one machine, so structs travel as they are; kStreamVersion guards against a stale reader.

#include <cstdint>

namespace tyndall::stream {

inline constexpr uint32_t kMagic = 0x79744772;
inline constexpr uint32_t kStreamVersion = 1;
inline constexpr uint32_t kMaximumMessageBytes = 1u << 20;
inline constexpr uint32_t kMaximumGrids = 4096;
inline constexpr uint32_t kMaximumTextBytes = 1024;

enum class MessageType : uint32_t {
    Hello = 1,   // uint32 kStreamVersion, then the format as text
    Grid = 2,    // GridRecord, then name, type and class as text
    ListEnd = 3, // empty
    Blocks = 4,  // BlockRecords
    Tiles = 5,   // TileRecords
    GridEnd = 6, // empty: all voxels of the grid were sent
    Failure = 7, // text: what is wrong with the file, without its name
};

struct MessageHeader {
    uint32_t magic = kMagic;
    MessageType type{};
    uint32_t bytes = 0; // of payload, at most kMaximumMessageBytes
};

struct GridRecord {
    uint64_t activeVoxels = 0;
    int32_t first[3] = {0, 0, 0};
    int32_t last[3] = {-1, -1, -1};
    double worldFromIndex[16] = {1, 0, 0, 0, 0, 1, 0, 0,
                                 0, 0, 1, 0, 0, 0, 0, 1}; // column after column
    uint32_t affine = 1;
    uint32_t importable = 0;
    uint32_t nameBytes = 0, typeBytes = 0, classBytes = 0;
    uint32_t padding = 0;
};

struct BlockRecord {
    int32_t origin[3];
    float values[512]; // x fastest
};
inline constexpr uint32_t kBlocksPerMessage = 256;
static_assert(kBlocksPerMessage * sizeof(BlockRecord) <= kMaximumMessageBytes);

struct TileRecord {
    int32_t origin[3];
    int32_t size; // edge in voxels
    float value;
};
inline constexpr uint32_t kTilesPerMessage = 16384;
static_assert(kTilesPerMessage * sizeof(TileRecord) <= kMaximumMessageBytes);

enum class CommandType : uint32_t {
    Read = 1, // answered by Blocks, Tiles …, GridEnd
    Measure =
        2, // answered by the Grid again, with voxel count and box even where the file does not record them
};

struct Command {
    uint32_t magic = kMagic;
    CommandType type{};
    uint32_t grid = 0; // in the order of the list
};

/// The reader's arguments: path, address-space limit in bytes (0: none), CPU seconds (0: unlimited).
inline constexpr int kReaderArguments = 3;

} // namespace tyndall::stream
