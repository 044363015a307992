// Laws that media must obey, whatever they are made of: colour by colour, in one piece or in many, from inside and from outside.

#include <cmath>

#include "laws_fixture.h"
#include "media/segment_integral.h"

namespace tyndall::validation {
namespace {

const dvec3 kEye(0.3, 0.2, 4);

Medium colouredGrid(const vec3& scattering, const vec3& absorption, double densest) {
    Medium medium;
    medium.kind = MediumKind::Grid;
    medium.scattering = scattering;
    medium.absorption = absorption;
    medium.anisotropy = 0.4f;
    medium.density = lumpyGrid(2, densest, 7);
    return medium;
}

// T10. Mitsuba's issue 1387: null collisions must be weighed by all channels.
TEST(ReferenceMedia, AnUnevenAbsorberOfThreeColoursLetsEachThroughByItsOwnDepth) {
    const Medium medium = colouredGrid(vec3(0), vec3(0.1f, 1, 10), 0.6);
    SceneMaker maker;
    maker.addMedium(medium);
    maker.addWhiteEnvironment();
    const auto stage = Stage::make(maker.take());
    const dvec3 to(0.1, -0.2, 0), direction = glm::normalize(to - kEye);
    const dvec3 depth = opticalDepth(medium, dmat4(1.0), {kEye, direction, 100});
    ASSERT_GT(depth.y, 0.1);
    Sampler unused(0, 0, 0);
    const dvec3 exact =
        tracing::transmittance(*stage->traced.media, {kEye, direction}, kInfinity,
                                 tracing::TransmittanceMode::Exact, unused);
    for (int c = 0; c < 3; ++c) {
        const double expected = std::exp(-depth[c]);
        EXPECT_NEAR(exact[c] / expected, 1, 1e-6);
        Effort effort;
        effort.segments = 3e5;
        const Estimate flown = measure(gaze(stage, kEye, to, 0, c), effort, 100 + uint64_t(c));
        EXPECT_LE(std::abs(flown.value - expected), kLargestT * flown.error) << "channel " << c;
        EXPECT_LT(flown.error, 0.05 * expected) << "channel " << c;
        Probe tracked;
        tracked.stage = stage;
        tracked.segmentsPerSample = 4;
        tracked.sample = [&, c](Tracers&, Sampler& sampler) {
            return tracing::transmittance(*stage->traced.media, {kEye, direction},
                                            kInfinity,
                                            tracing::TransmittanceMode::Ratio, sampler)[c];
        };
        const Estimate ratio = measure(tracked, effort, 200 + uint64_t(c));
        EXPECT_LE(std::abs(ratio.value - expected), 4 * ratio.error) << "channel " << c;
        EXPECT_LT(ratio.error, 0.01 * expected) << "channel " << c;
    }
}

TEST(ReferenceMedia, AColourIsAsItWouldBeAlone) {
    const vec3 scattering(0.3f, 1, 3), absorption(0.2f, 0.1f, 0);
    const auto lit = [](const Medium& medium) {
        SceneMaker maker;
        maker.addMedium(medium);
        maker.addPointLight({1.5, 1, 0.5}, 30, 0.3);
        maker.addPrimitive(PrimitiveShape::Plane, {6, 1, 6}, matt(vec3(0.7f)),
                           lookAlong({0, 0, -1}, {0, -1.2, 0}));
        return Stage::make(maker.take());
    };
    const auto coloured = lit(colouredGrid(scattering, absorption, 2));
    for (int c = 0; c < 3; ++c) {
        const auto grey = lit(colouredGrid(vec3(scattering[c]), vec3(absorption[c]), 2));
        expectSameLight(gaze(coloured, kEye, dvec3(0), 0.5, c), gaze(grey, kEye, dvec3(0), 0.5, c),
                        300 + uint64_t(c), "channel " + std::to_string(c));
    }
}

Medium boxOf(const dvec3& size, float scattering, float absorption) {
    Medium box;
    box.kind = MediumKind::Box;
    box.size = size;
    box.scattering = vec3(scattering);
    box.absorption = vec3(absorption);
    box.anisotropy = 0.5f;
    return box;
}

std::shared_ptr<const Stage> litBodies(const std::vector<std::pair<Medium, dvec3>>& bodies) {
    SceneMaker maker;
    for (const auto& [medium, at] : bodies) maker.addMedium(medium, at);
    maker.addPointLight({2, 1.5, 1}, 20);
    maker.scene().environment.radiance = vec3(0.3f);
    return Stage::make(maker.take());
}

// T11.
TEST(ReferenceMedia, MatterInOnePieceInHalvesAndInLayersOverEachOtherIsTheSame) {
    const dvec3 size(2, 2, 2);
    const auto whole = litBodies({{boxOf(size, 1.2f, 0.3f), dvec3(0)}});
    const auto halves = litBodies({{boxOf({1, 2, 2}, 1.2f, 0.3f), {-0.5, 0, 0}},
                                   {boxOf({1, 2, 2}, 1.2f, 0.3f), {0.5, 0, 0}}});
    const auto layers =
        litBodies({{boxOf(size, 0.9f, 0.1f), dvec3(0)}, {boxOf(size, 0.3f, 0.2f), dvec3(0)}});
    Medium grid = boxOf(size, 1.2f, 0.3f);
    grid.kind = MediumKind::Grid;
    // 64³ voxels of 1 fill 64 cells across: 63 between them and half of each sloping one at the sides.
    const double spacing = 2.0 / 64;
    grid.density =
        sampledGrid(ivec3(0), ivec3(64), dvec3(spacing), [](const dvec3&) { return 1.0; });
    const auto gridded = litBodies({{grid, dvec3(-1 + 0.5 * spacing)}});
    Medium half = grid;
    half.scattering *= 0.5f;
    half.absorption *= 0.5f;
    const auto grids =
        litBodies({{half, dvec3(-1 + 0.5 * spacing)}, {half, dvec3(-1 + 0.5 * spacing)}});
    const dvec3 to(0.1, 0.15, 0);
    expectSameLight(gaze(whole, kEye, to, 0.6), gaze(halves, kEye, to, 0.6), 400, "halves");
    expectSameLight(gaze(whole, kEye, to, 0.6), gaze(layers, kEye, to, 0.6), 401, "layers");
    // Half a voxel of dilation would be 1.5 % of the depth; the slopes at the sides are worth (σh)²/24 = 10⁻⁴.
    expectSameLight(gaze(whole, kEye, to, 0.6), gaze(gridded, kEye, to, 0.6), 402, "grid", 5e5,
                    2e-4);
    expectSameLight(gaze(gridded, kEye, to, 0.6), gaze(grids, kEye, to, 0.6), 403, "two grids");
}

// T13: an eye just outside of a medium and just inside see the same.
TEST(ReferenceMedia, LightDoesNotJumpWhereTheEyeEntersMatter) {
    Medium ball = boxOf(dvec3(2), 1.5f, 0.2f);
    ball.kind = MediumKind::Sphere;
    Medium glowing = boxOf(dvec3(2), 0.5f, 0.8f);
    glowing.emission = vec3(0.7f);
    for (const auto& [medium, name] :
         {std::pair(boxOf(dvec3(2), 1.5f, 0.2f), "box"), {ball, "sphere"}, {glowing, "fire"}}) {
        const auto stage = litBodies({{medium, dvec3(0)}});
        for (const double inwards : {-1.0, 1.0}) { // looking into the matter and away from it
            const dvec3 ahead(0.2, 0.1, -5 * inwards);
            // The eyes are 2 µm apart: so much of their light they may differ by, times σ.
            expectSameLight(gaze(stage, {0, 0, 1 + 1e-6}, ahead, 0),
                            gaze(stage, {0, 0, 1 - 1e-6}, ahead, 0), 500 + uint64_t(inwards > 0),
                            name, 3e5, 4e-6);
        }
    }
}

TEST(ReferenceMedia, AbsorbingFireIsContinuousToTheLastDigitThatItsDepthAllows) {
    // One channel absorbs only: what an eye sees is ε/σ·(1-e^-σl), with l the way through the matter.
    Medium fire = boxOf(dvec3(2), 0, 1.3f);
    fire.emission = vec3(2.6f);
    SceneMaker maker;
    maker.addMedium(fire, dvec3(0));
    const auto stage = Stage::make(maker.take());
    for (const double z : {1.5, 1 + 1e-9, 1 - 1e-9, 0.4, -0.9, -1 + 1e-9}) {
        const double way = std::min(2.0, z + 1);
        Effort effort;
        effort.segments = 2e5;
        const Estimate seen = measure(gaze(stage, {0, 0, z}, {0, 0, -9}, 0), effort, 600);
        const double expected = 2 * -std::expm1(-double(1.3f) * way);
        EXPECT_LE(std::abs(seen.value - expected), kLargestT * seen.error + 1e-8) << z;
    }
}

} // namespace
} // namespace tyndall::validation
