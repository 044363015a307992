// A ball of particles and its shadow: against a grid that the test sums up itself, finer and in other voxels, and against the path
// tracer. Nothing in either is told that the bricks are of particles.

#include <cmath>
#include <cstdio>
#include <random>

#include <gtest/gtest.h>

#include "core/image_metrics.h"
#include "media/particle_grids.h"
#include "reference/render.h"
#include "scene/scene_edit.h"
#include "support/content.h"
#include "support/render.h"

namespace tyndall::test {
namespace {

constexpr int kWidth = 48, kHeight = 36;
constexpr double kBall = 1; // metres

/// 300 particles in a ball of kBall metres: what is in its middle overlaps, what is at its rim stands out.
ParticleSet ballOfParticles() {
    ParticleSet set;
    std::mt19937 random(7);
    const auto uniform = [&](double low, double high) {
        return low + (high - low) * double(random()) / 4294967296.0;
    };
    while (set.particles.size() < 300) {
        const dvec3 p(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
        const double radius = uniform(0.2, 0.26);
        if (glm::length(p) * kBall + radius > kBall) continue;
        set.particles.push_back({vec3(p * kBall), float(radius), float(uniform(0.2, 1)), 0});
    }
    return set;
}

/// The sums of ρ·(105/16)·(1 - d²/r²)³ at voxels of 3 cm, where the engine's are of about 5 and lie elsewhere.
std::shared_ptr<const BrickGrid> denseGrid(const ParticleSet& set) {
    constexpr double kVoxel = 0.03;
    const dvec3 corner(-1.0613);
    const int size = 72;
    std::vector<float> voxels;
    for (int z = 0; z < size; ++z)
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                const dvec3 at = corner + kVoxel * dvec3(x, y, z);
                double sum = 0;
                for (const Particle& p : set.particles) {
                    const dvec3 d = (at - dvec3(p.position)) / double(p.radius);
                    const double t = 1 - glm::dot(d, d);
                    if (t > 0) sum += double(p.density) * (105.0 / 16) * t * t * t;
                }
                voxels.push_back(float(sum));
            }
    dmat4 worldFromIndex(kVoxel);
    worldFromIndex[3] = dvec4(corner, 1);
    return std::make_shared<const BrickGrid>(
        makeBrickGrid(voxels, ivec3(0), ivec3(size), worldFromIndex));
}

/// Under a sun, over a floor. Along the ball's diameter τ is about 5.
Scene ballOverFloor() {
    Scene scene = sceneFromJson(R"({"tyndall": 1, "camera": "eye", "nodes": [
        {"name": "floor", "primitive": {"shape": "plane", "size": [8, 8]}, "material": {"baseColor": [0.7, 0.6, 0.5], "specular": 0}, "translation": [0, -1.3, 0]},
        {"name": "ball", "medium": {"type": "particles", "generate": {"kind": "cloud", "count": 1}, "scattering": [0.8, 0.9, 1], "absorption": [0.3, 0.2, 0.1], "anisotropy": 0.4}},
        {"name": "sun", "light": {"type": "directional", "intensity": 10}, "rotation": [-0.5, 0.5, 0.2, 0.678232998]},
        {"name": "eye", "camera": {"type": "perspective", "yfov": 0.75}, "translation": [0, 0.6, 5.5], "rotation": [-0.1, 0, 0, 0.994987437]}]})");
    const auto notes =
        setParticles(scene, 0, std::make_shared<const ParticleSet>(ballOfParticles()));
    EXPECT_TRUE(notes.ok() && notes->empty());
    return scene;
}

Rendered direct(const Scene& scene, int frames = 32) {
    RenderOptions options;
    options.width = kWidth;
    options.height = kHeight;
    options.frames = frames;
    options.converge = true;
    options.terms = kDirectTerms;
    options.settings = {"shadows.resolution=512"};
    return sharedRenderer().render(scene, options);
}

TEST(ParticlePictures, AreThoseOfTheirSumsInAFinerGrid) {
    Scene scene = ballOverFloor();
    const Rendered particles = direct(scene);
    Medium dense = scene.media[0];
    dense.particles = nullptr;
    dense.density = denseGrid(ballOfParticles());
    setMedium(scene, 0, dense);
    const Rendered expected = direct(scene);
    scene.nodes[1].visible = false;
    scene.versions.structure = nextVersion();
    const Rendered nothing = direct(scene);

    // Between voxels of a quarter of the radius the field is linear: balls are wider by 6 %, and beside this grid's by 4 %.
    const ImageMetrics all = compareImages(particles.beauty, expected.beauty).value();
    const ImageMetrics shadow =
        compareImages(particles.terms.at("LSE"), expected.terms.at("LSE")).value();
    const ImageMetrics glow =
        compareImages(particles.terms.at("LVE"), expected.terms.at("LVE")).value();
    std::printf("relmse: all %.3g, LSE %.3g, LVE %.3g; energy %.5f, %.5f, %.5f\n", all.relmse,
                shadow.relmse, glow.relmse, all.energy, shadow.energy, glow.energy);
    EXPECT_LE(all.relmse, 1e-3);
    EXPECT_NEAR(all.energy, 1, 0.002); // the same matter, balls a few percent wider
    EXPECT_LE(shadow.relmse, 1e-3);
    // By itself this term has nothing but a few pixels of ball before black: at its rim 4 % of width are a tenth of what is there.
    EXPECT_LE(glow.relmse, 0.005);
    EXPECT_NEAR(glow.energy, 1, 0.02); // spread wider, less of it lies in its own shadow
    // The ball is there, and so is its shadow: at some pixel of the floor that sees past the ball.
    EXPECT_GT(meanOf(particles.terms.at("LVE")), 0.005);
    double darkest = 1;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            if (particles.pixel(x, y, "LVE").y > 0) continue;
            const float lit = nothing.pixel(x, y, "LSE").y;
            if (lit > 0) darkest = std::min(darkest, double(particles.pixel(x, y, "LSE").y / lit));
        }
    EXPECT_LT(darkest, 0.2);
}

TEST(ParticlePictures, AreThePathTracers) {
    const Scene scene = ballOverFloor();
    reference::RenderSettings settings;
    settings.width = kWidth;
    settings.height = kHeight;
    settings.path.terms = kDirectTerms;
    auto reference = reference::ReferenceRender::start(scene, scene.activeCamera, settings);
    ASSERT_TRUE(reference.ok()) << reference.message();
    EXPECT_TRUE(reference->notes().empty());
    ASSERT_TRUE(reference->addSamples(256));
    const Image truth = reference->film().beauty();
    const double noise = referenceFloor(truth, reference->film().variance()).value();
    const ImageMetrics found = compareImages(direct(scene, 64).beauty, truth).value();
    std::printf("relmse %.3g, of it the reference's noise %.3g; energy %.5f\n", found.relmse, noise,
                found.energy);
    // What the project promises of its direct light (direct_light_test.cpp).
    EXPECT_LE(found.relmse - noise, 1e-3);
    EXPECT_NEAR(found.energy, 1, 0.005);
}

} // namespace
} // namespace tyndall::test
