// The march against closed forms and against quadrature in double precision.
#include <cmath>
#include <random>

#include <glm/gtc/matrix_transform.hpp>

#include "gl/gl_fixture.h"
#include "media/blackbody.h"
#include "media/segment_integral.h"
#include "shaders/media_compute.h"
#include "shared/march.h"
#include "shared/view.h"
#include "support/content.h"

namespace tyndall::test {
namespace {

using MediaMarch = GlTest;
TYNDALL_GL_TESTS(MediaMarch);

const std::vector<std::string> kIncludes{"media/march.glsl"};
// Each invocation is a pixel of its own: its noise differs.
const char* const kInScatter =
    "vec4 a = inputs[0]; vec4 b = inputs[1];"
    "MarchResult r = marchMedia(Ray(a.xyz, b.xyz), a.w, kMarchInScatter, uint(b.w), uvec2(id % 64u, id / 64u));"
    "outputs[id] = vec4(r.inScatter, r.opticalDepth.x);";
const char* const kEmission =
    "vec4 a = inputs[0]; vec4 b = inputs[1];"
    "MarchResult r = marchMedia(Ray(a.xyz, b.xyz), a.w, kMarchEmission, 0u, uvec2(id % 64u, id / 64u));"
    "outputs[id] = vec4(r.emission, r.opticalDepth.x);";

gpu::LightData lamp(uint32_t type) {
    gpu::LightData light{};
    light.type = type;
    light.intensity = vec4(1, 1, 1, 1e-6f);
    light.direction = vec4(0, -1, 0, 0);
    light.shadowIndex = -1;
    light.axisY.w = -1;
    return light;
}

gpu::LightData pointLamp(const dvec3& position) {
    gpu::LightData light = lamp(gpu::kLightPoint);
    light.position = vec4(vec3(position), 0);
    return light;
}

std::vector<vec4> rayInputs(const dvec3& origin, const dvec3& direction, double length,
                            size_t lights) {
    return {vec4(vec3(origin), float(length)), vec4(vec3(direction), float(lights))};
}

dvec3 meanOf(const std::vector<vec4>& values) {
    dvec3 sum(0);
    for (const vec4& v : values) sum += dvec3(v);
    return sum / double(values.size());
}

Medium fog(MediumKind kind, const vec3& scattering, const vec3& absorption) {
    Medium medium;
    medium.name = "fog";
    medium.kind = kind;
    medium.scattering = scattering;
    medium.absorption = absorption;
    return medium;
}

struct Airlight {
    double beta, sourceToViewer, viewerToPoint, degrees, radiance;
};

TEST_P(MediaMarch, AirlightOfAPointLightIsWithinThreePerMille) {
    gl::ShaderLibrary library;
    // Sun et al. 2005, isotropic, albedo 1, 1 cd; values by quadrature of their closed form.
    const Airlight table[] = {{.1, 10, 20, 30, 8.174737694e-4},
                              {.5, 4, 10, 45, 1.409133662e-3},
                              {1, 2, 5, 60, 3.484834779e-3},
                              {.05, 20, 60, 90, 3.844005116e-5},
                              {2, 1, 3, 15, 0.1286970871}};
    for (const Airlight& row : table) {
        const Medium medium = fog(MediumKind::Everywhere, vec3(float(row.beta)), vec3(0));
        const dmat4 world(1.0);
        const Scene scene = sceneOf(std::span(&medium, 1), std::span(&world, 1));
        const double angle = row.degrees * kPi / 180;
        MediaOptions options;
        options.lights.push_back(
            pointLamp(row.sourceToViewer * dvec3(std::cos(angle), std::sin(angle), 0)));
        options.viewFlags = gpu::kViewConverge;
        MediaCompute compute(scene, options);
        const auto outputs =
            compute.run(library, kIncludes, kInScatter,
                        rayInputs(dvec3(0), dvec3(1, 0, 0), row.viewerToPoint, 1), 4096);
        EXPECT_NEAR(meanOf(outputs).x / row.radiance, 1.0, 3e-3) << "beta " << row.beta;
        // And no single pixel is far off: the weights cancel what varies most.
        for (const vec4& v : outputs) EXPECT_NEAR(double(v.x) / row.radiance, 1.0, 0.15);
    }
}

TEST_P(MediaMarch, TheEnvironmentsLightsTakeTurnsAndLoseNothing) {
    gl::ShaderLibrary library;
    const Medium medium = fog(MediumKind::Everywhere, vec3(0.1f), vec3(0));
    const dmat4 world(1.0);
    const Scene scene = sceneOf(std::span(&medium, 1), std::span(&world, 1));
    MediaOptions options;
    for (const float lux : {5, 1, 2, 4}) {
        options.lights.push_back(lamp(gpu::kLightDirectional));
        options.lights.back().intensity = vec4(lux);
    }
    options.lights.push_back(pointLamp({5, 3, 0}));
    const auto seen = [&] {
        return MediaCompute(scene, options)
            .run(library, kIncludes, kInScatter, rayInputs(dvec3(0), dvec3(1, 0, 0), 20, 5), 4096);
    };
    const std::vector<vec4> plain = seen();
    options.environmentFirst = 1;
    options.environmentLights = 3;
    const std::vector<vec4> grouped = seen();
    for (size_t i = 0; i < plain.size(); ++i) EXPECT_NEAR(grouped[i].x / plain[i].x, 1, 1e-5) << i;
    // One of the three at each of 32 steps: turns of three that begin anywhere, so over the pixels each is seen as often.
    options.environmentStride = 3;
    EXPECT_NEAR(meanOf(seen()).x / meanOf(plain).x, 1, 1e-3);
    options.environmentStride = 2;
    EXPECT_NEAR(meanOf(seen()).x / meanOf(plain).x, 1, 1e-2)
        << "two of three and one of three in turns";
}

TEST_P(MediaMarch, ConstantLightIsExactForAnyNumberOfSteps) {
    gl::ShaderLibrary library;
    // A slab lit evenly along the ray: L = σs/σt · p · E · e^-σt · (1 - e^-2σt), any albedo per channel.
    for (const float sigma : {1e-6f, 1e-3f, 0.5f, 3.0f, 30.0f})
        for (const uint32_t steps : {1u, 2u, 3u, 7u, 32u, 200u, 1000u}) {
            const vec3 scattering = sigma * vec3(1.0f, 0.5f, 0.1f),
                       absorption = sigma * vec3(0.2f, 0.0f, 0.1f);
            Medium medium = fog(MediumKind::Box, scattering, absorption);
            medium.size = dvec3(2, 2, 2);
            const dmat4 world(1.0);
            const Scene scene = sceneOf(std::span(&medium, 1), std::span(&world, 1));
            MediaOptions options;
            options.steps = steps;
            options.lights.push_back(lamp(gpu::kLightDirectional));
            MediaCompute compute(scene, options);
            const auto outputs =
                compute.run(library, kIncludes, kInScatter,
                            rayInputs(dvec3(-5, 0, 0.2), dvec3(1, 0, 0), 1e30, 1), 64);
            for (int c = 0; c < 3; ++c) {
                const double s = double(scattering[c]), t = s + double(absorption[c]);
                const double exact = s / t * -std::expm1(-2 * t) * std::exp(-t) / (4 * kPi);
                for (const vec4& v : outputs)
                    EXPECT_NEAR(double(v[c]) / exact, 1.0, 2e-5)
                        << "sigma " << sigma << " steps " << steps << " channel " << c;
            }
        }
}

TEST_P(MediaMarch, EmissionIsExactFromThinToOpaque) {
    gl::ShaderLibrary library;
    for (const MediumKind kind : {MediumKind::Box, MediumKind::Sphere, MediumKind::Everywhere})
        for (const float sigma : {0.0f, 1e-7f, 0.1f, 10.0f, 1e4f}) {
            Medium medium = fog(kind, vec3(0), vec3(sigma));
            medium.size = dvec3(3);
            medium.emission = vec3(1, 2, 5);
            const dmat4 world(1.0);
            const Scene scene = sceneOf(std::span(&medium, 1), std::span(&world, 1));
            MediaOptions options;
            options.steps = 5;
            MediaCompute compute(scene, options);
            // From inside: the camera's medium counts from the eye.
            const auto outputs = compute.run(library, kIncludes, kEmission,
                                             rayInputs(dvec3(0), dvec3(0, 1, 0), 1.5, 0), 1);
            const double x = 1.5 * double(sigma), factor = x > 0 ? -std::expm1(-x) / x : 1.0;
            EXPECT_NEAR(double(outputs[0].z) / (5 * 1.5 * factor), 1.0, 1e-5)
                << "kind " << int(kind) << " sigma " << sigma;
            EXPECT_NEAR(double(outputs[0].w), x, 1e-5 * x);
        }
}

/// Single scattering by quadrature: fine panels along the ray, each light exactly attenuated.
dvec3 singleScattering(const Scene& scene, const RaySegment& ray, const gpu::LightData& light,
                       int panels) {
    const std::vector<dmat4> world = scene.worldTransforms();
    dvec3 sum(0), depth(0);
    const double h = ray.length / panels;
    for (int i = 0; i < panels; ++i) {
        const dvec3 p = ray.origin + ray.direction * ((i + 0.5) * h);
        const bool parallel = light.type == gpu::kLightDirectional;
        const dvec3 toLight = parallel ? -dvec3(light.direction) : dvec3(light.position) - p;
        const double d = parallel ? 1e6 : glm::length(toLight);
        const double lux = parallel ? 1 : 1 / (d * d);
        dvec3 before(0), after(0), lightDepth(0), scattering(0);
        for (size_t m = 0; m < scene.media.size(); ++m) {
            const Medium& medium = scene.media[m];
            before += opticalDepth(medium, world[m],
                                   {ray.origin + ray.direction * (i * h), ray.direction, 0.5 * h});
            after += opticalDepth(medium, world[m], {p, ray.direction, 0.5 * h});
            lightDepth += opticalDepth(medium, world[m], {p, glm::normalize(toLight), d});
            scattering += dvec3(medium.scattering) * mediumDensity(medium, world[m], p);
        }
        for (int c = 0; c < 3; ++c)
            sum[c] += scattering[c] * std::exp(-depth[c] - before[c] - lightDepth[c]) * lux * h /
                      (4 * kPi);
        depth += before + after;
    }
    return sum;
}

Medium cloud(uint64_t s) {
    Medium medium = fog(MediumKind::Grid, vec3(3, 2, 1), vec3(0.1f, 0.5f, 1));
    std::mt19937_64 engine(s);
    std::uniform_real_distribution<float> value(0, 1.5f);
    std::vector<float> voxels(24 * 20 * 22);
    for (float& v : voxels) v = value(engine) > 0.3f ? value(engine) : 0.0f;
    medium.density = std::make_shared<BrickGrid>(
        makeBrickGrid(voxels, ivec3(0), ivec3(24, 20, 22), glm::scale(dmat4(1.0), dvec3(0.1))));
    return medium;
}

void expectQuadrature(gl::ShaderLibrary& library, const std::vector<Medium>& media,
                      const std::vector<dmat4>& world, const RaySegment& ray,
                      const gpu::LightData& light, double tolerance,
                      uint32_t flags = gpu::kMediaExact) {
    const Scene scene = sceneOf(media, world);
    MediaOptions options;
    options.flags = flags;
    options.viewFlags = gpu::kViewConverge;
    options.lights.push_back(light);
    MediaCompute compute(scene, options);
    const dvec3 mean = meanOf(compute.run(
        library, kIncludes, kInScatter, rayInputs(ray.origin, ray.direction, ray.length, 1), 4096));
    const dvec3 exact = singleScattering(scene, ray, light, 4000);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(mean[c] / exact[c], 1.0, tolerance)
            << "channel " << c << ": " << mean[c] << ", quadrature " << exact[c];
}

TEST_P(MediaMarch, GridLitBySunAndLampMatchesQuadrature) {
    gl::ShaderLibrary library;
    const dmat4 world = glm::translate(dmat4(1.0), dvec3(-1.2, -1, -1.1));
    const RaySegment ray{dvec3(-3, 0.13, 0.31), glm::normalize(dvec3(1, 0.05, -0.1)), 6};
    gpu::LightData sun = lamp(gpu::kLightDirectional);
    sun.direction = vec4(glm::normalize(vec3(0.3f, -1, 0.2f)), 0);
    expectQuadrature(library, {cloud(seed())}, {world}, ray, sun, 2e-3);
    expectQuadrature(library, {cloud(seed())}, {world}, ray, pointLamp(dvec3(0.2, 2.0, 0.4)), 2e-3);
    // A lamp inside the cloud, close to the ray.
    expectQuadrature(library, {cloud(seed())}, {world}, ray, pointLamp(dvec3(0.2, 0.4, 0.4)), 3e-3);
}

TEST_P(MediaMarch, BesideARectangleASingleFrameHasNoSpecks) {
    // In thin fog a ray under a rectangle gathers σ/4π ∫ Ω ds of its radiance, Ω of four corners as in a pyramid.
    gl::ShaderLibrary library;
    const double sigma = 1e-4;
    for (const double below : {0.02, 0.1, 0.5}) {
        gpu::LightData light = lamp(gpu::kLightRect);
        light.position = vec4(0, float(below), 0, 0);
        light.axisX = vec4(0.5f, 0, 0, 0);
        light.axisY = vec4(0, 0, 0.5f, 0);
        light.intensity = vec4(1, 1, 1, 1); // w: area
        MediaOptions options;
        options.steps = 24;
        options.lights.push_back(light);
        const Medium thin = fog(MediumKind::Everywhere, vec3(float(sigma)), vec3(0));
        const dmat4 world(1.0);
        const Scene scene = sceneOf(std::span(&thin, 1), std::span(&world, 1));
        MediaCompute compute(scene, options);
        const std::vector<vec4> values =
            compute.run(library, kIncludes, kInScatter,
                        rayInputs(dvec3(-3, 0, 0.1), dvec3(1, 0, 0), 6, 1), 4096);
        double exact = 0;
        constexpr int kPanels = 20000;
        for (int i = 0; i < kPanels; ++i) {
            const double x = -3 + 6 * (i + 0.5) / kPanels;
            const auto corner = [&](double a, double b) {
                return std::atan(a * b / (below * std::sqrt(below * below + a * a + b * b)));
            };
            const double solidAngle = corner(0.5 - x, 0.4) + corner(0.5 + x, 0.4) +
                                      corner(0.5 - x, 0.6) + corner(0.5 + x, 0.6);
            exact += solidAngle * 6 / kPanels;
        }
        exact *= sigma / (4 * kPi);
        // Of 24 points a ray, drawn in angle from the lamp's middle while its solid angle changes otherwise: noise of some per mille over 4,096 rays.
        EXPECT_NEAR(meanOf(values).x / exact, 1, 5e-3) << below << " m below";
        // A ray's light is a mean over its points of an integrand that 2π bounds; one point's inverse square, 1/below², would be tens of times the mean.
        double largest = 0;
        for (const vec4& value : values) largest = std::max(largest, double(value.x));
        EXPECT_LT(largest / exact, 1.3) << below << " m below";
    }
}

TEST_P(MediaMarch, OverlappingMediaMatchQuadrature) {
    gl::ShaderLibrary library;
    Medium ball = fog(MediumKind::Sphere, vec3(0.4f, 0.2f, 0.9f), vec3(0.1f));
    ball.size = dvec3(2, 3, 2);
    Medium mist = fog(MediumKind::Height, vec3(0.3f), vec3(0.05f, 0.1f, 0.0f));
    mist.scaleHeight = 0.4;
    const dmat4 placed = glm::translate(dmat4(1.0), dvec3(-1.2, -1, -1.1));
    const RaySegment ray{dvec3(-3, 0.13, 0.31), glm::normalize(dvec3(1, 0.05, -0.1)), 7};
    expectQuadrature(library, {cloud(seed() + 1), ball, mist}, {placed, dmat4(1.0), dmat4(1.0)},
                     ray, pointLamp(dvec3(0.5, 1.5, -0.4)), 3e-3);
}

TEST_P(MediaMarch, HeightFogMatchesQuadrature) {
    gl::ShaderLibrary library;
    Medium mist = fog(MediumKind::Height, vec3(0.5f, 0.3f, 0.1f), vec3(0.1f));
    mist.scaleHeight = 0.7;
    gpu::LightData sun = lamp(gpu::kLightDirectional);
    sun.direction = vec4(glm::normalize(vec3(0.4f, -1, 0.1f)), 0);
    for (const double slope : {-0.3, 0.0, 0.2})
        expectQuadrature(library, {mist}, {dmat4(1.0)},
                         {dvec3(0, 0.5, 0), glm::normalize(dvec3(1, slope, 0)), 6}, sun, 2e-3);
}

TEST_P(MediaMarch, ConstantGridLooksLikeABox) {
    gl::ShaderLibrary library;
    // 17³ voxels of 1: constant in the 16³ cells between them, and a fall to 0 over the cell outside.
    std::vector<float> voxels(17 * 17 * 17, 1.0f);
    Medium grid = fog(MediumKind::Grid, vec3(1, 0.5f, 2), vec3(0.3f));
    grid.density = std::make_shared<BrickGrid>(
        makeBrickGrid(voxels, ivec3(0), ivec3(17), glm::scale(dmat4(1.0), dvec3(0.1))));
    const RaySegment ray{dvec3(-1, 0.81, 0.77), dvec3(1, 0, 0), 4};
    gpu::LightData sun = lamp(gpu::kLightDirectional);
    expectQuadrature(library, {grid}, {dmat4(1.0)}, ray, sun, 1e-3);
    expectQuadrature(library, {grid}, {dmat4(1.0)}, ray, sun, 1e-2, 0); // by steps of a voxel
}

TEST_P(MediaMarch, HotGasGlowsAsABlackBody) {
    gl::ShaderLibrary library;
    std::vector<float> ones(9 * 9 * 9, 1.0f), hot(9 * 9 * 9, 1500.0f);
    Medium gas = fog(MediumKind::Grid, vec3(0), vec3(2));
    gas.density = std::make_shared<BrickGrid>(makeBrickGrid(ones, ivec3(0), ivec3(9), dmat4(1.0)));
    gas.temperature =
        std::make_shared<BrickGrid>(makeBrickGrid(hot, ivec3(0), ivec3(9), dmat4(1.0)));
    gas.temperatureScale = 3;
    const dmat4 world(1.0);
    const Scene scene = sceneOf(std::span(&gas, 1), std::span(&world, 1));
    MediaCompute compute(scene, {});
    const auto outputs = compute.run(library, kIncludes, kEmission,
                                     rayInputs(dvec3(1, 4, 4), dvec3(1, 0, 0), 5, 0), 1);
    const dvec3 exact = 3.0 * blackbodyRadiance(1500) / 2.0 * -std::expm1(-10.0);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(double(outputs[0][c]), exact[c], 5e-3 * exact[0]);
}

TEST_P(MediaMarch, NothingIsEverNegativeOrNotFinite) {
    gl::ShaderLibrary library;
    std::mt19937_64 engine(seed());
    const auto uniform = [&](double a, double b) {
        return std::uniform_real_distribution<double>(a, b)(engine);
    };
    for (const double scale : {1e-3, 1.0, 1e3}) {
        std::vector<Medium> media{fog(MediumKind::Everywhere, vec3(1e-3f, 0, 1e-6f), vec3(0)),
                                  fog(MediumKind::Box, vec3(1e4f), vec3(0, 1, 1e-8f)),
                                  fog(MediumKind::Sphere, vec3(0), vec3(0)),
                                  fog(MediumKind::Height, vec3(0.1f, 3, 1e5f), vec3(0)),
                                  cloud(seed() + 2)};
        media[2].emission = vec3(1);
        media[3].anisotropy = 0.99f;
        media[1].anisotropy = -0.99f;
        std::vector<dmat4> world;
        for (size_t i = 0; i < media.size(); ++i)
            world.push_back(glm::scale(dmat4(1.0), dvec3(scale)));
        for (const uint32_t flags : {0u, gpu::kMediaExact}) {
            const Scene scene = sceneOf(media, world);
            MediaOptions options;
            options.flags = flags;
            // On the ray, beside it, in the eye, far away; sun and panel.
            for (const dvec3 p :
                 {dvec3(0.5, 0, 0), dvec3(0.2, 1e-4, 0.3), dvec3(0), dvec3(1e5, 2e5, 0)})
                options.lights.push_back(pointLamp(scale * p));
            options.lights.push_back(lamp(gpu::kLightDirectional));
            gpu::LightData panel = lamp(gpu::kLightRect);
            panel.position = vec4(0, float(scale), 0, 0);
            panel.axisX = vec4(float(0.5 * scale), 0, 0, 0);
            panel.axisY = vec4(0, 0, float(0.5 * scale), 0);
            panel.intensity.w = float(scale * scale);
            options.lights.push_back(panel);
            MediaCompute compute(scene, options);
            std::vector<vec4> inputs;
            for (int i = 0; i < 512; ++i) {
                dvec3 d = glm::normalize(dvec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)));
                if (i < 6) d = dvec3(i / 2 == 0, i / 2 == 1, i / 2 == 2) * (i % 2 ? -1.0 : 1.0);
                const dvec3 o = i % 3 == 0
                                    ? dvec3(0)
                                    : (i % 3 == 1 ? scale * dvec3(0.5, -0.5, 0)
                                                  : scale * dvec3(uniform(-2, 2), uniform(-2, 2),
                                                                  uniform(-2, 2)));
                inputs.emplace_back(
                    vec3(o), float(i % 5 == 0 ? 1e30 : (i % 5 == 1 ? 0.0 : scale * uniform(0, 5))));
                inputs.emplace_back(vec3(d), 0);
            }
            const auto outputs = compute.run(
                library, kIncludes,
                "MarchResult r = marchMedia(Ray(inputs[2u * id].xyz, inputs[2u * id + 1u].xyz), inputs[2u * id].w,"
                "kMarchInScatter | kMarchEmission, 6u, uvec2(id % 64u, id / 64u));"
                "vec3 least = min(r.inScatter, min(r.emission, r.opticalDepth));"
                "bool good = isFiniteNumber(r.inScatter) && isFiniteNumber(r.emission) && isFiniteNumber(r.opticalDepth) && minimumOf(least) >= 0.0;"
                "outputs[id] = vec4(good ? 1.0 : 0.0, r.inScatter.x, r.emission.x, r.opticalDepth.x);",
                inputs, 512);
            for (size_t i = 0; i < outputs.size(); ++i)
                EXPECT_EQ(outputs[i].x, 1.0f)
                    << "scale " << scale << " flags " << flags << " ray " << i << ": "
                    << outputs[i].y << " " << outputs[i].z << " " << outputs[i].w;
        }
    }
}

} // namespace
} // namespace tyndall::test
