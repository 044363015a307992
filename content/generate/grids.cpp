// Makes the grids of content/: a puff of smoke, a fire, a cloud. The same bytes on every run.
//   g++ -std=c++20 -O2 content/generate/grids.cpp -lopenvdb -ltbb -lImath -o /tmp/grids && /tmp/grids content
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>

#include <openvdb/openvdb.h>

namespace {

double smooth(double t) { return t * t * (3 - 2 * t); }
double ramp(double low, double high, double x) {
    return smooth(std::clamp((x - low) / (high - low), 0.0, 1.0));
}

/// A number in 0..1 for a lattice point; the constants are those of a common integer mixer (lowbias32).
double latticeValue(int x, int y, int z) {
    uint32_t h = uint32_t(x) * 73856093u ^ uint32_t(y) * 19349663u ^ uint32_t(z) * 83492791u;
    h ^= h >> 16;
    h *= 0x7feb352du;
    h ^= h >> 15;
    h *= 0x846ca68bu;
    h ^= h >> 16;
    return h / 4294967295.0;
}

double valueNoise(double x, double y, double z) {
    const int ix = int(std::floor(x)), iy = int(std::floor(y)), iz = int(std::floor(z));
    const double fx = smooth(x - ix), fy = smooth(y - iy), fz = smooth(z - iz);
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const int dx = corner & 1, dy = corner >> 1 & 1, dz = corner >> 2;
        sum += latticeValue(ix + dx, iy + dy, iz + dz) * (dx ? fx : 1 - fx) * (dy ? fy : 1 - fy) *
               (dz ? fz : 1 - fz);
    }
    return sum;
}

/// Octaves of value noise, about 0..1 around 0.5.
double fractalNoise(double x, double y, double z, int octaves) {
    double sum = 0, weight = 0.5, total = 0;
    for (int i = 0; i < octaves; ++i) {
        sum += weight * valueNoise(x, y, z);
        total += weight;
        weight *= 0.5;
        x = 2 * x + 17.3;
        y = 2 * y + 5.1;
        z = 2 * z + 11.7;
    }
    return sum / total;
}

/// Fills a grid by a function of the voxel's position in metres; voxels below a threshold are left out.
template <typename F>
openvdb::FloatGrid::Ptr makeGrid(const char* name, openvdb::Coord size, double voxelMetres,
                                 openvdb::Vec3d origin, F&& value) {
    openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0.0f);
    grid->setName(name);
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    auto transform = openvdb::math::Transform::createLinearTransform(voxelMetres);
    transform->postTranslate(origin);
    grid->setTransform(transform);
    grid->setSaveFloatAsHalf(true);
    auto accessor = grid->getAccessor();
    for (int z = 0; z < size.z(); ++z)
        for (int y = 0; y < size.y(); ++y)
            for (int x = 0; x < size.x(); ++x) {
                const openvdb::Vec3d p = transform->indexToWorld(openvdb::Coord(x, y, z));
                const double v = value(p.x(), p.y(), p.z());
                if (v > 1e-3) accessor.setValue(openvdb::Coord(x, y, z), float(v));
            }
    return grid;
}

void write(const std::string& path, const openvdb::GridPtrVec& grids) {
    openvdb::io::File file(path);
    file.setCompression(openvdb::io::COMPRESS_ZIP | openvdb::io::COMPRESS_ACTIVE_MASK);
    file.write(grids);
    std::printf("%s\n", path.c_str());
}

/// A ball of smoke, 2.4 m across, centred at the origin.
void smokePuff(const std::string& folder) {
    write(folder + "/smoke_puff.vdb",
          {makeGrid("density", {48, 48, 48}, 0.05, {-1.175, -1.175, -1.175},
                    [](double x, double y, double z) {
                        const double noise =
                            fractalNoise(2.2 * x + 40, 2.2 * y + 20, 2.2 * z + 60, 4);
                        const double radius =
                            std::sqrt(x * x + 1.3 * y * y + z * z) + 1.1 * (noise - 0.5);
                        return (1 - ramp(0.5, 0.95, radius)) * (0.4 + noise);
                    })});
}

/// Flames 0.5 m wide and 1.1 m high, smoke up to 2.5 m; the origin is on the ground.
void campfire(const std::string& folder) {
    const openvdb::Coord size(40, 64, 40);
    const openvdb::Vec3d origin(-0.78, 0.02, -0.78);
    const auto sway = [](double y, double phase) {
        return 0.25 * y * (fractalNoise(1.1 * y + phase, phase, 3.3, 2) - 0.5);
    };
    const auto flame = [&](double x, double y, double z) { // 1 in the core, 0 outside
        const double lick = fractalNoise(5 * x + 9, 3 * y + 4, 5 * z + 2, 3);
        const double width = 0.3 * std::sqrt(std::max(0.0, 1.15 - y)) * (0.55 + 0.9 * lick);
        const double r = std::hypot(x - sway(y, 1), z - sway(y, 7));
        return (1 - ramp(0.35 * width, width + 1e-6, r)) *
               (1 - ramp(0.75, 1.15, y + 0.3 * (lick - 0.5)));
    };
    const auto smoke = [&](double x, double y, double z) {
        const double noise = fractalNoise(4 * x, 3 * y + 30, 4 * z, 4);
        const double r =
            std::hypot(x - 1.4 * sway(y, 1), z - 1.4 * sway(y, 7)) + 0.5 * (noise - 0.5);
        return ramp(0.7, 1.4, y) * (1 - ramp(1.9, 2.5, y)) * (1 - ramp(0.1, 0.2 + 0.18 * y, r)) *
               noise;
    };
    write(folder + "/campfire.vdb",
          {makeGrid("density", size, 0.04, origin,
                    [&](double x, double y, double z) {
                        return smoke(x, y, z) + 0.25 * flame(x, y, z);
                    }),
           makeGrid("temperature", size, 0.04, origin, [&](double x, double y, double z) {
               const double f = flame(x, y, z);
               return f > 0 ? 300 + 1500 * std::sqrt(f) : 0.0;
           })});
}

/// A cumulus 900 m long and 450 m high with a flat base at y = 0.
void cloud(const std::string& folder) {
    struct Ball {
        double x, y, z, radius;
    };
    const Ball balls[] = {{0, 130, 0, 190},   {-190, 90, 40, 150},  {200, 100, -30, 160},
                          {60, 250, 30, 130}, {-80, 220, -40, 110}, {310, 60, 20, 90},
                          {-310, 55, -10, 95}};
    write(folder + "/cloud.vdb",
          {makeGrid(
              "density", {80, 42, 56}, 12, {-474, -18, -330}, [&](double x, double y, double z) {
                  const double noise = fractalNoise(x / 110 + 50, y / 110 + 50, z / 110 + 50, 5);
                  double nearest = 1e9;
                  for (const Ball& ball : balls)
                      nearest = std::min(nearest, std::sqrt((x - ball.x) * (x - ball.x) +
                                                            (y - ball.y) * (y - ball.y) +
                                                            (z - ball.z) * (z - ball.z)) -
                                                      ball.radius);
                  const double depth = -(nearest + 130 * (noise - 0.5));
                  return ramp(0, 45, depth) * ramp(-10, 25, y + 30 * (noise - 0.5)) *
                         (0.6 + 0.4 * noise);
              })});
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: %s FOLDER\n", argv[0]);
        return 2;
    }
    openvdb::initialize();
    smokePuff(argv[1]);
    campfire(argv[1]);
    cloud(argv[1]);
    return 0;
}
