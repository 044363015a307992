// Shadows at the right place: against rays; what makes holes, what leaks.

#include "passes/shadows_scene.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <random>

#include "support/content.h"

namespace tyndall::test {
namespace {

using ShadowsOnPoints = LightsTest;
TYNDALL_GL_TESTS(ShadowsOnPoints);

Light spotLight(float candela, float outer = 0.8f) {
    Light light;
    light.type = LightType::Spot;
    light.intensity = candela;
    light.outerConeAngle = outer;
    return light;
}

/// Every kind of light above the box; `from` is where its light comes from.
struct Lamp {
    const char* name;
    std::function<void(SceneMaker&, double scale)> add;
    dvec3 from;
};
const std::vector<Lamp>& lamps() {
    static const dvec3 place(2.2, 6.1, 1.3);
    static const std::vector<Lamp> all = {
        {"directional", [](SceneMaker& m, double) { m.directionalLight(10, -place); },
         place * 100.0},
        {"point", [](SceneMaker& m, double s) { m.pointLight(float(100 * s * s), place * s); },
         place},
        {"spot",
         [](SceneMaker& m, double s) {
             m.light(spotLight(float(100 * s * s)), lookingAlong(place * s, -place));
         },
         place},
        {"wide spot",
         [](SceneMaker& m, double s) {
             m.light(spotLight(float(100 * s * s), 1.5f), lookingAlong(place * s, -place));
         },
         place},
    };
    return all;
}

TEST_P(ShadowsOnPoints, BoxShadowLiesWhereRaysSayAtEveryScale) {
    for (const Lamp& lamp : lamps()) {
        std::vector<Seen> atScale[3];
        int index = 0;
        for (const double scale : {1e-3, 1.0, 1e3}) {
            BoxOverFloor world(scale);
            lamp.add(world.maker, scale);
            atScale[index] = look(world.maker, world.probes, world.options());
            int dark = 0, light = 0, wrong = 0;
            for (size_t i = 0; i < world.probes.size(); ++i) {
                // Two texels: 16 m over 512, somewhat more across the diagonal and for maps seen from near by.
                const int truth =
                    world.truth(world.probes[i].position, lamp.from * scale, 0.1 * scale);
                dark += truth == 0;
                light += truth == 1;
                wrong += truth >= 0 && atScale[index][i].visibility != float(truth);
            }
            EXPECT_EQ(wrong, 0) << lamp.name << " at scale " << scale;
            EXPECT_GT(dark, 20);
            EXPECT_GT(light, 800);
            ++index;
        }
        for (const int other : {0, 2}) {
            double difference = 0;
            for (size_t i = 0; i < atScale[1].size(); ++i)
                difference += std::abs(double(atScale[other][i].visibility) -
                                       double(atScale[1][i].visibility));
            EXPECT_LT(difference / double(atScale[1].size()), 1e-3) << lamp.name;
        }
    }
}

TEST_P(ShadowsOnPoints, AveragedFramesShowTheSameShadow) {
    for (const Lamp& lamp : lamps()) {
        BoxOverFloor world;
        lamp.add(world.maker, 1);
        ProbeOptions options = world.options();
        options.converge = true;
        options.frames = 8;
        const std::vector<Seen> seen = look(world.maker, world.probes, options);
        int wrong = 0;
        for (size_t i = 0; i < world.probes.size(); ++i) {
            const int truth = world.truth(world.probes[i].position, lamp.from, 0.1);
            wrong += truth >= 0 && seen[i].visibility != float(truth);
        }
        EXPECT_EQ(wrong, 0) << lamp.name;
    }
}

TEST_P(ShadowsOnPoints, LitPlanesHaveNoAcneAtAnyTilt) {
    std::mt19937 random{uint32_t(seed())};
    std::uniform_real_distribution<double> unit(-1, 1);
    for (const bool converge : {false, true})
        for (const double tilt : {0.0, 0.3, 0.8, 1.2, 1.4, 1.5}) {
            const dquat rotation = glm::angleAxis(tilt, glm::normalize(dvec3(1, 0, 0.3)));
            const dvec3 normal = rotation * kUp;
            for (int kind = 0; kind < 5; ++kind) {
                SceneMaker maker;
                maker.primitive(PrimitiveShape::Plane, {10, 1, 10}, {0, 0, 0}, rotation);
                if (kind == 0) maker.directionalLight(1, {0, -1, 0});
                if (kind == 1) maker.pointLight(1, {0, 7, 0});
                if (kind == 2) maker.light(spotLight(1, 0.9f), lookingAlong({0, 9, 0}, {0, -1, 0}));
                if (kind == 3) maker.pointLight(1, {0, 7, 0}, 0.2f);
                if (kind == 4) maker.directionalLight(1, {0, -1, 0}, 0.02f);
                std::vector<Probe> probes;
                for (int i = 0; i < 1024; ++i)
                    probes.push_back(
                        {rotation * dvec3(4.5 * unit(random), 0, 4.5 * unit(random)), normal});
                ProbeOptions options;
                options.converge = converge;
                const std::vector<Seen> seen = look(maker, probes, options);
                int acne = 0;
                for (size_t i = 0; i < probes.size(); ++i)
                    acne += seen[i].open > 0 && seen[i].visibility < 1;
                EXPECT_EQ(acne, 0)
                    << "kind " << kind << ", tilt " << tilt << ", converge " << converge;
            }
        }
}

TEST_P(ShadowsOnPoints, BallsHaveNoAcneOnTheLitSide) {
    SceneMaker maker;
    maker.primitive(PrimitiveShape::Sphere, {4, 4, 4}, {0, 0, 0});
    maker.directionalLight(1, {0.3, -1, 0.2});
    const dvec3 toLight = glm::normalize(dvec3(-0.3, 1, -0.2));
    // Probes on the facets themselves, with the facets' normals, as rasterised pixels are.
    const Mesh& mesh = maker.scene.meshes[0];
    std::vector<Probe> probes;
    for (size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
        const dvec3 a(mesh.positions[mesh.indices[t]]), b(mesh.positions[mesh.indices[t + 1]]),
            c(mesh.positions[mesh.indices[t + 2]]);
        const dvec3 cross = glm::cross(b - a, c - a);
        if (glm::length(cross) < 1e-8) continue;
        const dvec3 normal = glm::normalize(cross);
        if (glm::dot(normal, toLight) > 0.1) probes.push_back({(a + b + c) / 3.0, normal});
    }
    ASSERT_GT(probes.size(), 2000u);
    const std::vector<Seen> seen = look(maker, probes);
    int acne = 0;
    for (const Seen& s : seen) acne += s.visibility < 1;
    EXPECT_EQ(acne, 0);
}

TEST_P(ShadowsOnPoints, ShadowsTouchWhatCastsThem) {
    // A wall on a floor, light from behind it at 45 degrees: two texels behind the wall it is dark.
    SceneMaker maker;
    maker.primitive(PrimitiveShape::Plane, {10, 1, 10}, {0, 0, 0});
    maker.primitive(PrimitiveShape::Box, {6, 2, 0.02}, {0, 1, 0});
    maker.directionalLight(1, {0, -1, 1});
    look(maker, {{{0, 0, 0}, kUp}});
    const gpu::ShadowView& finest = lights().shadowPlan().views.back();
    const double texel = double(finest.bias.x) * std::sqrt(2.0); // on the floor
    std::vector<Probe> probes;
    for (int i = 0; i < 200; ++i)
        probes.push_back({{-2 + 0.02 * i, 0, 0.01 + (2.0 + 0.01 * i) * texel}, kUp});
    for (const Seen& s : look(maker, probes)) EXPECT_EQ(s.visibility, 0.0f);
}

/// A texture of 8 × 8 squares, every other one transparent.
Material chequered(SceneMaker& maker, AlphaMode mode, uint8_t alpha = 0) {
    ImageData image;
    image.name = "chequers";
    image.width = image.height = 64;
    image.rgba.resize(64 * 64 * 4, 255);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            if ((x / 8 + y / 8) % 2) image.rgba[size_t(4 * (64 * y + x) + 3)] = alpha;
    maker.scene.images.push_back(image);
    Texture texture;
    texture.image = int(maker.scene.images.size()) - 1;
    texture.sampler = {Filter::Nearest, Filter::Nearest, MipFilter::None, Wrap::ClampToEdge,
                       Wrap::ClampToEdge};
    maker.scene.textures.push_back(texture);
    Material material;
    material.alphaMode = mode;
    material.baseColorTexture.texture = int(maker.scene.textures.size()) - 1;
    return material;
}

TEST_P(ShadowsOnPoints, MaskedCastersLetLightThroughTheirHoles) {
    SceneMaker maker;
    maker.primitive(PrimitiveShape::Plane, {20, 1, 20}, {0, 0, 0});
    maker.primitive(PrimitiveShape::Plane, {8, 1, 8}, {0, 2, 0}, {1, 0, 0, 0},
                    chequered(maker, AlphaMode::Mask));
    maker.directionalLight(1, {0, -1, 0});
    std::vector<Probe> probes;
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) probes.push_back({{x - 3.5, 0, y - 3.5}, kUp});
    const std::vector<Seen> seen = look(maker, probes);
    int lit = 0;
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
            // Neighbours differ, whichever way the texture lies.
            if (x > 0) {
                EXPECT_NE(seen[size_t(8 * y + x)].visibility,
                          seen[size_t(8 * y + x - 1)].visibility);
            }
            const float v = seen[size_t(8 * y + x)].visibility;
            EXPECT_TRUE(v == 0 || v == 1) << v;
            lit += v == 1;
        }
    EXPECT_EQ(lit, 32);
}

TEST_P(ShadowsOnPoints, BlendedCastersLetTheirTransparencyThrough) {
    SceneMaker maker;
    maker.primitive(PrimitiveShape::Plane, {20, 1, 20}, {0, 0, 0});
    Material glass;
    glass.alphaMode = AlphaMode::Blend;
    glass.baseColor.w = 0.3f;
    maker.primitive(PrimitiveShape::Plane, {8, 1, 8}, {0, 2, 0}, {1, 0, 0, 0}, glass);
    maker.directionalLight(1, {0, -1, 0});
    std::mt19937 random{uint32_t(seed())};
    std::uniform_real_distribution<double> unit(-1, 1);
    std::vector<Probe> probes;
    for (int i = 0; i < 2000; ++i) probes.push_back({{3 * unit(random), 0, 3 * unit(random)}, kUp});
    ProbeOptions options;
    options.converge = true;
    options.frames = 32;
    double mean = 0;
    for (const Seen& s : look(maker, probes, options))
        mean += double(s.visibility) / double(probes.size());
    // 64,000 draws of a coin that shows "lit" 7 times in 10: four standard errors.
    EXPECT_NEAR(mean, 0.7, 4 * std::sqrt(0.7 * 0.3 / 64000));
}

TEST_P(ShadowsOnPoints, SurfacesBlockFromBothSides) {
    for (const double turn : {0.0, kPi}) {
        SceneMaker maker;
        Material oneSided;
        maker.primitive(PrimitiveShape::Plane, {4, 1, 4}, {0, 2, 0},
                        glm::angleAxis(turn, dvec3(1, 0, 0)), oneSided);
        maker.pointLight(1, {0, 5, 0});
        const std::vector<Seen> seen =
            look(maker, {{{0, 0, 0}, kUp}, {{5, 0, 0}, kUp}, {{0, 3, 0}, {0, 0, 0}}});
        EXPECT_EQ(seen[0].visibility, 0.0f);
        EXPECT_EQ(seen[1].visibility, 1.0f);
        EXPECT_EQ(seen[2].visibility, 1.0f);
    }
}

TEST_P(ShadowsOnPoints, PointLightShadowsInAllSixDirections) {
    SceneMaker maker;
    const dvec3 lamp(0.3, -0.2, 0.5);
    std::vector<Probe> probes;
    std::vector<float> expected;
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0}) {
            dvec3 d(0), size(0.5);
            d[axis] = sign;
            maker.primitive(PrimitiveShape::Box, size,
                            lamp + 2.0 * d); // half of its side is seen under 8 degrees
            for (const double aside : {-1.0, 0.0, 1.0}) {
                dvec3 shift(0);
                shift[(axis + 1) % 3] = aside;
                probes.push_back({lamp + 6.0 * d + 2.0 * shift, -d});
                expected.push_back(aside == 0 ? 0.0f : 1.0f);
            }
            // Edges and corners between the faces are open.
            probes.push_back({lamp + dvec3(sign * 4, 4,
                                           axis == 0   ? 4
                                           : axis == 1 ? -4
                                                       : 0),
                              {0, 0, 0}});
            expected.push_back(1);
        }
    maker.pointLight(1, lamp);
    for (const bool converge : {false, true}) {
        ProbeOptions options;
        options.converge = converge;
        const std::vector<Seen> seen = look(maker, probes, options);
        for (size_t i = 0; i < probes.size(); ++i)
            EXPECT_EQ(seen[i].visibility, expected[i])
                << "probe " << i << ", converge " << converge;
    }
}

TEST_P(ShadowsOnPoints, ALampShinesThroughItsOwnGlass) {
    SceneMaker maker;
    maker.primitive(PrimitiveShape::Plane, {20, 1, 20}, {0, 0, 0});
    maker.primitive(PrimitiveShape::Sphere, dvec3(0.2), {0, 2, 0});
    maker.primitive(PrimitiveShape::Box, {0.5, 0.1, 0.5}, {0, 1, 0}); // and still has shadows
    maker.pointLight(100, {0, 2, 0}, 0.1f);
    const std::vector<Seen> seen =
        look(maker, {{{3, 0, 0}, kUp}, {{0, 0, -4}, kUp}, {{0, 0, 0}, kUp}}, {});
    EXPECT_EQ(seen[0].visibility, 1);
    EXPECT_EQ(seen[1].visibility, 1);
    EXPECT_EQ(seen[2].visibility, 0);
}

TEST_P(ShadowsOnPoints, RectLightShadowsOnItsSide) {
    SceneMaker maker;
    Light panel;
    panel.type = LightType::Rect;
    panel.radiance = vec3(10);
    panel.size = {0.2, 0.2};
    maker.light(panel, lookingAlong({0, 5, 0}, {0, -1, 0}));
    maker.primitive(PrimitiveShape::Plane, {20, 1, 20}, {0, 0, 0});
    maker.primitive(PrimitiveShape::Box, {1, 0.1, 1}, {0, 2.5, 0});
    maker.primitive(PrimitiveShape::Box, {0.1, 2, 2},
                    {2, 4.5, 0}); // beside the panel: shadows through a side face
    for (const bool converge : {false, true}) {
        ProbeOptions options;
        options.converge = converge;
        options.frames = converge ? 16 : 1;
        const std::vector<Seen> seen = look(maker,
                                            {{{0, 0, 0}, kUp},
                                             {{0.5, 0, 0.5}, kUp},
                                             {{1.5, 0, 0}, kUp},
                                             {{8, 3.5, 0}, {-1, 0, 0}},
                                             {{-8, 3.5, 0}, {1, 0, 0}}},
                                            options);
        EXPECT_EQ(seen[0].visibility, 0.0f);
        EXPECT_EQ(seen[1].visibility, 0.0f);
        EXPECT_EQ(seen[2].visibility, 1.0f);
        EXPECT_EQ(seen[3].visibility, 0.0f);
        EXPECT_EQ(seen[4].visibility, 1.0f);
    }
}

TEST_P(ShadowsOnPoints, FogBehindAWallStaysDark) {
    // A wall of 1 cm, tilted against the light; points of fog from its back to 2 m behind it.
    const dquat tilt = glm::angleAxis(0.6, dvec3(1, 0, 0));
    std::mt19937 random{uint32_t(seed())};
    std::uniform_real_distribution<double> unit(0, 1);
    for (int kind = 0; kind < 2; ++kind)
        for (const bool converge : {false, true}) {
            SceneMaker maker;
            maker.primitive(PrimitiveShape::Box, {8, 0.01, 8}, {0, 3, 0}, tilt);
            if (kind == 0)
                maker.directionalLight(1, {0, -1, 0});
            else
                maker.pointLight(1, {0, 8, 0});
            std::vector<Probe> probes;
            for (int i = 0; i < 4096; ++i) {
                const dvec3 back = dvec3(0, 3, 0) +
                                   tilt * dvec3(4 * unit(random) - 2, -0.005, 4 * unit(random) - 2);
                probes.push_back({back - dvec3(0, 2 * unit(random), 0), {0, 0, 0}});
            }
            ProbeOptions options;
            options.converge = converge;
            double mean = 0;
            for (const Seen& s : look(maker, probes, options))
                mean += double(s.visibility) / double(probes.size());
            EXPECT_LT(mean, converge ? 5e-3 : 1e-3) << "kind " << kind << ", converge " << converge;
        }
}

} // namespace
} // namespace tyndall::test
