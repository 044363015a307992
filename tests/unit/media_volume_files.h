#pragma once
// Volume files for tests, written by OpenVDB and NanoVDB themselves, and OpenVDB's own reading of files as the
// independent answer to what an import must give. No header of these libraries is needed to use this one.

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/math.h"

namespace tyndall::test {

/// One grid to be written.
struct VolumeSpec {
    enum class Type { Float = 0, HalfStored = 1, Double = 2, Vector = 3, Integer = 4 };
    enum class Class { Fog = 0, LevelSet = 1, Unknown = 2 };
    std::string name = "density";
    Type type = Type::Float;
    Class gridClass = Class::Fog;
    dmat4 worldFromIndex{1.0};
    bool frustum = false; // instead of worldFromIndex
    double background = 0;
    std::vector<std::pair<ivec3, double>> voxels;         // active
    std::vector<std::pair<ivec3, double>> inactiveVoxels; // values without being active
    struct Tile {
        ivec3 first, last; // inclusive; aligned boxes become tiles of the tree
        double value;
    };
    std::vector<Tile> tiles;
};

enum class NanoType { Float = 0, Double = 1, Fp4 = 2, Fp8 = 3, Fp16 = 4, FpN = 5 };
enum class NanoCodec { None = 0, Zip = 1, Blosc = 2 };

/// How an OpenVDB file is laid out.
struct VdbLayout {
    enum class Codec { Default = 0, None = 1, Zip = 2, Blosc = 3 };
    Codec codec = Codec::Default;
    bool offsets = true; // false: as through a pipe, without the places of the grids
};
void writeOpenVdb(const std::filesystem::path& path, const std::vector<VolumeSpec>& grids,
                  const VdbLayout& layout = {});
/// Grids that share one tree, which the file then holds once.
void writeInstances(const std::filesystem::path& path, const VolumeSpec& grid,
                    const std::vector<std::string>& names);
/// The spec's type is ignored in favour of `type`.
void writeNanoVdb(const std::filesystem::path& path, const VolumeSpec& grid, NanoType type,
                  NanoCodec codec);
/// A grid of an OpenVDB file as NanoVDB.
void convertToNanoVdb(const std::filesystem::path& from, const std::filesystem::path& to,
                      NanoType type, NanoCodec codec);

/// A float or double grid as OpenVDB reads it.
class VolumeOracle {
public:
    VolumeOracle(const std::filesystem::path& path, const std::string& grid);
    ~VolumeOracle();
    /// openvdb::tools::BoxSampler at a position of the world.
    [[nodiscard]] double sample(const dvec3& world) const;
    /// Midpoint rule in `steps` over origin + t·direction, t in [0,length].
    [[nodiscard]] double integrate(const dvec3& origin, const dvec3& direction, double length,
                                   int steps) const;
    /// World position of an index position, by the file's transform.
    [[nodiscard]] dvec3 world(const dvec3& index) const;
    /// Index box of the active voxels.
    [[nodiscard]] std::pair<ivec3, ivec3> activeBox() const;
    [[nodiscard]] double voxel(ivec3 index) const;
    [[nodiscard]] uint64_t activeVoxels() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace tyndall::test
