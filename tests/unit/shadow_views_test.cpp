#include "renderer/shadow_views.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <glm/gtc/matrix_transform.hpp>

#include "renderer/view.h"
#include "support/content.h"

namespace tyndall {
namespace {

ShadowSettings defaultSettings() {
    ShadowSettings settings{};
    SettingsRegistry registry;
    registry.add({shadowSettingsTable(), &settings});
    settings.cascades = 4;
    return settings;
}

ViewResources viewFrom(const dvec3& eye, double yaw, double sceneRadius, bool converge = false,
                       uint32_t frame = 0) {
    Camera camera;
    camera.znear = 0.01 * sceneRadius;
    ViewRequest request;
    request.camera = &camera;
    request.worldFromCamera =
        glm::translate(dmat4(1), eye) * glm::rotate(dmat4(1), yaw, dvec3(0, 1, 0));
    request.sceneRadius = sceneRadius;
    request.width = 160;
    request.height = 90;
    request.converge = converge;
    request.frameIndex = frame;
    return makeView(request);
}

gpu::LightData directional(const vec3& travel) {
    gpu::LightData light{};
    light.type = gpu::kLightDirectional;
    light.direction = vec4(glm::normalize(travel), 0);
    light.intensity = vec4(1, 1, 1, 0);
    return light;
}

gpu::LightData local(uint32_t type, const vec3& position, const vec3& direction = {0, 0, -1},
                     float outer = 0.5f) {
    gpu::LightData light{};
    light.type = type;
    light.position = vec4(position, 0);
    light.direction = vec4(glm::normalize(direction), 0);
    light.axisY.w = std::cos(outer);
    return light;
}

Bounds cube(double half) {
    Bounds bounds;
    bounds.include(dvec3(-half));
    bounds.include(dvec3(half));
    return bounds;
}

/// Texture coordinates and depth of a point.
dvec3 project(const gpu::ShadowView& view, const dvec3& p) {
    const dvec4 t = dmat4(view.shadowFromRender) * dvec4(p, 1);
    return dvec3(t) / t.w;
}

ShadowPlan plan(std::vector<gpu::LightData>& lights, const Bounds& casters,
                const ViewResources& view, const ShadowSettings& settings) {
    std::vector<uint32_t> all(lights.size());
    for (uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    return planShadows(lights, all, {{&casters, casters.empty() ? 0u : 1u}, casters, &view}, settings);
}

TEST(ShadowViews, LastCascadeHoldsAllCasters) {
    std::mt19937 random(uint32_t(test::seed()));
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int i = 0; i < 50; ++i) {
        std::vector<gpu::LightData> lights = {
            directional(vec3(float(unit(random)), float(unit(random)), float(unit(random))))};
        const ShadowPlan p =
            plan(lights, cube(10), viewFrom({unit(random) * 20, 0, 0}, unit(random), 10),
                 defaultSettings());
        ASSERT_GE(lights[0].shadowIndex, 0);
        ASSERT_EQ(size_t(p.views[0].count), p.views.size());
        const gpu::ShadowView& last = p.views.back();
        const double border = double(last.bias.w) / double(last.atlas.z);
        for (int k = 0; k < 100; ++k) {
            const dvec3 t = project(last, dvec3(unit(random), unit(random), unit(random)) * 10.0);
            for (int axis = 0; axis < 2; ++axis)
                EXPECT_TRUE(t[axis] > border && t[axis] < 1 - border) << t[axis];
            EXPECT_TRUE(t.z > 0 && t.z < 1) << t.z;
        }
        // Towards the light depth rises, by one over the range in metres a metre.
        const dvec3 toLight = -dvec3(lights[0].direction);
        EXPECT_NEAR(project(last, toLight).z - project(last, dvec3(0)).z, 1.0 / double(last.bias.z),
                    1e-6);
    }
}

TEST(ShadowViews, CascadesCoverTheViewUpToTheirDistance) {
    std::vector<gpu::LightData> lights = {directional({0.3f, -1.0f, 0.2f})};
    const ViewResources view = viewFrom({0, 0, 0}, 0.7, 100);
    const ShadowPlan p = plan(lights, cube(100), view, defaultSettings());
    ASSERT_EQ(p.views.size(), 4u);
    for (size_t i = 1; i < p.views.size(); ++i)
        EXPECT_LT(p.views[i - 1].bias.x, p.views[i].bias.x) << "nearer cascades are finer";
    // What the camera sees near by lies in the first cascade: 1.5 m ahead, across the picture.
    for (const double x : {-0.99, 0.0, 0.99})
        for (const double y : {-0.99, 0.0, 0.99}) {
            const dvec4 h = dmat4(view.data.renderFromClip) *
                            dvec4(x, y, double(view.data.cameraPosition.w) / 1.5, 1);
            const dvec3 t = project(p.views[0], dvec3(h) / h.w);
            EXPECT_TRUE(t.x > 0 && t.x < 1 && t.y > 0 && t.y < 1);
        }
}

TEST(ShadowViews, CascadesStayOnTheirTexelGridWhileTheCameraMoves) {
    std::mt19937 random(uint32_t(test::seed()));
    std::uniform_real_distribution<double> unit(-1, 1);
    std::vector<gpu::LightData> lights = {directional({0.3f, -1.0f, 0.2f})};
    const dvec3 point(1, 2, 3);
    const ShadowPlan before =
        plan(lights, cube(100), viewFrom({0, 0, 0}, 0, 100), defaultSettings());
    for (int i = 0; i < 40; ++i) {
        const ShadowPlan after =
            plan(lights, cube(100),
                 viewFrom(dvec3(unit(random), unit(random), unit(random)), unit(random) * 0.2, 100),
                 defaultSettings());
        ASSERT_EQ(after.views.size(), before.views.size());
        for (size_t v = 0; v < after.views.size(); ++v) {
            EXPECT_EQ(after.views[v].bias.x, before.views[v].bias.x)
                << "sizes do not follow small moves";
            const dvec3 moved = (project(after.views[v], point) - project(before.views[v], point)) *
                                double(after.views[v].atlas.z);
            EXPECT_NEAR(moved.x, std::round(moved.x), 0.02);
            EXPECT_NEAR(moved.y, std::round(moved.y), 0.02);
        }
    }
}

TEST(ShadowViews, SixFacesSeeEveryDirection) {
    std::mt19937 random(uint32_t(test::seed()));
    std::normal_distribution<double> normal;
    std::vector<gpu::LightData> lights = {local(gpu::kLightPoint, {1, 2, 3})};
    const ShadowPlan p = plan(lights, cube(10), viewFrom({0, 0, 20}, 0, 10), defaultSettings());
    ASSERT_EQ(p.views.size(), 6u);
    for (int i = 0; i < 500; ++i) {
        const dvec3 d = glm::normalize(dvec3(normal(random), normal(random), normal(random))) * 4.0;
        const dvec3 a = glm::abs(d);
        const int axis = a.x >= a.y && a.x >= a.z ? 0 : (a.y >= a.z ? 1 : 2);
        const gpu::ShadowView& view = p.views[size_t(2 * axis + (d[axis] < 0 ? 1 : 0))];
        const dvec3 t = project(view, dvec3(1, 2, 3) + d);
        const double border = double(view.bias.w) / double(view.atlas.z);
        EXPECT_TRUE(t.x > border && t.x < 1 - border && t.y > border && t.y < 1 - border)
            << t.x << " " << t.y;
        EXPECT_NEAR(t.z, double(view.bias.z) / a[axis], 1e-5 * t.z)
            << "near over distance along the axis";
    }
}

TEST(ShadowViews, SpotSeesItsConeAndWideSpotsAndRectsTheirSide) {
    std::vector<gpu::LightData> lights = {local(gpu::kLightSpot, {0, 5, 0}, {0, -1, 0}, 0.6f),
                                          local(gpu::kLightSpot, {0, 5, 0}, {0, -1, 0}, 1.4f),
                                          local(gpu::kLightRect, {0, 5, 0}, {0, -1, 0})};
    const ShadowPlan p = plan(lights, cube(10), viewFrom({0, 0, 20}, 0, 10), defaultSettings());
    const gpu::ShadowView& narrow = p.views[size_t(lights[0].shadowIndex)];
    EXPECT_EQ(narrow.count, 1);
    const dvec3 edge = project(narrow, dvec3(4 * std::tan(0.6), 1, 0));
    EXPECT_NEAR(std::hypot(edge.x - 0.5, edge.y - 0.5),
                0.5 * double(narrow.atlas.z - 8) / double(narrow.atlas.z), 1e-4);
    for (const size_t light : {size_t(1), size_t(2)}) {
        ASSERT_EQ(p.views[size_t(lights[light].shadowIndex)].count, 6);
        for (int face = 0; face < 6; ++face)
            EXPECT_EQ(p.views[size_t(lights[light].shadowIndex + face)].atlas.z > 0, face != 2)
                << "all but +Y, face " << face;
    }
}

TEST(ShadowViews, SquaresOfTheAtlasDoNotOverlap) {
    ShadowSettings settings = defaultSettings();
    for (const int atlasSize : {512, 2048}) {
        settings.atlasSize = atlasSize;
        settings.resolution = 512;
        settings.localResolution = 300;
        std::vector<gpu::LightData> lights;
        for (int i = 0; i < 5; ++i) lights.push_back(local(gpu::kLightPoint, vec3(float(i))));
        lights.push_back(directional({0, -1, 0.1f}));
        lights.push_back(local(gpu::kLightSpot, {0, 5, 0}));
        const ShadowPlan p = plan(lights, cube(10), viewFrom({0, 0, 20}, 0, 10), settings);
        ASSERT_GE(p.views.size(), 32u);
        EXPECT_LE(p.layers, settings.atlasLayers);
        for (size_t i = 0; i < p.views.size(); ++i) {
            const gpu::ShadowView& a = p.views[i];
            EXPECT_TRUE(a.atlas.x >= 0 && a.atlas.y >= 0 &&
                        a.atlas.x + a.atlas.z <= float(p.atlasSize) &&
                        a.atlas.y + a.atlas.z <= float(p.atlasSize));
            EXPECT_LT(a.layer, p.layers);
            for (size_t k = 0; k < i; ++k) {
                const gpu::ShadowView& b = p.views[k];
                const bool apart = a.layer != b.layer || a.atlas.x + a.atlas.z <= b.atlas.x ||
                                   b.atlas.x + b.atlas.z <= a.atlas.x ||
                                   a.atlas.y + a.atlas.z <= b.atlas.y ||
                                   b.atlas.y + b.atlas.z <= a.atlas.y;
                EXPECT_TRUE(apart) << i << " and " << k;
            }
        }
    }
}

TEST(ShadowViews, ShrinkAndThenDropWhatDoesNotFit) {
    ShadowSettings settings = defaultSettings();
    settings.atlasSize = 64;
    settings.atlasLayers = 1;
    std::vector<gpu::LightData> lights(2, local(gpu::kLightPoint, {1, 0, 0}));
    ShadowPlan p = plan(lights, cube(10), viewFrom({0, 0, 20}, 0, 10), settings);
    EXPECT_EQ(p.lightsDropped, 0);
    EXPECT_GT(p.shrunk, 0);
    EXPECT_EQ(p.views.size(), 12u); // of sixteen squares of 16 texels
    lights.resize(9, lights[0]);
    p = plan(lights, cube(10), viewFrom({0, 0, 20}, 0, 10), settings);
    EXPECT_EQ(p.lightsDropped, 7);
    EXPECT_EQ(lights[1].shadowIndex, 6);
    EXPECT_EQ(lights[2].shadowIndex, -1) << "the least important go first";
}

TEST(ShadowViews, DoNotDependOnTheScaleOfTheScene) {
    const double scales[] = {1e-3, 1, 1e3};
    std::vector<dvec3> found[3];
    for (int i = 0; i < 3; ++i) {
        const double s = scales[i];
        std::vector<gpu::LightData> lights = {directional({0.3f, -1.0f, 0.2f}),
                                              local(gpu::kLightPoint, vec3(float(s))),
                                              local(gpu::kLightSpot, vec3(float(s)), {1, -1, 0})};
        const ShadowPlan p =
            plan(lights, cube(10 * s), viewFrom({0, 0, 20 * s}, 0, 10 * s), defaultSettings());
        for (const gpu::ShadowView& view : p.views)
            found[i].push_back(project(view, dvec3(2.1, -3.2, 1.7) * s));
    }
    ASSERT_EQ(found[0].size(), found[1].size());
    ASSERT_EQ(found[2].size(), found[1].size());
    for (size_t v = 0; v < found[1].size(); ++v)
        for (const int i : {0, 2})
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(found[i][v][c], found[1][v][c],
                            2e-5 * std::max(1.0, std::abs(found[1][v][c])));
}

TEST(ShadowViews, KeysChangeWithTheirOwnLightAlone) {
    const ViewResources view = viewFrom({0, 0, 20}, 0, 10);
    std::vector<gpu::LightData> lights = {local(gpu::kLightPoint, {1, 0, 0}),
                                          local(gpu::kLightPoint, {0, 1, 0})};
    const ShadowPlan before = plan(lights, cube(10), view, defaultSettings());
    lights[1].position.x += 0.5f;
    const ShadowPlan after = plan(lights, cube(10), view, defaultSettings());
    for (size_t i = 0; i < 6; ++i) EXPECT_EQ(before.keys[i], after.keys[i]);
    for (size_t i = 6; i < 12; ++i) EXPECT_NE(before.keys[i], after.keys[i]);
}

TEST(ShadowViews, AveragedFramesShiftTheTexelGridByLessThanATexel) {
    std::vector<gpu::LightData> lights = {directional({0.3f, -1.0f, 0.2f}),
                                          local(gpu::kLightPoint, {1, 0, 0})};
    const ShadowPlan still = plan(lights, cube(10), viewFrom({0, 0, 20}, 0, 10), defaultSettings());
    dvec2 sum(0);
    const int frames = 64;
    for (int frame = 0; frame < frames; ++frame) {
        const ShadowPlan moved =
            plan(lights, cube(10), viewFrom({0, 0, 20}, 0, 10, true, uint32_t(frame)),
                 defaultSettings());
        const size_t last = size_t(still.views[0].count) - 1;
        const dvec3 shift =
            (project(moved.views[last], dvec3(1)) - project(still.views[last], dvec3(1))) *
            double(still.views[last].atlas.z);
        EXPECT_LE(std::abs(shift.x), 0.501);
        EXPECT_LE(std::abs(shift.y), 0.501);
        sum += dvec2(shift);
    }
    EXPECT_LT(glm::length(sum / double(frames)), 0.05) << "evenly over the texel";
}

TEST(ShadowViews, NothingCastsNothing) {
    std::vector<gpu::LightData> lights = {local(gpu::kLightPoint, {1, 0, 0})};
    EXPECT_TRUE(
        plan(lights, Bounds{}, viewFrom({0, 0, 20}, 0, 10), defaultSettings()).views.empty());
    EXPECT_EQ(lights[0].shadowIndex, -1);
    ShadowSettings off = defaultSettings();
    off.enabled = false;
    EXPECT_TRUE(plan(lights, cube(10), viewFrom({0, 0, 20}, 0, 10), off).views.empty());
}

} // namespace
} // namespace tyndall
