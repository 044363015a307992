// How triangles become patches of surfels: no area is lost or made, sizes are as wanted, and
// what does not change stays.

#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <tuple>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "volumetric_gi/surfels/surfel_patches.h"

namespace tyndall::test {
namespace {

using namespace volumetric_gi;

constexpr uint32_t kMost = 1u << 20;
constexpr uint32_t kSeeds = 200;

using Corners = std::vector<dvec3>;

double areaOf(const Corners& corners) {
    double sum = 0;
    for (size_t i = 0; i + 2 < corners.size(); i += 3)
        sum +=
            0.5 * glm::length(glm::cross(corners[i + 1] - corners[i], corners[i + 2] - corners[i]));
    return sum;
}

double areaOf(const SurfelPlan& plan) {
    double sum = 0;
    for (const gpu::SurfelPatch& patch : plan.patches) sum += double(patch.area);
    return sum;
}

SurfelPlan planOf(const Corners& corners, const SurfelSize& size, uint32_t most = kMost,
                  uint64_t seed = 0) {
    const SurfelTriangles triangles{corners, 0};
    return planSurfels(std::span(&triangles, 1), size, most, seed);
}

/// The same size everywhere.
SurfelSize even(double size) {
    SurfelSize result;
    result.least = size;
    return result;
}

SurfelSize seenFrom(const dvec3& eye, double perDistance, double least = 0) {
    SurfelSize result;
    result.eye = eye;
    result.perDistance = perDistance;
    result.least = least;
    return result;
}

/// Square of `side` metres in the plane y = 0, of 2·n² triangles.
Corners gridOf(double side, int n) {
    Corners corners;
    const auto at = [&](int x, int z) {
        return dvec3(side * x / n, 0, side * z / n) - dvec3(side / 2, 0, side / 2);
    };
    for (int z = 0; z < n; ++z)
        for (int x = 0; x < n; ++x)
            for (const dvec3& corner : {at(x, z), at(x + 1, z), at(x, z + 1), at(x + 1, z),
                                        at(x + 1, z + 1), at(x, z + 1)})
                corners.push_back(corner);
    return corners;
}

/// A patch's corners in space.
std::array<dvec3, 3> cornersOf(const gpu::SurfelPatch& patch, const Corners& corners) {
    const size_t first = size_t(patch.triangle) * 3;
    const auto at = [&](double b, double c) {
        return corners[first] + b * (corners[first + 1] - corners[first]) +
               c * (corners[first + 2] - corners[first]);
    };
    return {at(double(patch.corners.x), double(patch.corners.y)),
            at(double(patch.corners.z), double(patch.corners.w)),
            at(double(patch.lastCorner.x), double(patch.lastCorner.y))};
}

double areaOf(const std::array<dvec3, 3>& c) { return areaOf(Corners(c.begin(), c.end())); }

/// What SurfelSize says, once more.
double wantedSize(const SurfelSize& size, const dvec3& position) {
    double result = std::max(size.perDistance * glm::distance(position, size.eye), size.least);
    if (!size.media.empty())
        result =
            std::max(result, size.perMediumDistance *
                                 glm::distance(position, glm::clamp(position, size.media.minimum,
                                                                    size.media.maximum)));
    return size.scale * result;
}

/// Mean area of plans with chances of their own, over the triangles' area.
double meanArea(const Corners& corners, const SurfelSize& size, uint32_t seeds = kSeeds) {
    double sum = 0;
    for (uint32_t seed = 0; seed < seeds; ++seed) sum += areaOf(planOf(corners, size, kMost, seed));
    return sum / seeds / areaOf(corners);
}

void expectWellFormed(const SurfelPlan& plan, uint32_t most) {
    uint32_t sum = 0, inSets = 0;
    for (const gpu::SurfelPatch& patch : plan.patches) {
        EXPECT_EQ(patch.firstSurfel, sum);
        EXPECT_GE(patch.level, 1u);
        EXPECT_LE(patch.level, gpu::kSurfelMostLevel);
        EXPECT_GT(patch.area, 0);
        EXPECT_TRUE(std::isfinite(patch.area));
        sum += surfelsOfLevel(patch.level);
    }
    EXPECT_EQ(plan.surfels, sum);
    EXPECT_LE(plan.surfels, most);
    for (const SurfelPlan::Set& set : plan.sets) {
        EXPECT_EQ(set.firstPatch, inSets);
        EXPECT_GT(set.patches, 0u);
        inSets += set.patches;
        ASSERT_LE(inSets, plan.patches.size());
        EXPECT_EQ(set.firstSurfel, plan.patches[set.firstPatch].firstSurfel);
        EXPECT_EQ(set.firstSurfel + set.surfels,
                  inSets < plan.patches.size() ? plan.patches[inSets].firstSurfel : plan.surfels);
    }
    EXPECT_EQ(inSets, plan.patches.size());
}

TEST(SurfelPatches, ALevelHasAsManySurfelsAsTheTessellatorHasPoints) {
    // Concentric triangles of n, n - 2, … segments an edge; the last is a point where n is
    // even (OpenGL 4.5, section 11.2.2.2).
    for (uint32_t n = 1; n <= 64; ++n) {
        uint32_t points = 0;
        for (int segments = int(n); segments >= 0; segments -= 2)
            points += segments == 0 ? 1u : 3u * uint32_t(segments);
        EXPECT_EQ(surfelsOfLevel(n), points) << n;
    }
}

TEST(SurfelPatches, AreasSumToTheTriangles) {
    // Pieces of one size, each of more than three surfels, which no chance leaves out.
    const Corners ordinary = {{0, 0, 0}, {2, 0, 0.5}, {0.3, 1, 1}, {5, 1, 2}, {4, 3, 1}, {6, 2, 7}};
    for (const double size : {0.01, 0.03, 0.1, 0.25}) {
        const SurfelPlan plan = planOf(ordinary, even(size));
        EXPECT_NEAR(areaOf(plan) / areaOf(ordinary), 1, 1e-5) << size;
        // And the patches tile the triangles: by their corners they have the same area.
        double byCorners = 0;
        for (const gpu::SurfelPatch& patch : plan.patches) {
            const double area = areaOf(cornersOf(patch, ordinary));
            EXPECT_NEAR(area / double(patch.area), 1, 1e-3); // corners have 24 bits of places
            byCorners += area;
        }
        EXPECT_NEAR(byCorners / areaOf(ordinary), 1, 1e-5) << size;
        expectWellFormed(plan, kMost);
    }
}

TEST(SurfelPatches, TinyTrianglesHaveTheirAreaInTheMean) {
    const Corners tiny = gridOf(10, 50); // 5000 of 0.02 m²; surfels of 0.04, 0.25 and 1 m²
    for (const double size : {0.2, 0.5, 1.0}) {
        const double mean = meanArea(tiny, even(size));
        printf("surfels of %.1f m: %.5f of the area\n", size, mean);
        // With chances of 0.17 to 0.007 a plan's area varies by 0.03 to 0.17: over 200
        // seeds by 0.002 to 0.012.
        EXPECT_NEAR(mean, 1, size > 0.6 ? 0.03 : 0.01) << size;
        expectWellFormed(planOf(tiny, even(size)), kMost);
    }
    // Plans are of another chance each, and a single one is not far off.
    const double one = areaOf(planOf(tiny, even(0.2), kMost, 1)),
                 other = areaOf(planOf(tiny, even(0.2), kMost, 2));
    EXPECT_NE(one, other);
    EXPECT_NEAR(one / areaOf(tiny), 1, 0.15);
}

TEST(SurfelPatches, ThinTrianglesHaveTheirAreaInTheMean) {
    // 10 m by 1 mm, in three directions, seen from where sizes change along it.
    const Corners thin = {{0, 0, 0},     {10, 0, 0}, {5, 0.001, 0}, {1, 1, 1}, {5, 9, 3},
                          {5, 9.001, 3}, {0, 0, 0},  {0, 0.001, 0}, {0, 0, 10}};
    for (const SurfelSize& size : {even(0.002), even(0.0005), seenFrom({3, 1, 0}, 0.001)}) {
        const double mean = meanArea(thin, size);
        printf("%.5f of the area\n", mean);
        EXPECT_NEAR(mean, 1, 0.01);
        expectWellFormed(planOf(thin, size), kMost);
    }
}

TEST(SurfelPatches, AHugeTriangleHasItsAreaInTheMean) {
    const Corners huge = {{-500, 0, -300}, {500, 0, -300}, {0, 0, 700}};
    const SurfelSize size = seenFrom({3, 1, 5}, 0.05, 1e-3);
    const double mean = meanArea(huge, size, 50);
    printf("%.6f of the area\n", mean);
    EXPECT_NEAR(mean, 1, 0.01);
    const SurfelPlan plan = planOf(huge, size);
    expectWellFormed(plan, kMost);
    EXPECT_EQ(plan.scale, 1);
    // Right below the eye surfels are as small as wanted, 5 cm.
    double nearest = 1e30;
    for (const gpu::SurfelPatch& patch : plan.patches) {
        const auto c = cornersOf(patch, huge);
        if (glm::distance((c[0] + c[1] + c[2]) / 3.0, dvec3(3, 0, 5)) < 1)
            nearest =
                std::min(nearest, std::sqrt(double(patch.area) / surfelsOfLevel(patch.level)));
    }
    EXPECT_LT(nearest, 0.1);
    EXPECT_GT(nearest, 0.03);
}

TEST(SurfelPatches, DegenerateTrianglesAreCountedAndAddNothing) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN(),
                     kInf = std::numeric_limits<double>::infinity();
    const Corners good = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}};
    Corners corners = {{1, 2, 3},    {1, 2, 3},        {1, 2, 3},    {0, 0, 0}, {1, 1, 1},
                       {2, 2, 2},    {kNan, 0, 0},     {1, 0, 0},    {0, 1, 0}, {0, 0, 0},
                       {1, 0, 0},    {0, kNan, 1},     {kInf, 0, 0}, {1, 0, 0}, {0, 1, 0},
                       {0, 0, 0},    {-kInf, kInf, 0}, {0, 1, 0},    {0, 0, 0}, {1e200, 0, 0},
                       {0, 1e200, 0}}; // the area is not finite
    const uint32_t bad = uint32_t(corners.size() / 3);
    for (const SurfelSize& size : {even(0.1), seenFrom({0, 1, 0}, 0.01, 1e-6)}) {
        const SurfelPlan none = planOf(corners, size);
        EXPECT_EQ(none.degenerate, bad);
        EXPECT_TRUE(none.patches.empty());
        EXPECT_TRUE(none.sets.empty());
        EXPECT_EQ(none.surfels, 0u);
        Corners all = corners;
        all.insert(all.end(), good.begin(), good.end());
        const SurfelPlan one = planOf(all, size);
        EXPECT_EQ(one.degenerate, bad);
        EXPECT_NEAR(areaOf(one), 0.5, 0.05);
        for (const gpu::SurfelPatch& patch : one.patches) EXPECT_EQ(patch.triangle, bad);
        expectWellFormed(one, kMost);
    }
}

TEST(SurfelPatches, NothingMakesAPlanEndless) {
    // Out of proportion, but finite: large, next to nothing wide, and with the eye on it. A
    // plan has an end and few enough surfels.
    const Corners extreme[] = {{{0, 0, 0}, {1e15, 0, 0}, {0, 0, 1e15}},
                               {{0, 0, 0}, {1e6, 0, 0}, {0, 1e-9, 0}},
                               {{0, 0, 0}, {1e-30, 0, 0}, {0, 1e-30, 0}},
                               {{-1, 0, -1}, {2, 0, -1}, {-1, 0, 2}}};
    for (const Corners& corners : extreme)
        for (const uint32_t most : {64u, 4096u}) {
            const SurfelPlan plan = planOf(corners, seenFrom({0, 0, 0}, 0.01, 1e-4), most);
            expectWellFormed(plan, most);
            EXPECT_GE(plan.scale, 1);
        }
}

TEST(SurfelPatches, ThereAreNeverMoreSurfelsThanAllowed) {
    Corners room = gridOf(10, 4);
    const Corners floor = gridOf(100, 60);
    room.insert(room.end(), floor.begin(), floor.end());
    for (const uint32_t most : {64u, 100u, 1000u, 8192u, 65536u}) {
        const SurfelPlan plan = planOf(room, seenFrom({0, 2, 0}, 0.005, 1e-3), most);
        expectWellFormed(plan, most);
        EXPECT_GT(plan.surfels, 0u) << most;
        EXPECT_GT(plan.scale, 1) << most;
        // Sizes grow in steps of 2^(1/4), so no fewer than some 1/√2 of what is allowed;
        // and a set of chances is not another.
        if (most >= 1000) {
            EXPECT_GT(double(plan.surfels), 0.5 * most) << most;
        }
    }
}

TEST(SurfelPatches, DensityIsAsWanted) {
    SurfelSize byMedia = seenFrom({1, 2, 1}, 0.02, 0.01);
    byMedia.media.include({-1, 0, -1});
    byMedia.media.include({1, 1, 1});
    byMedia.perMediumDistance = 0.1;
    SurfelSize scaled = seenFrom({1, 2, 1}, 0.02, 0.01);
    scaled.scale = 3;
    const Corners floor = gridOf(100, 3), fine = gridOf(20, 40);
    for (const SurfelSize& size : {even(0.3), seenFrom({1, 0.5, 2}, 0.02, 1e-3), byMedia, scaled})
        for (const Corners* corners : {&floor, &fine})
            for (const uint32_t most : {kMost, 3000u}) {
                const SurfelPlan plan = planOf(*corners, size, most);
                ASSERT_GT(plan.patches.size(), 20u);
                double worst = 1;
                for (const gpu::SurfelPatch& patch : plan.patches) {
                    const auto c = cornersOf(patch, *corners);
                    const double side = plan.scale * wantedSize(size, (c[0] + c[1] + c[2]) / 3.0);
                    const double ratio =
                        surfelsOfLevel(patch.level) * side * side / double(patch.area);
                    worst = std::max({worst, ratio, 1 / ratio});
                }
                EXPECT_LT(worst, 2);
            }
}

TEST(SurfelPatches, SizesAreAlikeInAPatchAndItsSurfelsAreNotStretched) {
    const Corners floor = gridOf(1000, 1), strip = {{0, 0, 0}, {10, 0, 0}, {4, 0, 0.1}};
    const std::pair<const Corners*, SurfelSize> cases[] = {
        {&floor, seenFrom({1, 0.5, 2}, 0.02, 1e-3)},
        {&floor, seenFrom({1, 0.5, 2}, 0.15, 1e-3)},
        {&strip, even(0.03)},
        {&strip, seenFrom({2, 1, 0}, 0.01)}};
    for (const auto& [corners, size] : cases) {
        int compared = 0;
        for (const gpu::SurfelPatch& patch : planOf(*corners, size).patches) {
            const auto c = cornersOf(patch, *corners);
            const double middle = wantedSize(size, (c[0] + c[1] + c[2]) / 3.0);
            if (areaOf(c) <= 3 * middle * middle)
                continue; // the fewest that a patch has: it stays as it is
            ++compared;
            for (size_t i = 0; i < 3; ++i) {
                EXPECT_LT(wantedSize(size, c[i]) / middle,
                          2.001); // as places are rounded to 24 bits
                EXPECT_GT(wantedSize(size, c[i]) / middle, 0.499);
                // Level n has n steps along an edge.
                EXPECT_LE(glm::distance(c[i], c[(i + 1) % 3]), 3.001 * middle * (patch.level + 1));
            }
        }
        EXPECT_GT(compared, 10);
    }
}

bool same(const gpu::SurfelPatch& a, const gpu::SurfelPatch& b) {
    return a.corners == b.corners && a.lastCorner == b.lastCorner && a.triangle == b.triangle &&
           a.level == b.level && a.area == b.area && a.firstSurfel == b.firstSurfel;
}

TEST(SurfelPatches, TheSamePlanTwiceIsTheSame) {
    const Corners floor = gridOf(100, 60);
    const SurfelSize size = seenFrom({1, 0.5, 2}, 0.03, 1e-3);
    const SurfelPlan one = planOf(floor, size, 5000, 7), other = planOf(floor, size, 5000, 7);
    ASSERT_GT(one.patches.size(), 100u);
    ASSERT_EQ(one.patches.size(), other.patches.size());
    for (size_t i = 0; i < one.patches.size(); ++i)
        EXPECT_TRUE(same(one.patches[i], other.patches[i])) << i;
    EXPECT_EQ(one.scale, other.scale);
    // Objects have chances of their own, and an object's do not follow from what lies before it.
    const SurfelTriangles two[] = {{floor, 3}, {floor, 4}}, alone[] = {{floor, 4}};
    const SurfelPlan both = planSurfels(two, size, kMost, 7),
                     second = planSurfels(alone, size, kMost, 7);
    ASSERT_EQ(both.sets.size(), 2u);
    expectWellFormed(both, kMost);
    EXPECT_EQ(both.sets[0].set, 3u);
    ASSERT_EQ(both.sets[1].patches, second.patches.size());
    for (size_t i = 0; i < second.patches.size(); ++i) {
        gpu::SurfelPatch patch = both.patches[both.sets[1].firstPatch + i];
        patch.firstSurfel -= both.sets[1].firstSurfel;
        EXPECT_TRUE(same(patch, second.patches[i])) << i;
    }
    EXPECT_NE(both.sets[0].patches, both.sets[1].patches) << "the same choice in both";
}

TEST(SurfelPatches, ASmallStepOfTheCameraKeepsPatches) {
    using Key = std::tuple<uint32_t, float, float, float, float, float, float>;
    const auto keys = [](const SurfelPlan& plan) {
        std::set<Key> all;
        for (const gpu::SurfelPatch& p : plan.patches)
            all.insert({p.triangle, p.corners.x, p.corners.y, p.corners.z, p.corners.w,
                        p.lastCorner.x, p.lastCorner.y});
        EXPECT_EQ(all.size(), plan.patches.size()) << "a patch twice";
        return all;
    };
    Corners strips = gridOf(20, 20); // of 1 m by 1 cm, which are cut and left out by chance
    for (dvec3& corner : strips) corner.z *= 0.01;
    for (const Corners& floor : {gridOf(20, 2), gridOf(20, 200), strips}) {
        const auto before = keys(planOf(floor, seenFrom({0, 2, 0}, 0.02, 1e-3))),
                   after = keys(planOf(floor, seenFrom({0.001, 2, 0}, 0.02, 1e-3)));
        size_t kept = 0;
        for (const Key& key : before) kept += after.count(key);
        printf("%zu of %zu patches are kept\n", kept, before.size());
        ASSERT_GT(before.size(), 200u);
        EXPECT_GE(double(kept), 0.9 * double(before.size()));
    }
}

} // namespace
} // namespace tyndall::test
