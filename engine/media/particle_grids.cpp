#include "media/particle_grids.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "core/math.h"
#include "media/medium.h"
#include "media/sparse_voxels.h"

namespace tyndall {

namespace {

constexpr double kFarthest = 1e30; // metres, as for the nodes of a scene
constexpr double kSmallestVoxel =
    1e-9; // metres, as the smallest primitive: single precision has room
constexpr double kFarthestBlock = kMaximumIndex / kBlockSize / 2;
/// Voxels: a cell with matter in it has all its corners within this of a particle's ball.
constexpr double kCellDiagonal = 1.7320508075688773;

/// In voxels, from voxel (0,0,0).
struct Ball {
    dvec3 centre;
    double radius;
};

/// Where voxels lie: voxel i at anchor + voxel·i.
struct Lattice {
    dvec3 anchor{0};
    double voxel = 1; // metres
    double rim = 0;   // voxels by which balls are asked for beyond their matter

    [[nodiscard]] Ball ball(const Particle& p) const {
        return {(dvec3(p.position) - anchor) / voxel,
                std::max(double(p.radius) / voxel, kLeastParticleRadius)};
    }
    /// The kernel's peak.
    [[nodiscard]] double peak(const Particle& p, const Ball& ball) const {
        const double share = double(p.radius) / (voxel * ball.radius); // 1 but for small particles
        return kParticlePeak * double(p.density) * share * share * share;
    }
    [[nodiscard]] dvec3 lowestBlock(const Ball& ball) const {
        return glm::floor(glm::ceil(ball.centre - ball.radius - rim) / double(kBlockSize));
    }
    [[nodiscard]] dvec3 highestBlock(const Ball& ball) const {
        return glm::floor((ball.centre + ball.radius + rim) / double(kBlockSize));
    }
};

/// The blocks that balls lie in, and of each the balls that reach it.
class BlockTable {
public:
    BlockTable(const std::vector<Particle>& particles, const Lattice& lattice)
        : particles_(particles), lattice_(lattice) {
        for (const Particle& p : particles) {
            const Ball ball = lattice.ball(p);
            low_ = glm::min(low_, lattice.lowestBlock(ball));
            high_ = glm::max(high_, lattice.highestBlock(ball));
            // Those of the least size take what they take; larger voxels would change nothing.
            const double reach = ball.radius + lattice.rim;
            if (ball.radius > kLeastParticleRadius) sums_ += 4.0 / 3 * kPi * reach * reach * reach;
        }
    }

    /// How many times as much as allowed all this would take, the worst of it; fits where it is at most 1.
    [[nodiscard]] double excess(const ParticleGridLimits& limits) {
        const dvec3 count = high_ - low_ + 1.0;
        const dvec3 farthest = glm::max(glm::abs(low_), glm::abs(high_));
        const double first = std::max(
            {count.x * count.y * count.z / double(limits.blocks), sums_ / double(limits.sums),
             std::max({farthest.x, farthest.y, farthest.z}) / kFarthestBlock});
        if (!(first <= 1)) return first; // too many to count how many of them are touched
        countBalls();
        const auto touched = std::count_if(firstBall_.begin(), firstBall_.end(),
                                           [](size_t balls) { return balls > 0; });
        return std::max(first, double(touched) * kBlockVoxels / double(limits.voxels));
    }

    /// Lists the balls; after an excess() of at most 1.
    void list() {
        size_t sum = 0;
        for (size_t& entry : firstBall_) sum += std::exchange(entry, sum);
        firstBall_.push_back(sum);
        balls_.resize(sum);
        std::vector<size_t> next = firstBall_;
        for (size_t i = 0; i < particles_.size(); ++i)
            forEachBlock(particles_[i], [&](size_t block) { balls_[next[block]++] = uint32_t(i); });
    }

    /// Calls `each` with the first voxel of every block and its particles, in their order.
    template <typename Function> Result<void> forEach(Function each) const {
        size_t block = 0;
        const ivec3 count = size();
        for (int z = 0; z < count.z; ++z)
            for (int y = 0; y < count.y; ++y)
                for (int x = 0; x < count.x; ++x, ++block) {
                    const size_t begin = firstBall_[block], end = firstBall_[block + 1];
                    if (begin == end) continue;
                    const std::span<const uint32_t> balls(&balls_[begin], end - begin);
                    if (Result<void> done =
                            each((ivec3(low_) + ivec3(x, y, z)) * kBlockSize, balls);
                        !done)
                        return done;
                }
        return {};
    }

private:
    [[nodiscard]] ivec3 size() const { return ivec3(high_ - low_) + 1; }
    template <typename Function> void forEachBlock(const Particle& p, Function each) const {
        const Ball ball = lattice_.ball(p);
        const ivec3 low(lattice_.lowestBlock(ball) - low_),
            high(lattice_.highestBlock(ball) - low_), count = size();
        for (int z = low.z; z <= high.z; ++z)
            for (int y = low.y; y <= high.y; ++y)
                for (int x = low.x; x <= high.x; ++x)
                    each((size_t(z) * size_t(count.y) + size_t(y)) * size_t(count.x) + size_t(x));
    }
    void countBalls() {
        const dvec3 count = high_ - low_ + 1.0;
        firstBall_.assign(size_t(count.x * count.y * count.z), 0);
        for (const Particle& p : particles_)
            forEachBlock(p, [&](size_t block) { ++firstBall_[block]; });
    }

    const std::vector<Particle>& particles_;
    const Lattice& lattice_;
    dvec3 low_{std::numeric_limits<double>::infinity()}, high_{-low_}; // blocks, inclusive
    double sums_ = 0;
    std::vector<size_t> firstBall_; // first how many, then where they begin in balls_
    std::vector<uint32_t> balls_;   // indices of particles
};

/// Adds peak·(1 - d²/r²)³ at the voxels of a block; `ball` counts from its first voxel.
void addKernel(const Ball& ball, double peak, double* sums) {
    const double scale = 1 / (ball.radius * ball.radius);
    const auto squared = [&](int voxel, double centre) {
        return (voxel - centre) * (voxel - centre) * scale;
    };
    double across[kBlockSize];
    for (int x = 0; x < kBlockSize; ++x) across[x] = squared(x, ball.centre.x);
    for (int z = 0; z < kBlockSize; ++z)
        for (int y = 0; y < kBlockSize; ++y, sums += kBlockSize) {
            const double rest = 1 - squared(y, ball.centre.y) - squared(z, ball.centre.z);
            if (!(rest > 0)) continue;
            for (int x = 0; x < kBlockSize; ++x) {
                const double t = std::max(rest - across[x], 0.0);
                sums[x] += peak * (t * t * t);
            }
        }
}

/// Too much stays too much, for SparseVoxels to see, but within single precision.
float asVoxel(double sum) { return float(std::min(sum, 2.0 * double(kMaximumVoxel))); }

/// One block's sums over particles, of weights and of weights times temperature.
struct BlockSums {
    double density[kBlockVoxels], heat[kBlockVoxels];
    double rimDensity[kBlockVoxels], rimHeat[kBlockVoxels];

    void add(const Particle& p, Ball ball, double peak, bool hot) {
        addKernel(ball, peak, density);
        if (!hot) return;
        const double kelvin(p.temperature);
        addKernel(ball, peak * kelvin, heat);
        ball.radius += kCellDiagonal;
        addKernel(ball, peak, rimDensity);
        addKernel(ball, peak * kelvin, rimHeat);
    }
    [[nodiscard]] float temperature(int i) const {
        if (density[i] > 0) return asVoxel(heat[i] / density[i]);
        return rimDensity[i] > 0 ? asVoxel(rimHeat[i] / rimDensity[i]) : 0;
    }
};

Result<void> check(const ParticleSet& set) {
    for (size_t i = 0; i < set.particles.size(); ++i) {
        const Particle& p = set.particles[i];
        const auto wrong = [&](const char* what, float value, const char* right) {
            return Error{
                fmt::format("particle {} has the {} {}; it must be {}", i, what, value, right)};
        };
        if (!(p.radius > 0)) return wrong("radius", p.radius, "greater than 0");
        if (!(p.density >= 0) || std::isinf(p.density))
            return wrong("density", p.density, "finite and not negative");
        if (!(p.temperature >= 0) || std::isinf(p.temperature))
            return wrong("temperature", p.temperature, "finite and not negative");
        for (int axis = 0; axis < 3; ++axis)
            if (!(std::abs(double(p.position[axis])) + double(p.radius) <= kFarthest))
                return Error{fmt::format("particle {} reaches beyond 1e30 metres", i)};
    }
    return {};
}

/// Those with matter, in an order that their own values give.
std::vector<Particle> sorted(const ParticleSet& set) {
    std::vector<Particle> particles;
    for (const Particle& p : set.particles)
        if (p.density > 0) particles.push_back(p);
    const auto key = [](const Particle& p) {
        return std::tie(p.position.z, p.position.y, p.position.x, p.radius, p.density,
                        p.temperature);
    };
    std::sort(particles.begin(), particles.end(),
              [&](const Particle& a, const Particle& b) { return key(a) < key(b); });
    return particles;
}

double finestVoxel(const std::vector<Particle>& particles) {
    std::vector<float> radii;
    for (const Particle& p : particles) radii.push_back(p.radius);
    const auto small = radii.begin() + std::ptrdiff_t(radii.size() / 10);
    std::nth_element(radii.begin(), small, radii.end());
    return std::max(double(*small) / kVoxelsPerRadius, kSmallestVoxel);
}

Lattice latticeOf(const dvec3& centre, double voxel, bool hot) {
    // Voxels lie at multiples of their size, so that they stay where they are when particles move.
    return {voxel * glm::round(centre / voxel), voxel, hot ? kCellDiagonal : 0};
}

void noteSizes(const std::vector<Particle>& particles, double voxel, double finest,
               std::vector<std::string>& notes) {
    if (voxel > finest)
        notes.push_back(fmt::format(
            "voxels of {:.3g} m stand for particles that ask for {:.3g} m, which would take more memory or time than they may",
            voxel, finest));
    const auto small = std::count_if(particles.begin(), particles.end(), [&](const Particle& p) {
        return double(p.radius) < kLeastParticleRadius * voxel;
    });
    if (small > 0)
        notes.push_back(fmt::format(
            "{} of {} particles are smaller than {:.3g} m, two voxels, and are spread over that radius with the same matter",
            small, particles.size(), kLeastParticleRadius * voxel));
}

/// The voxels of both fields; temperature's stay empty where there is none.
struct Fields {
    SparseVoxels density, temperature;

    Result<void> sum(const std::vector<Particle>& particles, const Lattice& lattice,
                     const BlockTable& table) {
        const bool hot = lattice.rim > 0;
        const auto sums = std::make_unique<BlockSums>();
        return table.forEach([&](ivec3 origin, std::span<const uint32_t> balls) -> Result<void> {
            *sums = {};
            for (const uint32_t i : balls) {
                Ball ball = lattice.ball(particles[i]);
                const double peak = lattice.peak(particles[i], ball);
                ball.centre -= dvec3(origin);
                sums->add(particles[i], ball, peak, hot);
            }
            float values[kBlockVoxels];
            for (int i = 0; i < kBlockVoxels; ++i) values[i] = asVoxel(sums->density[i]);
            if (Result<void> added = density.addBlock(origin, values); !added || !hot) return added;
            for (int i = 0; i < kBlockVoxels; ++i) values[i] = sums->temperature(i);
            return temperature.addBlock(origin, values);
        });
    }
};

Result<std::shared_ptr<const BrickGrid>> build(const SparseVoxels& voxels, const Lattice& lattice) {
    dmat4 worldFromIndex(lattice.voxel);
    worldFromIndex[3] = dvec4(lattice.anchor, 1);
    Result<BrickGrid> bricks = voxels.build(worldFromIndex);
    if (!bricks) return bricks.error();
    return std::make_shared<const BrickGrid>(std::move(*bricks));
}

} // namespace

Result<ParticleGrids> makeParticleGrids(const ParticleSet& set, const ParticleGridLimits& limits) {
    if (const Result<void> usable = check(set); !usable) return usable.error();
    ParticleGrids grids;
    const std::vector<Particle> particles = sorted(set);
    Lattice lattice;
    Fields fields;
    if (!particles.empty()) {
        const dvec3 centre = ParticleSet{particles}.bounds().centre();
        const double finest = finestVoxel(particles);
        lattice = latticeOf(centre, finest, set.hasTemperature);
        std::optional<BlockTable> table;
        while (true) {
            const double excess = table.emplace(particles, lattice).excess(limits);
            if (excess <= 1) break;
            lattice = latticeOf(centre, lattice.voxel * std::max(std::cbrt(excess), 1.05),
                                set.hasTemperature);
        }
        noteSizes(particles, lattice.voxel, finest, grids.notes);
        table->list();
        if (const Result<void> done = fields.sum(particles, lattice, *table); !done)
            return done.error();
    }
    const uint64_t huge = fields.density.repairs().total() + fields.temperature.repairs().total();
    if (huge > 0)
        grids.notes.push_back(fmt::format("{} huge voxels of particles were set to {:g}", huge,
                                          double(kMaximumVoxel)));
    const auto density = build(fields.density, lattice);
    if (!density) return density.error();
    grids.density = *density;
    if (!set.hasTemperature) return grids;
    const auto temperature = build(fields.temperature, lattice);
    if (!temperature) return temperature.error();
    grids.temperature = *temperature;
    return grids;
}

Result<std::vector<std::string>> setParticles(Medium& medium,
                                              std::shared_ptr<const ParticleSet> particles) {
    Result<ParticleGrids> grids = makeParticleGrids(*particles);
    if (!grids) return grids.error();
    medium.kind = MediumKind::Grid;
    medium.particles = std::move(particles);
    medium.density = std::move(grids->density);
    medium.temperature = std::move(grids->temperature);
    return std::move(grids->notes);
}

} // namespace tyndall
