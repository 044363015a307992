// The media's passes in a frame graph: pictures against double precision, what is kept, what is skipped and why.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <random>

#include <glm/gtc/matrix_transform.hpp>

#include "gl/gl_fixture.h"
#include "media/segment_integral.h"
#include "renderer/medium_march_pass.h"
#include "renderer/optical_depth_pass.h"
#include "renderer/view.h"
#include "shaders/media_compute.h"
#include "support/content.h"

namespace tyndall::test {
namespace {

class MediaPasses : public GlTest {
protected:
    void SetUp() override {
        GlTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        library = std::make_unique<gl::ShaderLibrary>();
        executor = std::make_unique<fg::Executor>(*library);
        system = std::make_unique<MediaSystem>(*executor);
        camera.yfov = 0.6;
    }
    void TearDown() override {
        if (system && lightBuffer.id) executor->release(lightBuffer);
        system.reset();
        executor.reset();
        library.reset();
        GlTest::TearDown();
    }

    struct Picture {
        Image transmittance, inScatter, emission; // empty where the pass made none
        fg::PassStatus march{}, opticalDepth{};
        std::string marchReason, opticalDepthReason;
        double marchMs = -1, opticalDepthMs = -1, upsampleMs = -1;
    };

    Picture render(const Scene& scene, int width, int height, bool inScatter = true) {
        EXPECT_TRUE(system->update(scene, dvec3(0)).ok());
        const ViewResources view = makeView(
            {&camera, worldFromCamera, dvec3(0), 10, width, height, frameIndex, 0, converge});
        const std::vector<Bounds> surfaces =
            surface.empty() ? std::vector<Bounds>{} : std::vector<Bounds>{surface};
        uploadLights();
        fg::FrameGraph& graph = executor->beginFrame();
        MediaFrame frame = system->beginFrame(graph, {&view, surfaces, lights, false});
        addOpticalDepthPass(graph, *system, frame);
        MediumMarchInputs inputs{
            view,
            addImage(graph, "depth", fg::texture2D(fg::Format::R32F, width, height)),
            {},
            inScatter,
            true};
        inputs.lights.lights = graph.importBuffer(
            "lights", lightBuffer, {std::max<size_t>(lights.size(), 1) * sizeof(gpu::LightData)},
            lightVersion);
        inputs.lights.shadowViews = inputs.lights.lights; // no light names one
        inputs.lights.shadowAtlas =
            addImage(graph, "shadows", {fg::TextureKind::Tex2DArray, fg::Format::R32F, 1, 1, 1, 1});
        inputs.lights.lightCount = uint32_t(lights.size());
        const MediumMarch march = addMediumMarchPass(graph, frame, inputs);
        for (const fg::TextureHandle handle :
             {march.transmittance, march.inScatter, march.emission})
            if (handle) graph.markOutput(handle);
        const Result<void> done = executor->execute();
        EXPECT_TRUE(done.ok()) << (done.ok() ? "" : done.message());
        Picture picture;
        if (march.transmittance) picture.transmittance = executor->readImage(march.transmittance);
        if (march.inScatter) picture.inScatter = executor->readImage(march.inScatter);
        if (march.emission) picture.emission = executor->readImage(march.emission);
        for (const fg::PassReport& pass : executor->report().passes) {
            if (pass.name == "media.march")
                picture.march = pass.status, picture.marchReason = pass.reason,
                picture.marchMs = pass.gpuMs;
            if (pass.name == "media.upsample") picture.upsampleMs = pass.gpuMs;
            if (pass.name == "media.opticalDepth")
                picture.opticalDepth = pass.status, picture.opticalDepthReason = pass.reason,
                picture.opticalDepthMs = pass.gpuMs;
        }
        return picture;
    }

    /// The ray through the centre of a pixel, row 0 at the top; there is no jitter.
    [[nodiscard]] RaySegment ray(int x, int y, int width, int height) const {
        const double t = std::tan(0.5 * camera.yfov);
        const dvec3 d((2 * (x + 0.5) / width - 1) * t * width / height,
                      (1 - 2 * (y + 0.5) / height) * t, -1);
        return {dvec3(worldFromCamera[3]), glm::normalize(dmat3(worldFromCamera) * d),
                std::numeric_limits<double>::infinity()};
    }

    void addSun(const vec3& direction) {
        gpu::LightData light{};
        light.type = gpu::kLightDirectional;
        light.direction = vec4(glm::normalize(direction), 0);
        light.intensity = vec4(10, 9, 8, 0);
        addLight(light);
    }
    void addLamp(const vec3& position, float range = 0) {
        gpu::LightData light{};
        light.type = gpu::kLightPoint;
        light.position = vec4(position, range);
        light.direction = vec4(0, -1, 0, 0);
        light.intensity = vec4(20, 20, 20, 1e-6f);
        light.axisY.w = -1;
        addLight(light);
    }
    void addLight(gpu::LightData light) {
        light.shadowIndex = -1;
        lights.push_back(light);
    }

    std::unique_ptr<gl::ShaderLibrary> library;
    std::unique_ptr<fg::Executor> executor;
    std::unique_ptr<MediaSystem> system;
    Camera camera;
    dmat4 worldFromCamera = glm::translate(dmat4(1.0), dvec3(0, 0, 5));
    std::vector<gpu::LightData> lights;
    Bounds surface;
    uint32_t frameIndex = 0;
    bool converge = false;

private:
    void uploadLights() {
        if (lightBuffer.id) executor->release(lightBuffer);
        const std::vector<gpu::LightData> none(1);
        lightBuffer = executor->registerBuffer(
            "lights",
            gl::Buffer("lights", std::as_bytes(std::span(lights.empty() ? none : lights))));
        lightVersion = nextVersion();
    }
    /// All zeros: as depth, no surface anywhere.
    static fg::TextureHandle addImage(fg::FrameGraph& graph, const char* name,
                                      const fg::TextureDesc& desc) {
        struct Data {
            fg::TextureHandle image;
        };
        return graph
            .addPass<Data>(
                name,
                [&](fg::Builder& builder, Data& data) {
                    data.image = builder.create(name, desc, fg::Access::TransferWrite);
                },
                [](const Data& data, fg::PassContext& context) {
                    const float nothing[4] = {0, 0, 0, 0};
                    context.clearTexture(data.image, nothing);
                })
            .image;
    }
    fg::StaticBuffer lightBuffer;
    Version lightVersion = 0;
};
TYNDALL_GL_TESTS(MediaPasses);

/// A ball of noise, denser inside, about two metres wide, with empty bricks around.
Medium puff() {
    constexpr int kSize = 40;
    std::mt19937_64 engine(seed());
    std::uniform_real_distribution<float> noise(0.5f, 1.5f);
    std::vector<float> voxels(kSize * kSize * kSize);
    for (int z = 0; z < kSize; ++z)
        for (int y = 0; y < kSize; ++y)
            for (int x = 0; x < kSize; ++x) {
                const double r = glm::length(dvec3(x, y, z) - 19.5) / 19.0;
                voxels[size_t((z * kSize + y) * kSize + x)] =
                    r < 1 ? float(1 - r) * noise(engine) : 0.0f;
            }
    Medium medium;
    medium.name = "puff";
    medium.kind = MediumKind::Grid;
    medium.scattering = vec3(3, 2, 1);
    medium.absorption = vec3(0.2f, 0.3f, 0.9f);
    medium.density = std::make_shared<BrickGrid>(
        makeBrickGrid(voxels, ivec3(0), ivec3(kSize),
                      glm::translate(glm::scale(dmat4(1.0), dvec3(0.05)), dvec3(-19.5))));
    return medium;
}

Medium mediumBox(const dvec3& size) {
    Medium medium;
    medium.name = "box";
    medium.kind = MediumKind::Box;
    medium.size = size;
    medium.scattering = vec3(0.4f);
    medium.absorption = vec3(0.1f);
    return medium;
}

Scene sceneWith(std::vector<Medium> media, std::vector<dmat4> world) {
    Scene scene = sceneOf(media, world);
    scene.versions.media = scene.versions.transforms = scene.versions.structure = nextVersion();
    return scene;
}

double meanDifference(const Image& a, const Image& b) {
    double difference = 0, sum = 0;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x)
            for (int c = 0; c < 3; ++c) {
                difference += std::abs(double(a.at(x, y)[c]) - double(b.at(x, y)[c]));
                sum += double(b.at(x, y)[c]);
            }
    return difference / sum;
}

TEST_P(MediaPasses, TransmittanceOfGridsIsExactInExactMode) {
    const Medium medium = puff();
    const dmat4 world = glm::rotate(glm::scale(dmat4(1.0), dvec3(1, 0.7, 1.3)), 0.6,
                                    glm::normalize(dvec3(1, 2, 0)));
    const Scene scene = sceneWith({medium}, {world});
    system->settings().integration = MediaIntegration::Exact;
    addSun(vec3(0, -1, 0));
    for (const bool inScatter :
         {true, false}) { // the march, and the pass that computes transmittance alone
        const Picture picture = render(scene, 40, 30, inScatter);
        ASSERT_EQ(picture.transmittance.width, 40);
        for (int y = 0; y < 30; ++y)
            for (int x = 0; x < 40; ++x) {
                const dvec3 depth = opticalDepth(medium, world, ray(x, y, 40, 30));
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(double(picture.transmittance.at(x, y)[c]), std::exp(-depth[c]),
                                1e-4)
                        << x << " " << y;
            }
    }
}

TEST_P(MediaPasses, LightVolumesAgreeWithMarchingToTheLights) {
    const Scene scene = sceneWith({puff()}, {dmat4(1.0)});
    MediaSettings& settings = system->settings();
    const std::vector<std::function<void()>> setups{
        [&] { addSun(vec3(0.3f, -1, -0.2f)); },  // parallel
        [&] { addLamp(vec3(2, 3, 1)); },         // a cone
        [&] { addLamp(vec3(0.1f, 0.2f, 0.3f)); } // octahedral: inside the grid
    };
    for (const auto& setup : setups) {
        lights.clear();
        setup();
        settings.opticalDepthResolution = 96;
        settings.lightOpticalDepth = LightOpticalDepth::Volume;
        const Picture volume = render(scene, 32, 24);
        EXPECT_EQ(volume.opticalDepth, fg::PassStatus::Ran) << volume.opticalDepthReason;
        settings.lightOpticalDepth = LightOpticalDepth::Exact;
        const Picture marched = render(scene, 32, 24);
        EXPECT_EQ(marched.opticalDepth, fg::PassStatus::Skipped);
        EXPECT_EQ(marched.opticalDepthReason,
                  "grids are marched for every point (media.lightOpticalDepth)");
        EXPECT_LT(meanDifference(volume.inScatter, marched.inScatter), 0.02);
    }
}

TEST_P(MediaPasses, LightVolumesAreKeptUntilSomethingChanges) {
    Scene scene = sceneWith({puff()}, {dmat4(1.0)});
    addSun(vec3(0, -1, 0));
    EXPECT_EQ(render(scene, 16, 12).opticalDepth, fg::PassStatus::Ran);
    EXPECT_EQ(render(scene, 16, 12).opticalDepth, fg::PassStatus::Cached);
    worldFromCamera = glm::translate(dmat4(1.0), dvec3(0, 0.2, 4.5));
    EXPECT_EQ(render(scene, 16, 12).opticalDepth, fg::PassStatus::Cached);
    lights[0].direction = vec4(glm::normalize(vec3(0.1f, -1, 0)), 0);
    EXPECT_EQ(render(scene, 16, 12).opticalDepth, fg::PassStatus::Ran);
    scene.nodes[0].matrix = glm::translate(dmat4(1.0), dvec3(0.1, 0, 0));
    scene.versions.transforms = nextVersion();
    EXPECT_EQ(render(scene, 16, 12).opticalDepth, fg::PassStatus::Ran);
    EXPECT_EQ(render(scene, 16, 12).opticalDepth, fg::PassStatus::Cached);
}

TEST_P(MediaPasses, AGridOfTheSameShapeIsSeenAtOnce) {
    Scene scene = sceneWith({puff()}, {dmat4(1.0)});
    addSun(vec3(0, -1, 0));
    const Picture one = render(scene, 16, 12);
    const Version version = system->version();
    // The same bricks with the same bounds; in each the samples lie the other way round.
    auto other = std::make_shared<BrickGrid>(*scene.media[0].density);
    for (auto first = other->samples.begin(); first != other->samples.end();
         first += kBrickSampleCount)
        std::reverse(first, first + kBrickSampleCount);
    scene.media[0].density = other;
    scene.versions.media = nextVersion();
    const Picture two = render(scene, 16, 12);
    EXPECT_NE(system->version(), version);
    EXPECT_EQ(two.opticalDepth, fg::PassStatus::Ran);
    EXPECT_NE(one.transmittance.pixels, two.transmittance.pixels);
}

TEST_P(MediaPasses, ReducedResolutionsAreCloseAndTransmittanceIsNot) {
    const Scene scene = sceneWith({puff(), mediumBox(dvec3(4, 0.5, 4))},
                                  {dmat4(1.0), glm::translate(dmat4(1.0), dvec3(0, -1, 0))});
    addSun(vec3(0.3f, -1, -0.2f));
    addLamp(vec3(1.5f, 0.5f, 1));
    MediaSettings& settings = system->settings();
    settings.integration = MediaIntegration::Exact;
    const Picture full = render(scene, 96, 72);
    for (const auto& [resolution, tolerance] :
         {std::pair(MarchResolution::Half, 0.05), std::pair(MarchResolution::Quarter, 0.12)}) {
        settings.resolution = resolution;
        const Picture reduced = render(scene, 96, 72);
        EXPECT_LT(meanDifference(reduced.inScatter, full.inScatter), tolerance);
        EXPECT_LT(meanDifference(reduced.transmittance, full.transmittance),
                  1e-5); // computed for every pixel
    }
}

/// Mean difference of a pixel from its four neighbours, over the mean: a pattern of dots has much of it.
double roughness(const Image& image) {
    double rough = 0, sum = 0;
    for (int y = 1; y + 1 < image.height; ++y)
        for (int x = 1; x + 1 < image.width; ++x) {
            const double around = double(image.at(x - 1, y)[0]) + double(image.at(x + 1, y)[0]) +
                                  double(image.at(x, y - 1)[0]) + double(image.at(x, y + 1)[0]);
            rough += std::abs(0.25 * around - double(image.at(x, y)[0]));
            sum += double(image.at(x, y)[0]);
        }
    return rough / sum;
}

TEST_P(MediaPasses, SingleFramesOfFogHaveNoPattern) {
    const Scene scene = sceneWith({mediumBox(dvec3(6))}, {dmat4(1.0)});
    addLamp(vec3(0.5f, 0.5f, 1));
    MediaSettings& settings = system->settings();
    settings.steps = 6;
    for (const MarchResolution resolution : {MarchResolution::Full, MarchResolution::Half}) {
        settings.resolution = resolution;
        settings.smooth = false;
        const Image rough = render(scene, 96, 72).inScatter;
        settings.smooth = true;
        const Image smooth = render(scene, 96, 72).inScatter;
        // Of the pattern a ninth is left, and the light's own shape in so small a picture.
        EXPECT_LT(roughness(smooth), 0.5 * roughness(rough)) << int(resolution);
        double sum = 0, expected = 0;
        for (int y = 0; y < 72; ++y)
            for (int x = 0; x < 96; ++x)
                sum += double(smooth.at(x, y)[0]), expected += double(rough.at(x, y)[0]);
        // At the picture's border and the box's outline a mean over neighbours is not of all sides.
        EXPECT_NEAR(sum / expected, 1, 0.01) << int(resolution);
    }
}

TEST_P(MediaPasses, OnlyFogInSingleFramesIsSmoothed) {
    addLamp(vec3(1.5f, 0.5f, 1));
    MediaSettings& settings = system->settings();
    const auto bothWays = [&](const Scene& scene, bool averaged) {
        converge = averaged;
        settings.smooth = false;
        const Image rough = render(scene, 64, 48).inScatter;
        settings.smooth = true;
        return std::pair(rough, render(scene, 64, 48).inScatter);
    };
    const auto [grid, smoothGrid] = bothWays(sceneWith({puff()}, {dmat4(1.0)}), false);
    EXPECT_EQ(meanDifference(smoothGrid, grid), 0) << "no fog: nothing to smooth";
    const auto [fog, smoothFog] = bothWays(sceneWith({mediumBox(dvec3(3))}, {dmat4(1.0)}), true);
    EXPECT_EQ(meanDifference(smoothFog, fog), 0);
    const auto [frame, smoothFrame] =
        bothWays(sceneWith({mediumBox(dvec3(3))}, {dmat4(1.0)}), false);
    EXPECT_GT(meanDifference(smoothFrame, frame), 1e-3);
}

TEST_P(MediaPasses, ListsOfLightsLoseNothing) {
    const Scene scene = sceneWith({mediumBox(dvec3(3))}, {dmat4(1.0)});
    std::mt19937_64 engine(seed());
    std::uniform_real_distribution<float> place(-1.5f, 1.5f);
    std::vector<gpu::LightData> all;
    for (int i = 0; i < 30; ++i)
        addLamp(vec3(place(engine), place(engine), place(engine)), 0.2f + 0.05f * float(i));
    all.swap(lights);
    lights = all;
    const Image together = render(scene, 50, 38).inScatter; // not whole groups of 8×8
    lights.assign(all.begin(), all.begin() + 15);           // few enough that no list is made
    const Image first = render(scene, 50, 38).inScatter;
    lights.assign(all.begin() + 15, all.end());
    const Image second = render(scene, 50, 38).inScatter;
    for (int y = 0; y < 38; ++y)
        for (int x = 0; x < 50; ++x) {
            const double sum = double(first.at(x, y)[0]) + double(second.at(x, y)[0]);
            EXPECT_NEAR(double(together.at(x, y)[0]), sum, 1e-5 * sum + 1e-12) << x << " " << y;
        }
}

TEST_P(MediaPasses, TurnsOfAMarchLoseNothing) {
    // Cell by cell, with each light's way through the cells: more rounds of loops than a driver may allow (plugin/shader_rounds.h), but for one light alone.
    const Scene scene = sceneWith({puff()}, {dmat4(1.0)});
    system->settings().integration = MediaIntegration::Exact;
    system->settings().lightOpticalDepth = LightOpticalDepth::Exact;
    system->settings().smooth = false;
    std::mt19937_64 engine(seed());
    std::uniform_real_distribution<float> place(-3, 3);
    for (int i = 0; i < 12; ++i) addLamp(vec3(place(engine), place(engine), place(engine)));
    const std::vector<gpu::LightData> all = lights;
    for (const MarchResolution resolution : {MarchResolution::Full, MarchResolution::Half}) {
        system->settings().resolution = resolution;
        lights = all;
        const Image together = render(scene, 24, 18).inScatter;
        std::vector<double> sum(24 * 18, 0.0);
        for (const gpu::LightData& light : all) {
            lights = {light};
            const Image alone = render(scene, 24, 18).inScatter;
            for (size_t i = 0; i < sum.size(); ++i)
                sum[i] += double(alone.at(int(i % 24), int(i / 24))[0]);
        }
        // Rounding alone: sums of floats over some hundred segments, in another order.
        for (size_t i = 0; i < sum.size(); ++i)
            EXPECT_NEAR(double(together.at(int(i % 24), int(i / 24))[0]), sum[i],
                        1e-4 * sum[i] + 1e-12)
                << i << ", resolution " << int(resolution) << ", seed " << seed();
    }
}

TEST_P(MediaPasses, SaysWhyNothingIsMarched) {
    addSun(vec3(0, -1, 0));
    EXPECT_EQ(render(Scene{}, 8, 8).marchReason, "no medium in the scene");
    Medium vacuum = mediumBox(dvec3(1));
    vacuum.scattering = vacuum.absorption = vec3(0);
    EXPECT_EQ(render(sceneWith({vacuum}, {dmat4(1.0)}), 8, 8).marchReason,
              "no visible medium absorbs, scatters or emits");
    // Behind the camera, with nothing in view that it could shade.
    const dmat4 behind = glm::translate(dmat4(1.0), dvec3(0, 0, 20));
    EXPECT_EQ(render(sceneWith({mediumBox(dvec3(1))}, {behind}), 8, 8).marchReason,
              "no medium in view or on a light's path");
    // Above the view, between the sun and a surface in view.
    surface.include(dvec3(-1, -1, -1));
    surface.include(dvec3(1, 1, 1));
    const dmat4 above = glm::translate(dmat4(1.0), dvec3(0, 20, 0));
    EXPECT_EQ(render(sceneWith({mediumBox(dvec3(1))}, {above}), 8, 8).marchReason,
              "no medium in view");
    const dmat4 aside = glm::translate(dmat4(1.0), dvec3(20, 0, 0));
    EXPECT_EQ(render(sceneWith({mediumBox(dvec3(1))}, {aside}), 8, 8).marchReason,
              "no medium in view or on a light's path");
    system->settings().enabled = false;
    EXPECT_EQ(render(sceneWith({mediumBox(dvec3(1))}, {dmat4(1.0)}), 8, 8).marchReason,
              "setting media.enabled is off");
    system->settings().enabled = true;
    Medium smoke = mediumBox(dvec3(1));
    smoke.scattering = vec3(0);
    const Picture dark = render(sceneWith({smoke}, {dmat4(1.0)}), 8, 8);
    EXPECT_EQ(dark.marchReason, "no medium in view scatters or emits");
    EXPECT_LT(dark.transmittance.at(4, 4)[0], 1.0f); // it still absorbs
    lights.clear();
    const Picture unlit = render(sceneWith({mediumBox(dvec3(1))}, {dmat4(1.0)}), 8, 8);
    EXPECT_EQ(unlit.marchReason,
              "media add no light: LVE is not wanted or there is no light in the scene");
}

TEST_P(MediaPasses, DroppedMediaLeaveThePictureBitIdentical) {
    std::mt19937_64 engine(seed());
    const auto uniform = [&](double a, double b) {
        return std::uniform_real_distribution<double>(a, b)(engine);
    };
    addSun(vec3(0.3f, -1, -0.2f));
    addLamp(vec3(1, 2, 1), 6);
    int dropped = 0;
    for (int i = 0; i < 12; ++i) {
        std::vector<Medium> media{mediumBox(dvec3(1))};
        std::vector<dmat4> world{dmat4(1.0)};
        for (int k = 0; k < 6; ++k) {
            media.push_back(mediumBox(dvec3(uniform(0.5, 2), uniform(0.5, 2), uniform(0.5, 2))));
            world.push_back(
                glm::rotate(glm::translate(dmat4(1.0), dvec3(uniform(-15, 15), uniform(-15, 15),
                                                             uniform(-15, 15))),
                            uniform(0, 3), dvec3(0, 1, 0)));
        }
        const Scene scene = sceneWith(media, world);
        system->settings().dropUnseen = true;
        const Picture with = render(scene, 24, 18);
        system->settings().dropUnseen = false;
        const Picture without = render(scene, 24, 18);
        std::vector<std::string> notes;
        const std::vector<PlacedMedium> placed = placeMedia(scene, dvec3(0), notes);
        const ViewResources view =
            makeView({&camera, worldFromCamera, dvec3(0), 10, 24, 18, 0, 0, false});
        for (const MediumUse use : classifyMedia(placed, {&view.data, {}, lights}))
            dropped += use == MediumUse::Dropped;
        for (const auto& [a, b] : {std::pair(&with.inScatter, &without.inScatter),
                                   std::pair(&with.transmittance, &without.transmittance)})
            for (int y = 0; y < 18; ++y)
                for (int x = 0; x < 24; ++x)
                    ASSERT_EQ(std::memcmp(a->at(x, y), b->at(x, y), 3 * sizeof(float)), 0)
                        << i << ": " << x << " " << y;
    }
    EXPECT_GT(dropped, 10) << "the scenes must have media to drop";
}

} // namespace
} // namespace tyndall::test
