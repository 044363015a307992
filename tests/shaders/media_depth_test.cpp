// Optical depth of every kind of medium along random rays against integration in double precision.
#include <algorithm>
#include <cmath>
#include <random>

#include <glm/gtc/matrix_transform.hpp>

#include "gl/gl_fixture.h"
#include "media/segment_integral.h"
#include "plugin/shader_rounds.h"
#include "renderer/media_placement.h"
#include "shaders/media_compute.h"
#include "support/content.h"

namespace tyndall::test {
namespace {

using MediaDepth = GlTest;
TYNDALL_GL_TESTS(MediaDepth);

struct RandomRays {
    explicit RandomRays(uint64_t s) : engine(s) {}
    double uniform(double a, double b) {
        return std::uniform_real_distribution<double>(a, b)(engine);
    }
    dvec3 point(double r) { return {uniform(-r, r), uniform(-r, r), uniform(-r, r)}; }
    dvec3 direction() {
        const double z = uniform(-1, 1), a = uniform(0, 2 * kPi), s = std::sqrt(1 - z * z);
        return {s * std::cos(a), s * std::sin(a), z};
    }
    std::mt19937_64 engine;
};

const char* const kBody = "vec4 a = inputs[2u * id]; vec4 b = inputs[2u * id + 1u];"
                          "outputs[id] = vec4(opticalDepthAlong(a.xyz, b.xyz, a.w), 0);";

/// The rays as single precision sees them: both sides then integrate along the very same line.
struct Rays {
    std::vector<vec4> inputs;
    void add(const dvec3& origin, const dvec3& direction, double length) {
        inputs.emplace_back(vec3(origin), float(length));
        inputs.emplace_back(vec3(direction), 0);
    }
    [[nodiscard]] size_t count() const { return inputs.size() / 2; }
    [[nodiscard]] RaySegment segment(size_t i) const {
        return {dvec3(inputs[2 * i]), glm::normalize(dvec3(inputs[2 * i + 1])),
                double(inputs[2 * i].w)};
    }
};

Rays randomRays(double spread, int count, uint64_t seed) {
    RandomRays random(seed);
    Rays rays;
    for (int i = 0; i < count; ++i)
        rays.add(random.point(spread), random.direction(),
                 i % 4 == 0 ? 1e30 : random.uniform(0, 3 * spread));
    // Along the axes, through the centre and along faces; of no length.
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0}) {
            dvec3 d(0);
            d[axis] = sign;
            rays.add(dvec3(0.1, 0.2, 0.3), d, 1e30);
            rays.add(-2.0 * spread * d, d, 5 * spread);
            rays.add(dvec3(0), d, 0);
        }
    return rays;
}

void expectDepths(const Medium& medium, const dmat4& worldFromNode, const Rays& rays,
                  double relative, double absolute, const MediaOptions& options = {}) {
    const Scene scene = sceneOf(std::span(&medium, 1), std::span(&worldFromNode, 1));
    gl::ShaderLibrary library;
    MediaCompute compute(scene, options);
    ASSERT_EQ(compute.placed().size(), 1u);
    const auto outputs = compute.run(library, {"media/optical_depth.glsl"}, kBody, rays.inputs,
                                     uint32_t(rays.count()));
    for (size_t i = 0; i < rays.count(); ++i) {
        const dvec3 exact = opticalDepth(medium, worldFromNode, rays.segment(i));
        for (int c = 0; c < 3; ++c) {
            const double gpu = double(outputs[i][c]);
            ASSERT_TRUE(std::isfinite(gpu) && gpu >= 0) << "ray " << i << ": " << gpu;
            if (exact[c] > 1e6)
                EXPECT_GT(gpu, 1e5) << "ray " << i; // as opaque as any
            else
                EXPECT_NEAR(gpu, exact[c], absolute + relative * exact[c])
                    << "ray " << i << " channel " << c;
        }
    }
}

Medium homogeneous(MediumKind kind) {
    Medium medium;
    medium.name = "test";
    medium.kind = kind;
    medium.scattering = vec3(0.3f, 0.0f, 2.0f);
    medium.absorption = vec3(0.1f, 0.0f, 0.5f);
    return medium;
}

dmat4 slanted() {
    dmat4 m = glm::translate(dmat4(1.0), dvec3(0.3, -0.2, 0.1));
    m = glm::rotate(m, 0.7, glm::normalize(dvec3(1, 2, 3)));
    return glm::scale(m, dvec3(0.8, 1.4, 2.1));
}

TEST_P(MediaDepth, EverywhereIsExact) {
    expectDepths(homogeneous(MediumKind::Everywhere), slanted(), randomRays(3, 200, seed()), 1e-6,
                 0);
}

TEST_P(MediaDepth, BoxIsExact) {
    Medium medium = homogeneous(MediumKind::Box);
    medium.size = dvec3(1, 2, 0.5);
    expectDepths(medium, dmat4(1.0), randomRays(2, 500, seed()), 1e-5, 1e-5);
    expectDepths(medium, slanted(), randomRays(2, 500, seed() + 1), 1e-5, 1e-5);
}

TEST_P(MediaDepth, EllipsoidIsExact) {
    Medium medium = homogeneous(MediumKind::Sphere);
    medium.size = dvec3(2, 1, 1.5);
    // Near the rim the chord grows like a square root: rounding of the ray counts for more.
    expectDepths(medium, dmat4(1.0), randomRays(2, 500, seed() + 2), 1e-4, 1e-4);
    expectDepths(medium, slanted(), randomRays(2, 500, seed() + 3), 1e-4, 1e-4);
}

TEST_P(MediaDepth, HeightFogIsExactAtEverySlope) {
    Medium medium = homogeneous(MediumKind::Height);
    for (const double scaleHeight : {0.05, 1.0, 300.0}) {
        medium.scaleHeight = scaleHeight;
        Rays rays = randomRays(2, 400, seed() + 4);
        // Nearly level rays, where the textbook quotient is 0/0.
        for (const double slope : {1e-3, -1e-3, 1e-6, -1e-6, 1e-9, 0.0})
            for (const double y : {-0.5, 0.0, 0.02, 1.0}) {
                const dvec3 d = glm::normalize(dvec3(1, slope, 0.2));
                rays.add(dvec3(0, y, 0), d, 4);
                rays.add(dvec3(0, y, 0), d, 1000);
            }
        // Rounding of y (some 1e-7 of a metre) in units of the scale height.
        expectDepths(medium, dmat4(1.0), rays, 1e-5 + 1e-6 / scaleHeight, 1e-6);
        expectDepths(medium, glm::rotate(dmat4(1.0), 0.5, dvec3(0, 0, 1)), rays,
                     1e-5 + 1e-6 / scaleHeight, 1e-6);
    }
}

TEST_P(MediaDepth, NoCoefficientNoDepthAndAnyDensityIsFinite) {
    for (const float sigma : {1e-12f, 1e4f, 1e12f}) {
        Medium medium = homogeneous(MediumKind::Box);
        medium.scattering = vec3(sigma, 0, sigma);
        medium.absorption = vec3(0);
        expectDepths(medium, dmat4(1.0), randomRays(1, 100, seed() + 5), 1e-5,
                     1e-5 * double(sigma));
    }
}

BrickGrid randomGrid(uint64_t s, const ivec3& size, const dmat4& worldFromIndex) {
    RandomRays random(s);
    std::vector<float> voxels(size_t(size.x) * size_t(size.y) * size_t(size.z));
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                float& v =
                    voxels[(size_t(z) * size_t(size.y) + size_t(y)) * size_t(size.x) + size_t(x)];
                // Empty, constant and varied regions of several bricks each.
                if (x < size.x / 3)
                    v = 0;
                else if (y < size.y / 3)
                    v = 0.75f;
                else
                    v = float(random.uniform(0, 2));
            }
    return makeBrickGrid(voxels, ivec3(-5, 3, 11), size, worldFromIndex);
}

Medium gridMedium(const dmat4& worldFromIndex, uint64_t s) {
    Medium medium = homogeneous(MediumKind::Grid);
    medium.density = std::make_shared<BrickGrid>(randomGrid(s, ivec3(60, 41, 33), worldFromIndex));
    return medium;
}

TEST_P(MediaDepth, GridIsExactCellByCell) {
    // Straight, then rotated, sheared and not uniform.
    dmat4 worldFromIndex = glm::scale(dmat4(1.0), dvec3(0.05));
    expectDepths(gridMedium(worldFromIndex, seed()), glm::translate(dmat4(1.0), dvec3(-1, -1, -1)),
                 randomRays(2, 500, seed() + 6), 2e-5, 2e-5);
    worldFromIndex = glm::rotate(glm::scale(dmat4(1.0), dvec3(0.05, 0.02, 0.09)), 0.4,
                                 glm::normalize(dvec3(1, -1, 2)));
    worldFromIndex[1] += 0.3 * worldFromIndex[0];
    expectDepths(gridMedium(worldFromIndex, seed() + 1), slanted(), randomRays(2, 500, seed() + 7),
                 2e-5, 2e-5);
}

TEST_P(MediaDepth, GridByStepsConvergesToTheExactDepth) {
    const dmat4 worldFromIndex = glm::scale(dmat4(1.0), dvec3(0.05));
    MediaOptions options;
    options.flags = 0;
    options.stepVoxels = 0.1f;
    // Random voxels are the hardest field there is; the mid-point rule leaves h²/24 of its curvature, and texture filtering 1/256 of its steps.
    expectDepths(gridMedium(worldFromIndex, seed()), dmat4(1.0), randomRays(2, 300, seed() + 8),
                 5e-3, 5e-3, options);
}

TEST_P(MediaDepth, TakesNoMoreRoundsOfLoopsThanAreCountedOn) {
    // Where a driver ends loops after so many rounds, a loop without an end tells how many were left.
    constexpr float kNeverSoMany = 70000;
    std::vector<Medium> media{homogeneous(MediumKind::Box),
                              gridMedium(glm::scale(dmat4(1.0), dvec3(0.05)), seed())};
    const std::vector<dmat4> world(2, dmat4(1.0));
    const Scene scene = sceneOf(media, world);
    const Rays rays = randomRays(2, 300, seed() + 11);
    for (const float step : {0.1f, 0.5f, 1.0f, 4.0f}) {
        MediaOptions options;
        options.flags = 0;
        options.stepVoxels = step;
        gl::ShaderLibrary library;
        MediaCompute compute(scene, options);
        const auto rounds = [&](const std::string& before) {
            const auto outputs = compute.run(
                library, {"media/optical_depth.glsl"},
                "vec4 a = inputs[2u * id]; vec4 b = inputs[2u * id + 1u]; vec3 depth = vec3(0);" +
                    before + "float left = 0.0; while (left < " + std::to_string(kNeverSoMany) +
                    " + 0.0 * depth.x) left += 1.0; outputs[id] = vec4(depth, left);",
                rays.inputs, uint32_t(rays.count()));
            return std::min_element(outputs.begin(), outputs.end(), [](const vec4& a, const vec4& b) {
                       return a.w < b.w;
                   })->w;
        };
        const float all = rounds("depth.x = min(abs(a.w), 1.0);");
        if (all == kNeverSoMany) GTEST_SKIP() << "this driver does not end loops";
        const float left = rounds("depth = opticalDepthAlong(a.xyz, b.xyz, a.w);");
        MediaResources resources;
        resources.count = 2;
        gpu::MediaHeader header{};
        header.stepVoxels = step;
        header.analyticSteps = options.steps;
        countOnRays(compute.placed(), header, 0, resources);
        const double counted = opticalDepthRounds(resources);
        printf("steps of %g voxels: %g rounds, %g counted on\n", double(step), double(all - left), counted);
        EXPECT_GT(all - left, 0);
        EXPECT_LE(double(all - left), counted);
    }
}

TEST_P(MediaDepth, FarFromTheOriginNothingIsLost) {
    // The grid lies 10,000 km away, the render origin near it: the same picture as at the world's origin.
    const dvec3 away(1e7, -3e6, 2e6);
    Medium medium = gridMedium(glm::scale(dmat4(1.0), dvec3(0.05)), seed());
    const dmat4 world = glm::translate(dmat4(1.0), away);
    const Scene scene = sceneOf(std::span(&medium, 1), std::span(&world, 1));
    MediaOptions options;
    options.renderOrigin = away;
    gl::ShaderLibrary library;
    MediaCompute compute(scene, options);
    const Rays rays = randomRays(2, 300, seed() + 9);
    const auto outputs = compute.run(library, {"media/optical_depth.glsl"}, kBody, rays.inputs,
                                     uint32_t(rays.count()));
    for (size_t i = 0; i < rays.count(); ++i) {
        const dvec3 exact = opticalDepth(medium, dmat4(1.0), rays.segment(i));
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(double(outputs[i][c]), exact[c], 2e-5 + 2e-5 * exact[c]);
    }
}

TEST_P(MediaDepth, OverlappingMediaAddUp) {
    std::vector<Medium> media{homogeneous(MediumKind::Box), homogeneous(MediumKind::Sphere),
                              gridMedium(glm::scale(dmat4(1.0), dvec3(0.05)), seed()),
                              homogeneous(MediumKind::Height)};
    const std::vector<dmat4> world{dmat4(1.0), slanted(), dmat4(1.0), dmat4(1.0)};
    const Scene scene = sceneOf(media, world);
    gl::ShaderLibrary library;
    MediaCompute compute(scene, {});
    const Rays rays = randomRays(2, 300, seed() + 10);
    const auto outputs = compute.run(library, {"media/optical_depth.glsl"}, kBody, rays.inputs,
                                     uint32_t(rays.count()));
    for (size_t i = 0; i < rays.count(); ++i) {
        dvec3 exact(0);
        for (size_t m = 0; m < media.size(); ++m)
            exact += opticalDepth(media[m], world[m], rays.segment(i));
        if (exact.x > 1e6) continue;
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(double(outputs[i][c]), exact[c], 1e-4 + 1e-4 * exact[c]);
    }
}

} // namespace
} // namespace tyndall::test
