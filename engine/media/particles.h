#pragma once
// Particle media as data: read from CSV files or generated. particle_grids.h makes bricks of them.

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "core/math.h"
#include "core/result.h"

namespace tyndall {

/// A ball of matter. Its density, the mean over the ball, multiplies the medium's coefficients; particle_grids.h says how it is spread.
struct Particle {
    vec3 position{0};      // metres, the medium's node space
    float radius = 0;      // metres, > 0
    float density = 1;     // ≥ 0
    float temperature = 0; // kelvin, ≥ 0
};

struct ParticleSet {
    std::vector<Particle> particles;
    bool hasTemperature = false;
    [[nodiscard]] Bounds bounds() const; // of the balls
};

inline constexpr size_t kMaximumParticles = 10'000'000;

/// CSV with the header `x,y,z,radius,density[,temperature]` and one particle a line. Spaces around values, empty
/// lines, CRLF and a byte order mark are fine. `name` stands in the error, as does the line: wrong header, wrong number of
/// values, not a number, not finite, radius ≤ 0, density or temperature < 0, no particles, more than kMaximumParticles.
Result<ParticleSet> parseParticles(std::string_view csv, std::string_view name);
/// The same from a file. Errors also: missing, a folder, over 1 GiB.
Result<ParticleSet> readParticles(const std::filesystem::path& path);

/// `"generate": {"kind": …}`. The only kind is "cloud": overlapping puffs above a flat base, within `radius` metres of the
/// origin; count 1..1,000,000. The same arguments give the same particles everywhere. Errors: unknown kind, range.
Result<ParticleSet> generateParticles(std::string_view kind, int64_t count, uint64_t seed,
                                      double radius);

} // namespace tyndall
