// Light on surfaces, from the scene to the images of LE, LSE and (behind blended surfaces) LVE: against closed forms and double precision.

#include <cmath>
#include <optional>

#include <glm/gtc/matrix_transform.hpp>

#include "framegraph/gl/executor.h"
#include "gl/gl_fixture.h"
#include "gl/shader_library.h"
#include "renderer/blend_pass.h"
#include "renderer/composite_pass.h"
#include "renderer/deferred_lighting_pass.h"
#include "renderer/gbuffer_pass.h"
#include "renderer/light_system.h"
#include "renderer/media_system.h"
#include "renderer/medium_march_pass.h"
#include "renderer/view.h"

namespace tyndall::test {
namespace {

constexpr int kSize = 16;
constexpr double kHalfHeight = 2; // metres seen, from the picture's centre up

/// A plane of `half` metres to each side in z = `z`, facing +Z.
Mesh plane(float half, float z, int material) {
    Mesh mesh;
    mesh.name = "plane";
    mesh.material = material;
    mesh.positions = {{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}};
    mesh.normals.assign(4, vec3(0, 0, 1));
    mesh.indices = {0, 1, 2, 0, 2, 3};
    for (const vec3& p : mesh.positions) mesh.bounds.include(dvec3(p));
    mesh.version = nextVersion();
    return mesh;
}

Material lambert(float albedo) {
    Material material;
    material.baseColor = vec4(vec3(albedo), 1);
    material.metallic = 0;
    material.specular = 0;
    return material;
}

struct Maker {
    Scene scene;
    void add(const Material& material, float half, float z) {
        scene.materials.push_back(material);
        scene.meshes.push_back(plane(half, z, int(scene.materials.size()) - 1));
        Node node;
        node.meshes = {int(scene.meshes.size()) - 1};
        scene.nodes.push_back(node);
    }
    void light(const Light& light, const dmat4& transform) {
        scene.lights.push_back(light);
        Node node;
        node.light = int(scene.lights.size()) - 1;
        node.matrix = transform;
        scene.nodes.push_back(node);
    }
    void touch() {
        SceneVersions& v = scene.versions;
        v.structure = v.transforms = v.meshes = v.materials = v.textures = v.lights = v.media =
            v.environment = nextVersion();
    }
};

struct Options {
    int frames = 1;           // averaged in converge mode when above 1
    double tilt = 0;          // the camera's angle from the planes' normal, radians
    bool perspective = false; // looks along -Z from z = 10 over 45 degrees; else parallel
    TermSet terms = kAllTerms;
};

struct Lit {
    Image emission, direct, inScatter; // inScatter: only with media
    std::string emissionStatus, directStatus, blendStatus;
};

class SurfaceLightTest : public GlTest {
protected:
    void SetUp() override {
        GlTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        library_.emplace();
        executor_.emplace(*library_);
        surfaces_.emplace(*executor_);
        environment_.emplace(*executor_);
        blended_.emplace(*executor_);
        media_.emplace(*executor_);
        media_->registerSettings(registry_);
        lights_.emplace();
        lights_->registerSettings(registry_);
        registry_.applyPreset(Quality::High);
        registry_.add({gbufferSettings(), &gbufferSettings_});
        registry_.add({surfaceLightSettings(), &settings_});
        // Small maps: these tests are about light, and 16 maps a frame of the environment's lights take most of their time.
        expectDone(registry_.assign("shadows.environmentResolution=64"));
        expectDone(registry_.assign("shadows.resolution=64"));
        expectDone(registry_.assign("shadows.localResolution=64"));
    }
    void TearDown() override {
        lights_.reset();
        media_.reset();
        blended_.reset();
        environment_.reset();
        surfaces_.reset();
        executor_.reset();
        library_.reset();
        GlTest::TearDown();
    }

    Lit draw(Maker& maker, const Options& options = {}) {
        maker.touch();
        Lit sum;
        for (int frame = 0; frame < options.frames; ++frame) {
            Lit one = drawFrame(maker.scene, options, uint32_t(frame));
            if (HasFatalFailure()) break;
            if (frame == 0)
                sum = one;
            else
                for (auto [to, from] :
                     {std::pair(&sum.emission, &one.emission), std::pair(&sum.direct, &one.direct)})
                    for (size_t i = 0; i < to->pixels.size(); ++i) to->pixels[i] += from->pixels[i];
        }
        for (Image* image : {&sum.emission, &sum.direct})
            for (float& value : image->pixels) value /= float(options.frames);
        return sum;
    }

    Lit drawFrame(const Scene& scene, const Options& options, uint32_t frame) {
        Lit lit;
        const ViewResources view = viewOf(options, frame);
        expectDone(surfaces_->update(scene, dvec3(0)));
        expectDone(environment_->update(scene));
        expectDone(blended_->update(*surfaces_, view));
        expectDone(media_->update(scene, dvec3(0)));
        fg::FrameGraph& graph = executor_->beginFrame();
        std::vector<Bounds> casters;
        for (const DrawItem& item : surfaces_->items()) casters.push_back(item.bounds);
        lights_->update({&scene, dvec3(0), casters, scene.worldBounds(), scene.worldBounds(), &view});
        SurfaceLightInputs inputs;
        inputs.view = view;
        inputs.gbuffer = addGBufferPass(graph, *surfaces_, view, gbufferSettings_);
        const Bounds bounds = surfaces_->bounds();
        const MediaFrame media =
            media_->beginFrame(graph, {&view, std::span(&bounds, 1), lights_->lights(), false});
        inputs.media = media.resources;
        inputs.lights = lights_->addPasses(graph, *surfaces_, view, true);
        inputs.environment = &*environment_;
        inputs.hasSurfaces = !surfaces_->items().empty();
        inputs.terms = options.terms;
        inputs.settings = settings_;
        const SurfaceLight light = addDeferredLightingPass(graph, inputs);
        const MediumMarch march = addMediumMarchPass(
            graph, media, {view, inputs.gbuffer.depth, inputs.lights, true, true});
        TermImages images;
        if (!graph.isAbsent(light.emission))
            images.add(bit(Term::LE),
                       addCompositePass(graph, "composite.LE", "term.LE", light.emission,
                                        march.transmittance, march.emission));
        if (!graph.isAbsent(light.direct))
            images.add(bit(Term::LSE), addCompositePass(graph, "composite.LSE", "term.LSE",
                                                        light.direct, march.transmittance));
        if (march.inScatter && !graph.isAbsent(march.inScatter))
            images.add(bit(Term::LVE), march.inScatter);
        images = addBlendPass(graph, *blended_,
                              {view, inputs.gbuffer.depth, march.transmittance, inputs.lights,
                               inputs.media, inputs.environment, settings_},
                              images);
        for (uint32_t i = 0; i < images.count; ++i) graph.markOutput(images.images[i].image);
        expectDone(executor_->execute());
        if (const fg::TextureHandle image = images.find(Term::LE))
            lit.emission = executor_->readImage(image);
        if (const fg::TextureHandle image = images.find(Term::LSE))
            lit.direct = executor_->readImage(image);
        if (const fg::TextureHandle image = images.find(Term::LVE))
            lit.inScatter = executor_->readImage(image);
        for (const fg::PassReport& pass : executor_->report().passes) {
            const std::string status = std::string(fg::statusName(pass.status)) +
                                       (pass.reason.empty() ? "" : ": " + std::string(pass.reason));
            if (pass.name == "lighting.emission") lit.emissionStatus = status;
            if (pass.name == "lighting.direct") lit.directStatus = status;
            if (pass.name == "blend") lit.blendStatus = status;
        }
        return lit;
    }

    static void expectDone(const Result<void>& result) {
        if (!result) ADD_FAILURE() << result.message();
    }

    static ViewResources viewOf(const Options& options, uint32_t frame) {
        Camera camera;
        camera.type = options.perspective ? CameraType::Perspective : CameraType::Orthographic;
        camera.ymag = kHalfHeight;
        camera.yfov = 0.25 * kPi;
        ViewRequest request;
        request.camera = &camera;
        request.worldFromCamera = glm::rotate(dmat4(1), options.tilt, dvec3(0, 1, 0)) *
                                  glm::translate(dmat4(1), dvec3(0, 0, 10));
        request.sceneRadius = 20;
        request.width = request.height = kSize;
        request.frameIndex = frame;
        request.converge = options.frames > 1;
        return makeView(request);
    }

    /// The point of the plane z = 0 under the centre of a pixel of the untilted parallel view.
    static dvec3 pointUnder(int x, int y) {
        return {((x + 0.5) / kSize * 2 - 1) * kHalfHeight,
                (1 - (y + 0.5) / kSize * 2) * kHalfHeight, 0};
    }
    static double centre(const Image& image, int channel = 0) {
        double sum = 0;
        for (int y = kSize / 2 - 1; y <= kSize / 2; ++y)
            for (int x = kSize / 2 - 1; x <= kSize / 2; ++x) sum += double(image.at(x, y)[channel]);
        return sum / 4;
    }

    std::optional<gl::ShaderLibrary> library_;
    std::optional<fg::Executor> executor_;
    std::optional<GpuScene> surfaces_;
    std::optional<EnvironmentMap> environment_;
    std::optional<BlendList> blended_;
    std::optional<MediaSystem> media_;
    std::optional<LightSystem> lights_;
    SettingsRegistry registry_;
    GBufferSettings gbufferSettings_{};
    SurfaceLightSettings settings_{};
};
TYNDALL_GL_TESTS(SurfaceLightTest);

TEST_P(SurfaceLightTest, PointLightOnLambertIsExactInAbsoluteUnits) {
    Maker maker;
    maker.add(lambert(0.7f), 20, 0);
    Light lamp;
    lamp.intensity = 100;
    const dvec3 at(0.3, -0.4, 2);
    maker.light(lamp, glm::translate(dmat4(1), at));
    const Lit lit = draw(maker);
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            const dvec3 d = at - pointUnder(x, y);
            const double expected = 0.7 / kPi * 100 * d.z / std::pow(glm::dot(d, d), 1.5);
            EXPECT_NEAR(double(lit.direct.at(x, y)[0]) / expected, 1, 1e-3) << x << ", " << y;
        }
    EXPECT_EQ(lit.emissionStatus, "skipped: the environment is black");
}

/// Radiance π · this: from a point to a rectangle of half extents a, b in z = h, its centre (cx, cy) away, parallel to the
/// receiver; sums of the configuration factor of a rectangle with a corner above the point (Howell's catalogue, B-3).
double rectFactor(double cx, double cy, double a, double b, double h) {
    const auto corner = [&](double x, double y) {
        const double sx = x / h, sy = y / h, rx = std::sqrt(1 + sx * sx),
                     ry = std::sqrt(1 + sy * sy);
        return (sx / rx * std::atan(sy / rx) + sy / ry * std::atan(sx / ry)) / (2 * kPi);
    };
    return corner(cx + a, cy + b) - corner(cx - a, cy + b) - corner(cx + a, cy - b) +
           corner(cx - a, cy - b);
}

Maker rectScene() {
    Maker maker;
    maker.add(lambert(0.5f), 20, 0);
    Light panel;
    panel.type = LightType::Rect;
    panel.size = vec2(1.0f, 0.6f);
    panel.radiance = vec3(10);
    panel.castsShadows = false;
    maker.light(panel, glm::translate(dmat4(1), dvec3(0.2, 0.1, 1.5))); // shines along -Z
    return maker;
}

TEST_P(SurfaceLightTest, RectLightOnLambertIsExactInOneFrame) {
    Maker maker = rectScene();
    const Lit lit = draw(maker);
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            const dvec3 p = pointUnder(x, y);
            const double expected = 0.5 * 10 * rectFactor(0.2 - p.x, 0.1 - p.y, 0.5, 0.3, 1.5);
            EXPECT_NEAR(double(lit.direct.at(x, y)[0]) / expected, 1, 2e-3) << x << ", " << y;
        }
}

TEST_P(SurfaceLightTest, RectLightOnLambertConvergesToTheSame) {
    Maker maker = rectScene();
    // A point of the light a frame, the same for all pixels: 192 points leave an error of one or two percent.
    const Lit lit = draw(maker, {.frames = 192});
    for (int y = 0; y < kSize; y += 3)
        for (int x = 0; x < kSize; x += 3) {
            const dvec3 p = pointUnder(x, y);
            const double expected = 0.5 * 10 * rectFactor(0.2 - p.x, 0.1 - p.y, 0.5, 0.3, 1.5);
            EXPECT_NEAR(double(lit.direct.at(x, y)[0]) / expected, 1, 2e-2) << x << ", " << y;
        }
}

TEST_P(SurfaceLightTest, WhiteLambertInAWhiteEnvironmentIsWhite) {
    Maker maker;
    maker.add(lambert(1), 5, 0);
    maker.scene.environment.radiance = vec3(1, 2, 4);
    // 256 frames of 64 lights without shadows: nothing is in the way, and what is tested is the sum.
    expectDone(registry_.assign("shadows.enabled=false"));
    expectDone(registry_.assign("environment.lights=64"));
    const Lit lit = draw(maker, {.frames = 256});
    for (int channel = 0; channel < 3; ++channel)
        EXPECT_NEAR(centre(lit.direct, channel) / (1 << channel), 1, 2e-3);
    EXPECT_NEAR(centre(draw(maker).direct), 1, 0.03); // one frame of 64 fixed lights
    // The plane does not shade itself.
    expectDone(registry_.assign("shadows.enabled=true"));
    expectDone(registry_.assign("environment.lights=16"));
    // 512 directions: 4 max(0, cos) has the standard deviation 1.3, so 0.057 is one standard error of independent ones, and they
    // are better than independent: one in each of 16 regions a frame.
    EXPECT_NEAR(centre(draw(maker, {.frames = 32}).direct), 1, 0.057);
}

/// ∫ V·D·cosine of a white metal over the hemisphere, in double, by the half vector.
double metalAlbedo(double roughness, double cosView) {
    const dvec3 view(std::sqrt(1 - cosView * cosView), 0, cosView);
    const double a = roughness * roughness, a2 = a * a;
    constexpr int kSteps = 500;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double t = (i + 0.5) / kSteps * 0.5 * kPi, polar = std::atan(a * std::tan(t));
        const double stretch = a / (std::cos(t) * std::cos(t) + a2 * std::sin(t) * std::sin(t));
        for (int j = 0; j < kSteps; ++j) {
            const double azimuth = (j + 0.5) / kSteps * kPi;
            const dvec3 half(std::sin(polar) * std::cos(azimuth),
                             std::sin(polar) * std::sin(azimuth), std::cos(polar));
            const dvec3 light = 2 * glm::dot(view, half) * half - view;
            if (light.z <= 0 || glm::dot(view, half) <= 0) continue;
            const double d = a2 / (kPi * std::pow(half.z * half.z * (a2 - 1) + 1, 2));
            const double visibility =
                1 / ((light.z + std::sqrt(a2 + (1 - a2) * light.z * light.z)) *
                     (view.z + std::sqrt(a2 + (1 - a2) * view.z * view.z)));
            sum += d * visibility * light.z * 4 * glm::dot(view, half) * std::sin(polar) * stretch;
        }
    }
    return sum * (0.5 * kPi / kSteps) * (2 * kPi / kSteps);
}

TEST_P(SurfaceLightTest, WhiteMetalInAWhiteEnvironmentShowsItsAlbedoAtEveryRoughness) {
    // Across all roughnesses, so that no share of the environment's light is counted by both map and lights, or by neither.
    expectDone(registry_.assign("shadows.enabled=false"));
    expectDone(registry_.assign("environment.lights=64"));
    for (const float roughness : {0.05f, 0.25f, 0.4f, 0.65f, 1.0f}) {
        SCOPED_TRACE(::testing::Message() << "roughness " << roughness);
        Maker maker;
        Material metal;
        metal.roughness = roughness;
        maker.add(metal, 5, 0);
        maker.scene.environment.radiance = vec3(1);
        const double tilt = 0.6, expected = metalAlbedo(double(roughness), std::cos(tilt));
        EXPECT_NEAR(centre(draw(maker, {.frames = 64, .tilt = tilt}).direct) / expected, 1, 0.03);
        EXPECT_NEAR(centre(draw(maker, {.tilt = tilt}).direct) / expected, 1, 0.15);
    }
}

TEST_P(SurfaceLightTest, TheEnvironmentIsSeenWhereTheInterfacePutsIt) {
    // Four columns, from the left: +Z..-X, -X..-Z, -Z..+X, +X..+Z (u = 0.5 is -Z); upper and lower row.
    auto image = std::make_shared<Image>(64, 32, 3);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x) image->at(x, y)[0] = float(1 + x / 16 + (y / 16) * 4);
    Maker maker;
    maker.scene.environment.image = image;
    maker.scene.environment.intensity = 2;
    const Lit lit = draw(maker, {.perspective = true});
    // Ahead is -Z; right of it (+X side) lies the third column, left the second; up the first row.
    EXPECT_FLOAT_EQ(lit.emission.at(2, 2)[0], 2 * 2);
    EXPECT_FLOAT_EQ(lit.emission.at(13, 2)[0], 2 * 3);
    EXPECT_FLOAT_EQ(lit.emission.at(2, 13)[0], 2 * 6);
    EXPECT_FLOAT_EQ(lit.emission.at(13, 13)[0], 2 * 7);
    EXPECT_EQ(lit.directStatus, "skipped: no surface in the scene");
}

Material pane(float alpha, float emissive) {
    Material material = lambert(0);
    material.baseColor.w = alpha;
    material.alphaMode = AlphaMode::Blend;
    material.emissive = vec3(emissive);
    return material;
}

TEST_P(SurfaceLightTest, BlendedSurfacesLieOverEachOtherByDepthNotByOrder) {
    for (const bool swapped : {false, true}) {
        Maker maker;
        Material back = lambert(0);
        back.emissive = vec3(8);
        maker.add(back, 20, 0);
        maker.add(pane(0.25f, 4), 20, swapped ? 2.0f : 1.0f);
        maker.add(pane(0.5f, 2), 20, swapped ? 1.0f : 2.0f);
        const Lit lit = draw(maker);
        const double first = 0.75 * 8 + 0.25 * 4, second = 0.5 * 8 + 0.5 * 2;
        EXPECT_NEAR(centre(lit.emission),
                    swapped ? 0.75 * second + 0.25 * 4 : 0.5 * first + 0.5 * 2, 1e-5);
        EXPECT_EQ(lit.blendStatus, "ran");
    }
}

TEST_P(SurfaceLightTest, BlendedSurfacesAreLitLikeOthersAndHiddenByThem) {
    Maker maker;
    maker.add(lambert(0.5f), 20, 0);
    Material glass = lambert(0.8f);
    glass.baseColor.w = 0.25f;
    glass.alphaMode = AlphaMode::Blend;
    maker.add(glass, 20, 1);
    maker.add(pane(1, 100), 20, -1); // behind the wall
    Light sun;
    sun.type = LightType::Directional;
    sun.intensity = 10;
    sun.castsShadows = false;
    maker.light(sun, dmat4(1));
    const Lit lit = draw(maker);
    EXPECT_NEAR(centre(lit.direct), 0.75 * 0.5 * 10 / kPi + 0.25 * 0.8 * 10 / kPi, 1e-3);
    EXPECT_EQ(centre(lit.emission), 0.0);
}

TEST_P(SurfaceLightTest, BlendedSurfacesLieAtTheirDepthInTheMedia) {
    constexpr double kScatter = 0.05, kAbsorb = 0.1, kEmit = 0.3, kLux = 10;
    Maker maker;
    Material wall = lambert(0.5f);
    wall.emissive = vec3(8);
    maker.add(wall, 20, 0);
    Material glass = lambert(0.8f);
    glass.baseColor.w = 0.25f;
    glass.alphaMode = AlphaMode::Blend;
    glass.emissive = vec3(4);
    maker.add(glass, 20, 4);
    Medium fog;
    fog.kind =
        MediumKind::Box; // from z = -6 to z = 6, wider than the view; the camera is at z = 10
    fog.size = dvec3(100, 100, 12);
    fog.scattering = vec3(float(kScatter));
    fog.absorption = vec3(float(kAbsorb));
    fog.emission = vec3(float(kEmit));
    maker.scene.media.push_back(fog);
    Node node;
    node.medium = 0;
    maker.scene.nodes.push_back(node);
    Light sun;
    sun.type = LightType::Directional;
    sun.intensity = float(kLux);
    sun.castsShadows = false;
    maker.light(sun, dmat4(1)); // with the camera, along -Z
    const Lit lit = draw(maker);
    const double sigma = kScatter + kAbsorb, wallDepth = 6,
                 glassDepth = 2; // metres of fog before each, for eye and light alike
    const auto through = [&](double d) { return std::exp(-sigma * d); };
    const auto emitted = [&](double d) { return kEmit * (1 - through(d)) / sigma; };
    // Isotropic single scattering with light and eye on the same side: e^{-2σt} along the way.
    const auto scattered = [&](double d) {
        return kScatter * kLux / (4 * kPi) * (1 - std::exp(-2 * sigma * d)) / (2 * sigma);
    };
    const auto reflected = [&](double albedo, double d) {
        return albedo / kPi * kLux * std::exp(-2 * sigma * d);
    };
    const auto blended = [](double behind, double before) { return 0.75 * behind + 0.25 * before; };
    const double emission = blended(8 * through(wallDepth) + emitted(wallDepth),
                                    4 * through(glassDepth) + emitted(glassDepth));
    EXPECT_NEAR(centre(lit.emission) / emission, 1, 1e-3);
    EXPECT_NEAR(centre(lit.direct) / blended(reflected(0.5, wallDepth), reflected(0.8, glassDepth)),
                1, 1e-3);
    ASSERT_FALSE(lit.inScatter.pixels.empty());
    EXPECT_NEAR(centre(lit.inScatter) / blended(scattered(wallDepth), scattered(glassDepth)), 1,
                3e-2); // one frame's noise
}

TEST_P(SurfaceLightTest, WhatIsNotNeededIsSkippedWithItsReason) {
    Maker maker;
    maker.add(lambert(0.5f), 20, 0);
    Lit lit = draw(maker);
    EXPECT_EQ(lit.directStatus, "skipped: no light in the scene");
    EXPECT_EQ(lit.blendStatus, "skipped: no blended surface in the scene");
    maker.scene.environment.radiance = vec3(1);
    lit = draw(maker, {.terms = bit(Term::LE)});
    EXPECT_EQ(lit.directStatus, "skipped: the term LSE is not rendered");
    lit = draw(maker, {.terms = bit(Term::LSE)});
    EXPECT_EQ(lit.emissionStatus, "skipped: the term LE is not rendered");
}

} // namespace
} // namespace tyndall::test
