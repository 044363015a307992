// Where lattices lie: a property of the scene, but for those that follow the eye.

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "support/content.h"
#include "volumetric_gi/lpv/lattice_placement.h"

namespace tyndall::test {
namespace {

using volumetric_gi::LatticeLevel;
using volumetric_gi::placeLattices;
using volumetric_gi::PlacementRequest;

PlacementRequest hall() {
    PlacementRequest request;
    request.bounds = request.content = {dvec3(-6, 0, -12), dvec3(6, 7, 12)};
    request.eye = dvec3(1, 2, 3);
    return request;
}

bool contains(const Bounds& outer, const Bounds& inner, double slack) {
    return glm::all(glm::lessThanEqual(outer.minimum - slack, inner.minimum)) &&
           glm::all(glm::greaterThanEqual(outer.maximum + slack, inner.maximum));
}

TEST(LatticePlacement, OneAroundAScene) {
    const PlacementRequest request = hall();
    const auto levels = placeLattices(request);
    ASSERT_EQ(levels.size(), 1u);
    EXPECT_TRUE(contains(levels[0].box(), request.bounds, 0));
    EXPECT_NEAR(double(levels[0].params.grid.lowest.w), 24.0 / 30, 1e-6);
    EXPECT_EQ(ivec3(levels[0].params.grid.size), ivec3(17, 11, 32));
    EXPECT_EQ(levels[0].params.grid.place.z, 0) << "nothing is beyond it";
}

TEST(LatticePlacement, LandscapesGetCoarserOnes) {
    PlacementRequest request;
    request.bounds = {dvec3(-10000, 0, -10000), dvec3(10000, 900, 10000)};
    request.content = {dvec3(-500, 500, -1400), dvec3(500, 900, -400)};
    request.eye = dvec3(0, 40, 300);
    for (const int most : {1, 2, 3, 4}) {
        request.most = most;
        const auto levels = placeLattices(request);
        ASSERT_EQ(levels.size(), size_t(most));
        EXPECT_TRUE(contains(levels.back().box(), request.content, 1));
        for (size_t i = 1; i < levels.size(); ++i) {
            EXPECT_TRUE(contains(levels[i - 1].box(), levels[i].box(), 1e-2));
            const double ratio =
                double(levels[i - 1].params.grid.lowest.w) / double(levels[i].params.grid.lowest.w);
            EXPECT_NEAR(ratio, std::round(ratio), 1e-4);
            EXPECT_LE(ratio, 4);
            EXPECT_FALSE(levels[i - 1].covered);
        }
    }
    EXPECT_TRUE(contains(placeLattices(request)[0].box(), request.bounds, 0));
}

TEST(LatticePlacement, FollowsTheEyeInWholeCellsOfTheNext) {
    PlacementRequest request = hall();
    request.extent = 6;
    request.most = 3;
    std::mt19937 random{uint32_t(seed())};
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto still = placeLattices(request);
    ASSERT_EQ(still.size(), 3u);
    int moved = 0;
    for (int i = 0; i < 200; ++i) {
        request.eye = {6 * unit(random), 3.5 + 3.5 * unit(random), 12 * unit(random)};
        request.forward =
            glm::normalize(dvec3(unit(random), 0.2 * unit(random), unit(random)) + 1e-9);
        const auto levels = placeLattices(request);
        for (size_t k = 0; k < levels.size(); ++k) {
            EXPECT_EQ(levels[k].params.grid.size, still[k].params.grid.size)
                << "a lattice keeps its size";
            if (k == 0) {
                EXPECT_EQ(levels[0].key, still[0].key) << "what spans the scene stands still";
                continue;
            }
            const double step = double(levels[k - 1].params.grid.lowest.w);
            const dvec3 steps =
                dvec3(vec3(levels[k].params.grid.lowest) - vec3(levels[k - 1].params.grid.lowest)) /
                step;
            for (int axis = 0; axis < 3; ++axis) {
                if ((levels[k].params.grid.place.z >> axis & 1) == 0) continue;
                EXPECT_NEAR(steps[axis], std::round(steps[axis]), 1e-3);
            }
            EXPECT_TRUE(contains(levels[k - 1].box(), levels[k].box(), 1e-3));
            moved += levels[k].key != still[k].key;
        }
    }
    EXPECT_GT(moved, 100);
    // A step of the eye that is far smaller than a cell moves no lattice, but at a few places.
    int jumps = 0;
    for (int i = 0; i < 1000; ++i) {
        request.forward = {0, 0, -1};
        request.eye = {0, 2, -6 + 0.012 * i};
        const uint64_t before = placeLattices(request).back().key;
        request.eye.z += 0.012;
        jumps += placeLattices(request).back().key != before;
    }
    EXPECT_GT(jumps, 5);
    EXPECT_LT(jumps, 60) << "12 m in cells of 0.4 m";
}

TEST(LatticePlacement, AnyBoxHasItsLattices) {
    std::mt19937 random{uint32_t(seed())};
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < 2000; ++i) {
        PlacementRequest request;
        for (int axis = 0; axis < 3; ++axis) {
            const double size = unit(random) < 0.1 ? 0 : std::pow(10, 8 * unit(random) - 3);
            request.bounds.minimum[axis] = 1e3 * (unit(random) - 0.5);
            request.bounds.maximum[axis] = request.bounds.minimum[axis] + size;
            request.content.minimum[axis] = request.bounds.minimum[axis] + 0.3 * size;
            request.content.maximum[axis] =
                request.bounds.maximum[axis] - 0.3 * size * unit(random);
            request.eye[axis] = 1e5 * (unit(random) - 0.5);
        }
        request.resolution = 4 + int(60 * unit(random));
        request.most = 1 + int(4 * unit(random)) % 4;
        request.extent = unit(random) < 0.5 ? 0 : std::pow(10, 9 * unit(random) - 3);
        const auto levels = placeLattices(request);
        ASSERT_FALSE(levels.empty());
        ASSERT_LE(levels.size(), size_t(request.most));
        for (const LatticeLevel& level : levels) {
            const gpu::LpvGrid& grid = level.params.grid;
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_GE(grid.size[axis], 2);
                EXPECT_LE(grid.size[axis], request.resolution + 4);
                EXPECT_TRUE(std::isfinite(grid.lowest[axis]));
            }
            EXPECT_GT(grid.lowest.w, 0);
        }
    }
}

} // namespace
} // namespace tyndall::test
