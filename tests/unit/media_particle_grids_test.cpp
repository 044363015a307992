#include "media/particle_grids.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <random>

#include "media/medium.h"
#include "media_dense_field.h"
#include "support/content.h"

namespace tyndall {
namespace {

using test::Draw;

ParticleGrids gridsOf(const ParticleSet& set, const ParticleGridLimits& limits = {}) {
    Result<ParticleGrids> grids = makeParticleGrids(set, limits);
    EXPECT_TRUE(grids.ok()) << (grids.ok() ? "" : grids.message());
    return *grids;
}

/// Radii within a factor of 1.5, so that none is smaller than two voxels.
ParticleSet randomSet(Draw& draw, int count, double reach, bool hot) {
    ParticleSet set;
    set.hasTemperature = hot;
    for (int i = 0; i < count; ++i) {
        const vec3 position(draw.uniform(-reach, reach), draw.uniform(-reach, reach),
                            draw.uniform(-reach, reach));
        set.particles.push_back({position, float(draw.uniform(0.4, 0.55)),
                                 float(draw.uniform(0, 3)),
                                 hot ? float(draw.uniform(500, 3000)) : 0});
    }
    return set;
}

double voxelOf(const BrickGrid& grid) { return grid.worldFromIndex[0][0]; }

/// ρ·(105/16)·(1 - d²/r²)³, written down anew.
double kernel(const Particle& p, const dvec3& at, double radius) {
    const dvec3 d = at - dvec3(p.position);
    const double t = 1 - (d.x * d.x + d.y * d.y + d.z * d.z) / (radius * radius);
    return t > 0 ? double(p.density) * 105 / 16 * t * t * t : 0;
}

/// Calls `each` with every voxel that the grid's bricks hold, and one more around them.
void forEachVoxel(const BrickGrid& grid, const std::function<void(const ivec3&)>& each) {
    const ivec3 last = grid.origin + kBrickCells * grid.brickCount;
    for (int z = grid.origin.z; z <= last.z; ++z)
        for (int y = grid.origin.y; y <= last.y; ++y)
            for (int x = grid.origin.x; x <= last.x; ++x) each({x, y, z});
}

/// Of the field between voxels: the hat around each voxel has the volume of a voxel.
double matterOf(const BrickGrid& grid) {
    double sum = 0;
    forEachVoxel(grid, [&](const ivec3& voxel) { sum += grid.sample(dvec3(voxel)); });
    return sum * std::pow(voxelOf(grid), 3);
}

double matterOf(const ParticleSet& set) {
    double sum = 0;
    for (const Particle& p : set.particles)
        sum += double(p.density) * 4 / 3 * kPi * std::pow(double(p.radius), 3);
    return sum;
}

bool sameBits(const BrickGrid& a, const BrickGrid& b) {
    return a.origin == b.origin && a.brickCount == b.brickCount &&
           a.worldFromIndex == b.worldFromIndex && a.samples.size() == b.samples.size() &&
           std::memcmp(a.samples.data(), b.samples.data(), a.samples.size() * sizeof(float)) == 0;
}

TEST(ParticleGrids, VoxelsAreTheSumsOfTheKernels) {
    Draw draw(test::seed());
    const ParticleSet set = randomSet(draw, 60, 1.2, true);
    const ParticleGrids grids = gridsOf(set);
    EXPECT_TRUE(grids.notes.empty());
    const double voxel = voxelOf(*grids.density);
    forEachVoxel(*grids.density, [&](const ivec3& index) {
        const dvec3 at(grids.density->worldFromIndex * dvec4(index, 1));
        double density = 0, heat = 0, rim = 0, rimHeat = 0;
        for (const Particle& p : set.particles) {
            const double here = kernel(p, at, double(p.radius)),
                         near = kernel(p, at, double(p.radius) + std::sqrt(3.0) * voxel);
            density += here;
            heat += here * double(p.temperature);
            rim += near;
            rimHeat += near * double(p.temperature);
        }
        // Half an ulp of single precision; at a kernel's edge (1 - d²/r²)³ has what is left of 10⁻¹⁵.
        EXPECT_NEAR(grids.density->sample(dvec3(index)), density, 6e-8 * density + 1e-14);
        if (density != 0 && density < 1e-12) return; // on either side of the edge, by rounding
        const double kelvin = density > 0 ? heat / density : rim > 0 ? rimHeat / rim : 0;
        const dvec3 inHeat(glm::inverse(grids.temperature->worldFromIndex) * dvec4(at, 1));
        if (density == 0 && rim < 1e-12) return;
        EXPECT_NEAR(grids.temperature->sample(glm::round(inHeat)), kelvin, 1e-7 * kelvin);
    });
}

TEST(ParticleGrids, OneParticleKeepsItsMatterWhereverItLies) {
    Draw draw(test::seed());
    // By Poisson's summation the sum over voxels errs by the kernel's Fourier transform at the lattice's frequencies,
    // Γ(11/2)·(2/k)^4.5·J_4.5(k) at k = 2πr|n|/voxel, |J_4.5(k)| < 1.1·√(2/πk), and Σ|n|⁻⁵ = 10.4 over all n ≠ 0.
    const auto bound = [](double voxels) { return 10.4 * 1040 / std::pow(2 * kPi * voxels, 5); };
    for (int i = 0; i < 40; ++i) {
        ParticleSet set{
            {{vec3(draw.uniform(-1, 1), draw.uniform(-1, 1), draw.uniform(-1, 1)), 0.25f, 2, 0}}};
        EXPECT_NEAR(matterOf(*gridsOf(set).density) / matterOf(set), 1, bound(kVoxelsPerRadius));
        // Beside ten larger ones it is spread over two voxels; those carry no weight to speak of.
        set.particles.resize(11, {{0, 0, 0}, 30, 1e-12f, 0});
        for (size_t other = 1; other < set.particles.size(); ++other)
            set.particles[other].radius = 0.6f, set.particles[other].position.x = float(other);
        const ParticleGrids grids = gridsOf(set);
        EXPECT_EQ(grids.notes.size(), 1u);
        EXPECT_NEAR(matterOf(*grids.density) / matterOf(set), 1, bound(kLeastParticleRadius));
    }
}

TEST(ParticleGrids, ManyParticlesKeepTheirMatterAndTheirBounds) {
    Draw draw(test::seed());
    const ParticleSet set = randomSet(draw, 500, 3, false);
    const BrickGrid grid = *gridsOf(set).density;
    // 0.1 % for each at most (above).
    EXPECT_NEAR(matterOf(grid) / matterOf(set), 1, 0.001);
    // Trilinear: nothing farther out than a cell's diagonal from the last voxel with matter in it.
    const double reach = std::sqrt(3.0) * voxelOf(grid);
    const dmat4 indexFromWorld = glm::inverse(grid.worldFromIndex);
    for (int i = 0; i < 20000; ++i) {
        const dvec3 at(draw.uniform(-5, 5), draw.uniform(-5, 5), draw.uniform(-5, 5));
        const bool far =
            std::all_of(set.particles.begin(), set.particles.end(), [&](const Particle& p) {
                return glm::length(at - dvec3(p.position)) > double(p.radius) + reach;
            });
        if (far) {
            EXPECT_EQ(grid.sample(dvec3(indexFromWorld * dvec4(at, 1))), 0);
        }
    }
    const Bounds bounds = grid.indexBounds().transformed(grid.worldFromIndex), balls = set.bounds();
    for (int axis = 0; axis < 3; ++axis) { // one brick and two voxels of room at most
        EXPECT_NEAR(bounds.minimum[axis], balls.minimum[axis], 3 * voxelOf(grid));
        EXPECT_NEAR(bounds.maximum[axis], balls.maximum[axis], (kBrickCells + 3) * voxelOf(grid));
    }
}

TEST(ParticleGrids, TheOrderChangesNoBitAndTwiceCountsTwice) {
    Draw draw(test::seed());
    ParticleSet set = randomSet(draw, 300, 1, true);
    const ParticleGrids grids = gridsOf(set);
    std::shuffle(set.particles.begin(), set.particles.end(), std::mt19937_64(test::seed()));
    const ParticleGrids shuffled = gridsOf(set);
    EXPECT_TRUE(sameBits(*grids.density, *shuffled.density));
    EXPECT_TRUE(sameBits(*grids.temperature, *shuffled.temperature));

    const std::vector<Particle> once = set.particles;
    set.particles.insert(set.particles.end(), once.begin(), once.end());
    const ParticleGrids twice = gridsOf(set);
    ASSERT_EQ(twice.density->samples.size(), grids.density->samples.size());
    for (size_t i = 0; i < grids.density->samples.size(); ++i) // sums round otherwise: an ulp
        EXPECT_NEAR(twice.density->samples[i], 2 * grids.density->samples[i],
                    3e-7f * grids.density->samples[i]);
}

TEST(ParticleGrids, MatterOfOneTemperatureHasItUpToItsEdge) {
    Draw draw(test::seed());
    ParticleSet set = randomSet(draw, 20, 1.5, true);
    for (Particle& p : set.particles) p.temperature = 1500;
    const ParticleGrids grids = gridsOf(set);
    const dmat4 indexFromWorld = glm::inverse(grids.density->worldFromIndex),
                heatFromWorld = glm::inverse(grids.temperature->worldFromIndex);
    int inside = 0;
    for (int i = 0; i < 50000; ++i) {
        const dvec4 at(draw.uniform(-2, 2), draw.uniform(-2, 2), draw.uniform(-2, 2), 1);
        if (!(grids.density->sample(dvec3(indexFromWorld * at)) > 0)) continue;
        ++inside;
        ASSERT_NEAR(grids.temperature->sample(dvec3(heatFromWorld * at)), 1500, 1e-3);
    }
    EXPECT_GT(inside, 5000);
}

TEST(ParticleGrids, MovedParticlesTakeTheirVoxelsAlong) {
    Draw draw(test::seed());
    ParticleSet set = randomSet(draw, 30, 1, false);
    for (Particle& p : set.particles) { // numbers without rounding
        p.radius = 1;
        p.position = glm::round(p.position * 64.0f) / 64.0f;
    }
    Medium medium;
    ASSERT_TRUE(setParticles(medium, std::make_shared<const ParticleSet>(set)).ok());
    EXPECT_EQ(medium.kind, MediumKind::Grid);
    const std::shared_ptr<const BrickGrid> before = medium.density;
    for (Particle& p : set.particles) p.position += vec3(2, -1, 0.5f); // whole voxels of 0.25 m
    ASSERT_TRUE(setParticles(medium, std::make_shared<const ParticleSet>(set)).ok());
    EXPECT_EQ(medium.density->samples, before->samples);
    EXPECT_EQ(dvec3(medium.density->worldFromIndex[3] - before->worldFromIndex[3]) +
                  voxelOf(*before) * dvec3(medium.density->origin - before->origin),
              dvec3(2, -1, 0.5));
    // What is refused changes nothing.
    const std::shared_ptr<const BrickGrid> kept = medium.density;
    set.particles[3].radius = -1;
    EXPECT_FALSE(setParticles(medium, std::make_shared<const ParticleSet>(set)).ok());
    EXPECT_EQ(medium.density, kept);
}

TEST(ParticleGrids, WhatDoesNotFitIsCoarserWithTheSameMatterAndSaysSo) {
    Draw draw(test::seed());
    const ParticleSet set = randomSet(draw, 400, 4, false);
    const double finest = voxelOf(*gridsOf(set).density);
    for (const ParticleGridLimits limits :
         {ParticleGridLimits{.voxels = 50'000}, ParticleGridLimits{.blocks = 200},
          ParticleGridLimits{.sums = 10'000}}) {
        const ParticleGrids grids = gridsOf(set, limits);
        EXPECT_GT(voxelOf(*grids.density), finest);
        ASSERT_EQ(grids.notes.size(), 2u);
        EXPECT_NE(grids.notes[0].find("which would take more memory or time than they may"),
                  std::string::npos);
        EXPECT_NE(grids.notes[1].find("of 400 particles are smaller than"), std::string::npos);
        // Bricks lie other than blocks, and so up to twice as many per axis have something in them.
        EXPECT_LE(grids.density->slotCount(), 8 * limits.voxels / 512);
        EXPECT_LE(grids.density->bricks.size(), 8 * limits.blocks);
        EXPECT_NEAR(matterOf(*grids.density) / matterOf(set), 1, 0.02); // as one of two voxels
    }
}

TEST(ParticleGrids, RefusesWhatIsNoParticle) {
    const float nan = std::numeric_limits<float>::quiet_NaN(),
                infinite = std::numeric_limits<float>::infinity();
    const auto refusal = [](const Particle& p) {
        const auto grids = makeParticleGrids({{Particle{{0, 0, 0}, 1, 1, 0}, p}, true});
        return grids.ok() ? std::string() : grids.message();
    };
    EXPECT_EQ(refusal({{0, 0, 0}, -1, 1, 0}),
              "particle 1 has the radius -1; it must be greater than 0");
    EXPECT_EQ(refusal({{0, 0, 0}, 1, -2, 0}),
              "particle 1 has the density -2; it must be finite and not negative");
    EXPECT_EQ(refusal({{0, 0, 0}, 1, 1, nan}),
              "particle 1 has the temperature nan; it must be finite and not negative");
    EXPECT_EQ(refusal({{0, nan, 0}, 1, 1, 0}), "particle 1 reaches beyond 1e30 metres");
    for (const Particle& p :
         {Particle{{0, 0, 0}, nan, 1, 0}, Particle{{0, 0, 0}, infinite, 1, 0},
          Particle{{0, 0, 0}, 0, 1, 0}, Particle{{0, 0, 0}, 1, nan, 0},
          Particle{{0, 0, 0}, 1, infinite, 0}, Particle{{2e30f, 0, 0}, 1, 1, 0}})
        EXPECT_FALSE(refusal(p).empty());
}

/// Hostile, but particles. Whatever comes out is finite, of bounded size, and of the same matter where `matter` is asked for.
void survives(const char* what, const ParticleSet& set, bool matter) {
    const ParticleGrids grids = gridsOf(set);
    const BrickGrid& grid = *grids.density;
    EXPECT_LE(grid.bricks.size(), size_t(1) << 22) << what;
    EXPECT_LE(grid.slotCount(), uint32_t(1) << 17) << what;
    for (const float sample : grid.samples)
        ASSERT_TRUE(sample >= 0 && sample <= 1e20f) << what << ": " << sample;
    for (int axis = 0; axis < 3; ++axis) EXPECT_GE(grid.worldFromIndex[axis][axis], 1e-9) << what;
    if (!matter) return;
    double sum = 0; // of slots' own voxels; shared faces once
    for (size_t slot = 0; slot < grid.slotCount(); ++slot)
        for (int z = 0; z < 8; ++z)
            for (int y = 0; y < 8; ++y)
                for (int x = 0; x < 8; ++x)
                    sum +=
                        double(grid.samples[slot * kBrickSampleCount + size_t(z * 81 + y * 9 + x)]);
    EXPECT_NEAR(sum * std::pow(voxelOf(grid), 3) / matterOf(set), 1, 0.02) << what;
}

TEST(ParticleGrids, HostileSetsGiveSaneGrids) {
    Draw draw(test::seed());
    const auto many = [&](int count, auto make) {
        ParticleSet set;
        for (int i = 0; i < count; ++i) set.particles.push_back(make(i));
        return set;
    };
    survives("none", {}, false);
    EXPECT_TRUE(gridsOf({}).density->bricks.empty());
    survives("no matter", many(9, [](int i) { return Particle{{i, 0, 0}, 1, 0, 0}; }), false);
    survives("one point", many(100'000, [](int) { return Particle{{1, 2, 3}, 0.1f, 1, 0}; }), true);
    survives("six decades",
             many(20'000,
                  [&](int) {
                      return Particle{
                          vec3(draw.uniform(-9, 9), draw.uniform(-9, 9), draw.uniform(-9, 9)),
                          float(std::pow(10.0, draw.uniform(-5, 1))), 1, 0};
                  }),
             true);
    survives("large over one another",
             many(20'000,
                  [&](int i) {
                      return Particle{{0, 0, 0}, i % 9 ? 1e3f : 1e-3f, 1, 0};
                  }),
             true);
    survives("on a line",
             many(20'000,
                  [](int i) {
                      return Particle{{i, 0, 0}, 0.01f, 1, 0};
                  }),
             true);
    survives("far apart",
             many(2,
                  [](int i) {
                      return Particle{{i ? 9e29f : -9e29f, 0, 0}, 1, 1, 0};
                  }),
             false); // so thin that it is nothing
    survives("far out", many(9, [](int) { return Particle{{1e20f, 0, 0}, 1e-6f, 1, 0}; }), false);
    survives("tiny", many(9, [](int) { return Particle{{0, 0, 0}, 1e-38f, 1, 0}; }), false);
    survives("dense beyond numbers",
             many(9,
                  [](int) {
                      return Particle{{0, 0, 0}, 1, 3e38f, 3e38f};
                  }),
             false);
}

TEST(ParticleGrids, AMillionParticlesTakeSeconds) {
    // CTest's limit of time would tell; here it is the size that is held.
    const Result<ParticleSet> cloud = generateParticles("cloud", 1'000'000, 1, 100);
    ASSERT_TRUE(cloud.ok());
    const ParticleGrids grids = gridsOf(*cloud);
    EXPECT_LT(voxelOf(*grids.density),
              0.6); // a quarter of 2.1 m, and a little more for want of room
    EXPECT_LT(grids.density->samples.size() * sizeof(float), size_t(160) << 20);
    EXPECT_NEAR(matterOf(*grids.density) / matterOf(*cloud), 1, 0.001);
}

} // namespace
} // namespace tyndall
