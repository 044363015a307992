// Directions, rays and light of rectangles and of the environment: shader functions against closed forms and double precision.

#include <cmath>
#include <random>

#include "gl/gl_fixture.h"
#include "renderer/environment_map.h"
#include "renderer/view.h"
#include "shaders/table_compute.h"
#include "support/content.h"

namespace tyndall::test {
namespace {

using GeometryShader = GlTest;
TYNDALL_GL_TESTS(GeometryShader);

dvec3 spherePoint(size_t i, size_t count) {
    const double z = 1 - (2.0 * double(i) + 1) / double(count),
                 azimuth = 2.399963229728653 * double(i);
    return {std::sqrt(1 - z * z) * std::cos(azimuth), std::sqrt(1 - z * z) * std::sin(azimuth), z};
}

double angleBetween(const dvec3& a, const dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

TEST_P(GeometryShader, OctahedralMapComesBackThroughSixteenBits) {
    std::vector<vec4> inputs;
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {1.0f, -1.0f}) {
            vec4 v(0);
            v[axis] = sign;
            inputs.push_back(v);
        }
    for (size_t i = 0; i < 5000; ++i) inputs.emplace_back(vec3(spherePoint(i, 5000)), 0);
    const std::vector<vec4> outputs = runOnGpu({"common/octahedral.glsl"}, R"(
        vec2 stored = floor(octahedralEncodeUnorm(inputs[id].xyz) * 65535.0 + 0.5) / 65535.0; // as RGBA16 holds it
        outputs[2u * id] = vec4(octahedralDecodeUnorm(stored), 0);
        outputs[2u * id + 1u] = vec4(octahedralDecode(octahedralEncode(inputs[id].xyz)), 0);)",
                                               inputs, 2 * inputs.size(), uint32_t(inputs.size()));
    double worst = 0, worstExact = 0;
    for (size_t i = 0; i < inputs.size(); ++i) {
        worst = std::max(worst, angleBetween(dvec3(vec3(inputs[i])), dvec3(vec3(outputs[2 * i]))));
        worstExact = std::max(
            worstExact, angleBetween(dvec3(vec3(inputs[i])), dvec3(vec3(outputs[2 * i + 1]))));
        // Axes are where most walls face: they come back to within a float's last digit.
        if (i < 6) {
            EXPECT_LT(angleBetween(dvec3(vec3(inputs[i])), dvec3(vec3(outputs[2 * i]))), 1e-6)
                << "axis " << i;
        }
    }
    // Half a step of both coordinates, 1.53e-5, moves the point of the octahedron by √6 times that, at 1/√3 from the centre.
    EXPECT_LT(worst, 6.5e-5);
    EXPECT_LT(worstExact, 1e-6);
}

/// A camera somewhere, and the view that the shaders get.
struct View {
    Camera camera;
    dmat4 worldFromCamera;
    ViewResources resources;
};
View makeTestView(CameraType type, double scale) {
    View view;
    view.camera.type = type;
    view.camera.yfov = 0.9;
    view.camera.ymag = 2.0 * scale;
    view.camera.znear = 0.01 * scale;
    view.worldFromCamera = glm::mat4_cast(glm::normalize(dquat(0.8, 0.2, -0.5, 0.1)));
    view.worldFromCamera[3] =
        dvec4(0.37, 0.41, -0.29,
              1); // render space: up to a metre from its origin, whatever the scene's scale
    ViewRequest request;
    request.camera = &view.camera;
    request.worldFromCamera = view.worldFromCamera;
    request.sceneRadius = 10 * scale;
    request.width = 64;
    request.height = 40;
    view.resources = makeView(request);
    return view;
}

class CameraRays : public GlTest {};
TYNDALL_GL_TESTS(CameraRays);

TEST_P(CameraRays, LeadToThePointsThatTheProjectionPutThere) {
    for (const CameraType type : {CameraType::Perspective, CameraType::Orthographic})
        for (const double scale : {1e-3, 1.0, 1e3}) {
            SCOPED_TRACE(::testing::Message()
                         << "camera type " << int(type) << ", scale " << scale);
            const View view = makeTestView(type, scale);
            const double aspect = 64.0 / 40.0, f = 1 / std::tan(0.45);
            std::mt19937 random{uint32_t(seed())};
            std::uniform_real_distribution<double> uniform(0, 1);
            std::vector<vec4> inputs;
            std::vector<dvec3> points, origins;
            for (int i = 0; i < 500; ++i) {
                const double x = 2 * uniform(random) - 1, y = 2 * uniform(random) - 1,
                             depth = scale * (0.02 + 8 * uniform(random));
                const bool parallel = type == CameraType::Orthographic;
                const dvec3 inCamera = parallel
                                           ? dvec3(x * 2 * scale * aspect, y * 2 * scale, -depth)
                                           : dvec3(x * aspect / f, y / f, -1) * depth;
                points.emplace_back(view.worldFromCamera * dvec4(inCamera, 1));
                origins.emplace_back(
                    view.worldFromCamera *
                    dvec4(parallel ? dvec3(inCamera.x, inCamera.y, 0) : dvec3(0), 1));
                const double stored =
                    parallel ? 1 - depth / (40 * scale) : view.camera.znear / depth;
                inputs.emplace_back(float((x * 0.5 + 0.5) * 64), float((y * 0.5 + 0.5) * 40),
                                    float(stored), 0);
            }
            const std::vector<vec4> outputs =
                runOnGpu({"common/view.glsl"}, R"(
                Ray ray = cameraRay(inputs[id].xy);
                outputs[3u * id] = vec4(ray.direction, rayDistanceFromDepth(inputs[id].xy, inputs[id].z));
                outputs[3u * id + 1u] = vec4(ray.origin, 0.0);
                outputs[3u * id + 2u] = vec4(renderPosition(inputs[id].xy, inputs[id].z), 0.0);)",
                         inputs, 3 * inputs.size(), uint32_t(inputs.size()),
                         {{"View", std::as_bytes(std::span(&view.resources.data, 1))}});
            for (size_t i = 0; i < points.size(); ++i) {
                const dvec3 expected = points[i] - origins[i];
                const double distance = glm::length(expected);
                EXPECT_LT(angleBetween(dvec3(vec3(outputs[3 * i])), expected), 2e-6);
                // An orthographic depth has a step of 6e-8 of the whole range.
                const double step = type == CameraType::Orthographic ? 40 * scale * 3e-7 : 0;
                EXPECT_NEAR(double(outputs[3 * i].w), distance, 2e-6 * distance + step);
                EXPECT_LT(glm::length(dvec3(vec3(outputs[3 * i + 2])) - points[i]),
                          3e-6 * (distance + 1) + step);
            }
        }
}

TEST_P(CameraRays, SkyIsFartherThanAnything) {
    const View view = makeTestView(CameraType::Perspective, 1);
    const std::vector<vec4> outputs =
        runOnGpu({"common/view.glsl"}, "outputs[0] = vec4(rayDistanceFromDepth(vec2(3.5), 0.0));",
                 {}, 1, 1, {{"View", std::as_bytes(std::span(&view.resources.data, 1))}});
    EXPECT_EQ(outputs[0].x, 1e30f);
}

/// ∫ cos / d² · cos over a rectangle in double, by the midpoint rule; `normal` is the receiver's, the receiver at the origin.
double rectByQuadrature(const dvec3& centre, const dvec3& x, const dvec3& y, const dvec3& facing,
                        const dvec3& normal) {
    constexpr int kSteps = 400;
    const double area = 4 * glm::length(glm::cross(x, y)) / (double(kSteps) * kSteps);
    double sum = 0;
    for (int i = 0; i < kSteps; ++i)
        for (int j = 0; j < kSteps; ++j) {
            const dvec3 p =
                centre + x * ((2.0 * i + 1) / kSteps - 1) + y * ((2.0 * j + 1) / kSteps - 1);
            const double d2 = glm::dot(p, p), d = std::sqrt(d2);
            sum += std::max(0.0, glm::dot(p, normal) / d) *
                   std::max(0.0, -glm::dot(p, facing) / d) / d2 * area;
        }
    return sum;
}

struct Rect {
    dvec3 centre, x, y, facing, normal;
};
std::vector<float> rectsOnGpu(const std::vector<Rect>& rects) {
    std::vector<vec4> inputs;
    for (const Rect& r : rects)
        for (const dvec3& v : {r.centre, r.x, r.y, r.facing, r.normal})
            inputs.emplace_back(vec3(v), 0);
    const std::vector<vec4> outputs = runOnGpu({"lighting/rect_irradiance.glsl"}, R"(
        uint i = 5u * id;
        outputs[id] = vec4(rectIrradiance(inputs[i].xyz, inputs[i + 1u].xyz, inputs[i + 2u].xyz, inputs[i + 3u].xyz, inputs[i + 4u].xyz));)",
                                               inputs, rects.size(), uint32_t(rects.size()));
    std::vector<float> values;
    for (const vec4& v : outputs) values.push_back(v.x);
    return values;
}

/// Configuration factor from a point to a parallel rectangle of half extents a, b whose centre is straight above at height h:
/// four times that of a rectangle with a corner above the point (Howell, "A Catalog of Radiation Heat Transfer Configuration
/// Factors", B-3).
double factorAbove(double a, double b, double h) {
    const double x = a / h, y = b / h, rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
    return 4 / (2 * kPi) * (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry));
}

TEST_P(GeometryShader, RectAboveIsTheCatalogued) {
    std::vector<Rect> rects;
    std::vector<double> expected;
    for (const double scale : {1e-3, 1.0, 1e3})
        for (const double h : {0.01, 0.3, 1.0, 5.0, 100.0, 3000.0}) {
            rects.push_back({dvec3(0, h, 0) * scale,
                             dvec3(0.5, 0, 0) * scale,
                             dvec3(0, 0, 1.5) * scale,
                             {0, -1, 0},
                             {0, 1, 0}});
            expected.push_back(kPi * factorAbove(0.5, 1.5, h));
        }
    const std::vector<float> values = rectsOnGpu(rects);
    for (size_t i = 0; i < rects.size(); ++i)
        EXPECT_NEAR(double(values[i]) / expected[i], 1, 2e-4) << "rect " << i;
}

TEST_P(GeometryShader, RectsAcrossTheHorizonEqualQuadrature) {
    std::mt19937 random{uint32_t(seed()) + 7};
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<Rect> rects;
    std::vector<double> expected;
    while (rects.size() < 60) {
        Rect r;
        const dvec3 a(uniform(random), uniform(random), uniform(random)),
            b(uniform(random), uniform(random), uniform(random));
        r.facing = glm::normalize(glm::cross(a, b));
        r.x = a;
        r.y = glm::cross(r.facing, a) * (0.3 + std::abs(uniform(random)));
        r.normal = glm::normalize(dvec3(uniform(random), uniform(random), uniform(random)));
        r.centre = 2.0 * dvec3(uniform(random), uniform(random), uniform(random));
        // The quadrature needs some distance from the plane.
        if (-glm::dot(r.centre, r.facing) < 0.3) continue;
        rects.push_back(r);
        expected.push_back(rectByQuadrature(r.centre, r.x, r.y, r.facing, r.normal));
    }
    const std::vector<float> values = rectsOnGpu(rects);
    int crossing = 0;
    for (size_t i = 0; i < rects.size(); ++i) {
        EXPECT_NEAR(double(values[i]), expected[i], 2e-3 * expected[i] + 2e-4)
            << "rect " << i << ", seed " << seed();
        const double reach = std::abs(glm::dot(rects[i].x, rects[i].normal)) +
                             std::abs(glm::dot(rects[i].y, rects[i].normal));
        crossing += std::abs(glm::dot(rects[i].centre, rects[i].normal)) < reach;
    }
    EXPECT_GT(crossing, 10);
}

TEST_P(GeometryShader, RectIsDarkBehindAndBelow) {
    const std::vector<float> values = rectsOnGpu(
        {{{0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}, {0, 1, 0}},     // shines away
         {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {0, -1, 0}, {0, -1, 0}}}); // receiver looks away
    EXPECT_EQ(values[0], 0.0f);
    EXPECT_EQ(values[1], 0.0f);
}

/// Solid angle of the rectangle [x0, x1]×[y0, y1] at height h above the point: four right-angled corners, each a quarter of a pyramid's.
double solidAngleAbove(double x0, double x1, double y0, double y1, double h) {
    const auto corner = [&](double x, double y) {
        return std::atan(x * y / (h * std::sqrt(h * h + x * x + y * y)));
    };
    return corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0);
}

TEST_P(GeometryShader, RectsHaveTheSolidAngleOfAPyramid) {
    std::vector<vec4> inputs;
    std::vector<double> expected, heights;
    for (const double scale : {1e-3, 1.0, 1e3})
        for (const double h : {1e-4, 0.01, 0.3, 1.0, 5.0, 100.0, 3000.0})
            for (const double aside : {0.0, 0.4, 0.7, 3.0}) {
                const dvec3 centre(aside, h, -0.5 * aside);
                for (const dvec3& v :
                     {centre * scale, dvec3(0.5, 0, 0) * scale, dvec3(0, 0, 1.5) * scale})
                    inputs.emplace_back(vec3(v), 0);
                expected.push_back(solidAngleAbove(centre.x - 0.5, centre.x + 0.5, centre.z - 1.5,
                                                   centre.z + 1.5, h));
                heights.push_back(h);
            }
    const std::vector<vec4> values = runOnGpu({"lighting/rect_irradiance.glsl"}, R"(
        uint i = 3u * id;
        outputs[id] = vec4(rectSolidAngle(inputs[i].xyz, inputs[i + 1u].xyz, inputs[i + 2u].xyz, vec3(0, -1, 0)),
                           rectSolidAngle(inputs[i].xyz, inputs[i + 1u].xyz, inputs[i + 2u].xyz, vec3(0, 1, 0)), 0, 0);)",
                                              inputs, expected.size(), uint32_t(expected.size()));
    for (size_t i = 0; i < expected.size(); ++i) {
        // Near the plane a difference of products of three lengths, each good to a float's 6e-8, is held against the height.
        EXPECT_NEAR(double(values[i].x), expected[i],
                    2e-5 * expected[i] + 1e-6 / std::min(heights[i], 1.0))
            << "rect " << i;
        EXPECT_EQ(values[i].y, 0.0f) << "seen from behind, rect " << i;
    }
}

TEST_P(GeometryShader, EnvironmentDirectionsAreWhereTheInterfacePutsThem) {
    struct Case {
        dvec3 direction;
        double rotation, u, v;
    };
    // A rotation of a quarter turn, right-handed about +Y, takes what was ahead (-Z) to the left (-X).
    const std::vector<Case> cases = {
        {{0, 0, -1}, 0, 0.5, 0.5},         {{1, 0, 0}, 0, 0.75, 0.5},
        {{-1, 0, 0}, 0, 0.25, 0.5},        {{0, 1, 0}, 0, 0.5, 0},
        {{0, -1, 0}, 0, 0.5, 1},           {{-1, 0, 0}, 0.5 * kPi, 0.5, 0.5},
        {{0, 0, -1}, 0.5 * kPi, 0.75, 0.5}};
    for (const Case& c : cases) {
        gpu::EnvironmentData data{};
        data.rotation = vec4(float(std::cos(c.rotation)), float(std::sin(c.rotation)), 64, 32);
        const std::vector<vec4> outputs = runOnGpu(
            {"lighting/environment.glsl"}, "outputs[0] = vec4(environmentUv(inputs[0].xyz), 0, 0);",
            std::vector<vec4>{vec4(vec3(c.direction), 0)}, 1, 1,
            {{"Environment", std::as_bytes(std::span(&data, 1))}});
        EXPECT_NEAR(double(outputs[0].x), c.u, 1e-6);
        EXPECT_NEAR(double(outputs[0].y), c.v, 1e-6);
    }
}

} // namespace
} // namespace tyndall::test
