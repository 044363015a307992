#pragma once
// Grids from OpenVDB (.vdb) and NanoVDB (.nvdb) files.
//
// The libraries that understand these formats trust their input, so they run in another process, `tyndall-grid-reader`,
// under limits of time and memory; this side checks all that comes back. A damaged or hostile file can end that
// process, never this one. The reader is looked for at $TYNDALL_GRID_READER, beside the running program, and in
// ../libexec and ../bin from there.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/result.h"
#include "media/brick_grid.h"

namespace tyndall {

/// What an import may use. The defaults suit files of up to some gigabytes; tests choose smaller ones.
struct GridLimits {
    double seconds = 0; // of wall time for the reader; 0: 20 s and 1 s for every 10 MB of file
    uint64_t readerBytes = uint64_t(16) << 30; // address space of the reader process
    uint64_t sampleBytes = uint64_t(4) << 30;  // of samples in one BrickGrid
    uint64_t brickCount = uint64_t(1) << 24;   // entries of one brick table, empty ones included
};

/// Which grids to take from a file.
struct GridRequest {
    std::string
        density; // a grid's name; "": by synonym (density, smoke …), else the only fog volume
    std::string temperature; // a grid's name; "": none, unless `findTemperature`
    bool findTemperature =
        false; // look for a synonym (temperature, heat, flame, fuel); finding none is no error
    GridLimits limits;
};

/// What importGrid found.
struct GridFile {
    std::shared_ptr<const BrickGrid>
        density; // never null; values ≥ 0 and finite; may be empty (no bricks)
    std::shared_ptr<const BrickGrid> temperature; // kelvin; null where none was asked for or found
    std::string densityName, temperatureName;     // as in the file
    std::vector<std::string> notes; // a sentence each: synonyms mapped, voxels set to 0 …
};

/// Reads the density (and the temperature) of a .vdb or .nvdb file.
///
/// Only scalar fog volumes of float, half or double (OpenVDB) and float, double, Fp4, Fp8, Fp16 or FpN (NanoVDB) are
/// taken; a grid without a class is taken with a note. Values that the file stores for inactive voxels count; outside
/// the stored voxels the field is 0. Non-finite and negative voxels become 0, values above kMaximumVoxel that; both are
/// counted in a note. The transform may be any invertible affine one.
///
/// Errors, one sentence each: file missing, not a VDB, damaged, too large for the limits; no usable grid (the sentence
/// names what is there); the grid asked for is missing, a level set, vectors, points; a frustum transform; no reader.
Result<GridFile> importGrid(const std::filesystem::path& path, const GridRequest& request = {});

/// Voxels above this are set to it, so that no sum or product of densities overflows single precision.
inline constexpr float kMaximumVoxel = 1e20f;

/// One grid of a file, as `tyndall info FILE` shows it.
struct GridInfo {
    std::string name; // may be empty, and need not be unique
    std::string
        type; // "float", "float (stored as half)", "double", "vec3s", "Fp8", "FpN", "unreadable" …
    std::string gridClass; // "fog volume", "level set", "staggered", "points", "unknown" …
    uint64_t activeVoxels = 0;
    ivec3 first{0},
        last{-1};       // index-space box of the active voxels, inclusive; empty where last < first
    bool affine = true; // false: a frustum
    dmat4 worldFromIndex{1.0}; // meaningless where not affine
    bool importable = false;   // a scalar that could be density
};

struct GridFileInfo {
    std::string format; // "OpenVDB 224", "NanoVDB 32.4.2"
    std::vector<GridInfo> grids;
};

/// What is in the file, without reading voxels where the format allows it. Errors as importGrid.
Result<GridFileInfo> gridInfo(const std::filesystem::path& path, const GridLimits& limits = {});

} // namespace tyndall
