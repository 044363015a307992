#include "media/segment_integral.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include <glm/gtc/matrix_transform.hpp>

#include "core/check.h"
#include "media_dense_field.h"
#include "support/content.h"

namespace tyndall {
namespace {

using test::DenseField;
using test::Draw;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Midpoint rule with many steps: slow and obvious.
double quadrature(const std::function<double(double)>& f, double length, int steps = 400000) {
    double sum = 0;
    for (int i = 0; i < steps; ++i) sum += f((i + 0.5) / steps * length);
    return sum * length / steps;
}

double quadrature(const Medium& medium, const dmat4& worldFromMedium, const RaySegment& segment,
                  int steps = 400000) {
    return quadrature(
        [&](double t) {
            return mediumDensity(medium, worldFromMedium, segment.origin + t * segment.direction);
        },
        segment.length, steps);
}

/// Rotated, sheared, scaled unevenly and moved.
dmat4 generalTransform() {
    dmat4 shear(1.0);
    shear[1][0] = 0.3;
    const dmat4 rotation = glm::rotate(dmat4(1.0), 0.7, glm::normalize(dvec3(1, 2, 3)));
    return glm::translate(dmat4(1.0), dvec3(0.5, -1, 2)) * rotation * shear *
           glm::scale(dmat4(1.0), dvec3(0.5, 1.5, 0.8));
}

Medium mediumOf(MediumKind kind) {
    Medium medium;
    medium.kind = kind;
    medium.scattering = vec3(1, 2, 0);
    medium.absorption = vec3(0.5f, 0, 0);
    return medium;
}

RaySegment throughOrigin(Draw& draw, double length) {
    const dvec3 target(draw.uniform(-1, 1), draw.uniform(-1, 1), draw.uniform(-1, 1));
    const dvec3 direction = draw.unitVector();
    return {target - direction * draw.uniform(0, length), direction, length};
}

TEST(SegmentSource, IsTheIntegralOfTheAttenuatedSource) {
    for (const double sigma : {0.0, 1e-9, 1e-3, 0.7, 20.0}) {
        const double length = 2.5, source = 3;
        const double expected =
            quadrature([&](double t) { return source * std::exp(-sigma * t); }, length);
        EXPECT_NEAR(segmentSource(dvec3(source), dvec3(sigma), length).x / expected, 1, 1e-7)
            << sigma;
    }
}

TEST(SegmentSource, HasTheRightLimits) {
    EXPECT_EQ(segmentSource(dvec3(3), dvec3(0), 2).x, 6);
    EXPECT_DOUBLE_EQ(segmentSource(dvec3(3), dvec3(1e4), 10).x, 3e-4)
        << "opaque: source over extinction";
    EXPECT_DOUBLE_EQ(segmentSource(dvec3(3), dvec3(2), kInfinity).x, 1.5);
    EXPECT_EQ(segmentSource(dvec3(0), dvec3(0), kInfinity).x, 0);
    // Cutting a segment must not change what it gives.
    const double sigma = 1.3, whole = segmentSource(dvec3(1), dvec3(sigma), 3).x;
    const double parts = segmentSource(dvec3(1), dvec3(sigma), 1).x +
                         std::exp(-sigma) * segmentSource(dvec3(1), dvec3(sigma), 2).x;
    EXPECT_NEAR(whole, parts, 1e-15);
}

TEST(DensityLength, EverywhereIsTheLength) {
    const Medium medium = mediumOf(MediumKind::Everywhere);
    EXPECT_EQ(densityLength(medium, generalTransform(), {{1, 2, 3}, {1, 0, 0}, 7}), 7);
    const dvec3 depth = opticalDepth(medium, dmat4(1), {{0, 0, 0}, {1, 0, 0}, kInfinity});
    EXPECT_EQ(depth.x, kInfinity);
    EXPECT_EQ(depth.z, 0) << "no extinction, no depth, however far";
}

TEST(DensityLength, OfBoxAndEllipsoidMatchQuadrature) {
    Draw draw(test::seed());
    const dmat4 transform = generalTransform();
    for (const MediumKind kind : {MediumKind::Box, MediumKind::Sphere}) {
        Medium medium = mediumOf(kind);
        medium.size = {2, 1, 3};
        int hits = 0;
        for (int i = 0; i < 60; ++i) {
            RaySegment segment = throughOrigin(draw, draw.uniform(0.2, 6));
            segment.origin += dvec3(0.5, -1, 2);
            const double exact = densityLength(medium, transform, segment);
            EXPECT_NEAR(exact, quadrature(medium, transform, segment, 20000),
                        3.0 / 20000 * segment.length)
                << i;
            hits += exact > 0;
        }
        EXPECT_GT(hits, 20);
    }
}

TEST(DensityLength, OfSimpleShapesIsExact) {
    Medium box = mediumOf(MediumKind::Box);
    box.size = {2, 4, 6};
    const dmat4 moved = glm::translate(dmat4(1.0), dvec3(10, 0, 0));
    EXPECT_DOUBLE_EQ(densityLength(box, moved, {{0, 0, 0}, {1, 0, 0}, 100}), 2);
    EXPECT_DOUBLE_EQ(densityLength(box, moved, {{0, 0, 0}, {1, 0, 0}, 10}), 1) << "ends inside";
    EXPECT_DOUBLE_EQ(densityLength(box, moved, {{10, 0, 0}, {0, 0, -1}, kInfinity}), 3)
        << "begins inside";
    EXPECT_EQ(densityLength(box, moved, {{0, 0, 0}, {-1, 0, 0}, kInfinity}), 0) << "behind";
    Medium ball = mediumOf(MediumKind::Sphere);
    ball.size = dvec3(2);
    EXPECT_NEAR(densityLength(ball, moved, {{0, 0.6, 0}, {1, 0, 0}, kInfinity}), 1.6, 1e-14);
    EXPECT_EQ(densityLength(ball, moved, {{0, 1.001, 0}, {1, 0, 0}, kInfinity}), 0);
    EXPECT_NEAR(densityLength(ball, moved, {{-1e7, 0, 0}, {1, 0, 0}, kInfinity}), 2, 1e-8)
        << "from far away";
    EXPECT_THROW((void)densityLength(ball, moved, {{0, 0, 0}, {2, 0, 0}, 1}), CheckFailure);
}

TEST(DensityLength, OfHeightFogMatchesQuadratureAndItsLimits) {
    Draw draw(test::seed() + 1);
    Medium fog = mediumOf(MediumKind::Height);
    fog.scaleHeight = 0.8;
    const dmat4 transform = glm::translate(dmat4(1.0), dvec3(0, 3, 0)) *
                            glm::rotate(dmat4(1.0), 0.4, dvec3(0, 0, 1)) *
                            glm::scale(dmat4(1.0), dvec3(5, 0.1, 2));
    for (int i = 0; i < 60; ++i) {
        RaySegment segment = throughOrigin(draw, draw.uniform(0.2, 6));
        segment.origin.y += 3;
        if (i % 10 == 0)
            segment.direction = glm::normalize(dvec3(transform[0])); // along the layers
        EXPECT_NEAR(densityLength(fog, transform, segment),
                    quadrature(fog, transform, segment, 40000), 2e-5 * segment.length)
            << i;
    }
    const dmat4 plain(1);
    EXPECT_NEAR(densityLength(fog, plain, {{0, 0, 0}, {0, 1, 0}, kInfinity}), 0.8, 1e-15)
        << "straight up: one scale height";
    EXPECT_NEAR(densityLength(fog, plain, {{0, 1.6, 0}, {0, 1, 0}, kInfinity}),
                0.8 * std::exp(-2.0), 1e-15);
    EXPECT_NEAR(densityLength(fog, plain, {{0, 1.6, 0}, {0, -1, 0}, 2.6}),
                0.8 * (1 - std::exp(-2.0)) + 1, 1e-14)
        << "down into the full layer";
    EXPECT_NEAR(densityLength(fog, plain, {{0, -2, 0}, {0, 1, 0}, kInfinity}), 2.8, 1e-14)
        << "up out of the full layer";
    EXPECT_EQ(densityLength(fog, plain, {{0, -2, 0}, {1, 0, 0}, 50}), 50);
    EXPECT_EQ(densityLength(fog, plain, {{0, 5, 0}, {0, -1, 0}, kInfinity}), kInfinity);
    // Nearly level: the closed form must approach the level ray's without cancelling.
    const double slope = 1e-9;
    EXPECT_NEAR(
        densityLength(fog, plain, {{0, 1, 0}, {std::sqrt(1 - slope * slope), slope, 0}, 10}),
        10 * std::exp(-1 / 0.8), 1e-7);
}

TEST(IntegrateGrid, OfAFieldThatIsLinearIsTheMeanOfItsEnds) {
    DenseField field({0, 0, 0}, {20, 20, 20});
    const dvec3 slope(0.1, 0.25, 0.4);
    for (int z = 0; z < 20; ++z)
        for (int y = 0; y < 20; ++y)
            for (int x = 0; x < 20; ++x)
                field.at({x, y, z}) = float(glm::dot(slope, dvec3(x, y, z)));
    const dmat4 transform = generalTransform();
    const BrickGrid grid = makeBrickGrid(field.voxels, field.first, field.size, transform);
    Draw draw(test::seed() + 2);
    for (int i = 0; i < 100; ++i) {
        const auto inside = [&] {
            return dvec3(draw.uniform(0, 19), draw.uniform(0, 19), draw.uniform(0, 19));
        };
        const dvec3 a = inside(), b = inside();
        const dvec3 worldA = dvec3(transform * dvec4(a, 1)),
                    worldB = dvec3(transform * dvec4(b, 1));
        const double length = glm::length(worldB - worldA);
        const double expected = length * 0.5 * (glm::dot(slope, a) + glm::dot(slope, b));
        // The voxels are single precision; nothing else is.
        EXPECT_NEAR(integrateGrid(grid, transform, {worldA, (worldB - worldA) / length, length}) /
                        expected,
                    1, 1e-6);
    }
}

TEST(IntegrateGrid, MatchesQuadratureOfTheDenseArrayUnderAnyTransform) {
    Draw draw(test::seed() + 3);
    DenseField field({-4, 10, 3}, {14, 11, 19});
    for (float& voxel : field.voxels)
        voxel = draw.uniform() < 0.5 ? 0.0f : float(draw.uniform(0, 4));
    dmat4 mirrored = generalTransform();
    mirrored[0] = -mirrored[0];
    for (const dmat4& transform : {dmat4(1), generalTransform(), mirrored}) {
        const BrickGrid grid = makeBrickGrid(field.voxels, field.first, field.size, transform);
        const dmat4 inverse = glm::inverse(transform);
        for (int i = 0; i < 12; ++i) {
            const dvec3 through =
                dvec3(field.first) +
                dvec3(field.size) * dvec3(draw.uniform(), draw.uniform(), draw.uniform());
            const dvec3 direction = i < 3 ? dvec3(i == 0, i == 1, i == 2) : draw.unitVector();
            const RaySegment segment{dvec3(transform * dvec4(through, 1)) - 15.0 * direction,
                                     direction, 30};
            const double expected = quadrature(
                [&](double t) {
                    return field.trilinear(
                        dvec3(inverse * dvec4(segment.origin + t * direction, 1)));
                },
                30);
            EXPECT_NEAR(integrateGrid(grid, transform, segment), expected, 1e-6 * (1 + expected))
                << i;
        }
    }
}

TEST(IntegrateGrid, AlongVoxelsAndThroughCornersIsExact) {
    DenseField field({0, 0, 0}, {9, 9, 9});
    std::fill(field.voxels.begin(), field.voxels.end(), 1.0f);
    const BrickGrid grid = makeBrickGrid(field.voxels, field.first, field.size, dmat4(1));
    // 8 cells of 1 and a ramp of half a voxel's worth at each end.
    EXPECT_NEAR(integrateGrid(grid, dmat4(1), {{-10, 4, 4}, {1, 0, 0}, kInfinity}), 9, 1e-12);
    EXPECT_NEAR(integrateGrid(grid, dmat4(1), {{20, 4.5, 4}, {-1, 0, 0}, kInfinity}), 9, 1e-12);
    // The diagonal crosses three planes at once; in the corner cells the field is s³: √3·(8 + 2/4).
    const dvec3 diagonal = glm::normalize(dvec3(1));
    EXPECT_NEAR(integrateGrid(grid, dmat4(1), {dvec3(-5), diagonal, kInfinity}),
                std::sqrt(3.0) * 8.5, 1e-12);
    EXPECT_EQ(integrateGrid(grid, dmat4(1), {{-10, 40, 4}, {1, 0, 0}, kInfinity}), 0);
    EXPECT_EQ(integrateGrid(BrickGrid{}, dmat4(1), {{0, 0, 0}, {1, 0, 0}, 5}), 0);
}

TEST(IntegrateGrid, OfAConstantGridEqualsTheBoxInside) {
    DenseField field({0, 0, 0}, {33, 33, 33});
    std::fill(field.voxels.begin(), field.voxels.end(), 1.0f);
    Medium grid = mediumOf(MediumKind::Grid);
    grid.density = std::make_shared<BrickGrid>(
        makeBrickGrid(field.voxels, field.first, field.size, generalTransform()));
    const dmat4 node = glm::scale(
        dmat4(1.0), dvec3(1e-3)); // depth is per metre of the world, whatever the node's scale
    const dvec3 a = dvec3(node * generalTransform() * dvec4(3, 4, 5, 1)),
                b = dvec3(node * generalTransform() * dvec4(30, 20, 25, 1));
    const double length = glm::length(b - a);
    EXPECT_NEAR(opticalDepth(grid, node, {a, (b - a) / length, length}).x / (1.5 * length), 1,
                1e-12);
    EXPECT_DOUBLE_EQ(mediumDensity(grid, node, a), 1);
}

} // namespace
} // namespace tyndall
