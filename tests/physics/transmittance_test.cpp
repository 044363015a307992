// Transmittance through known densities, seen against an environment of radiance 1: the LE image is the transmittance.
// Bound: 1e-4 in absolute transmittance, with exact integration of grids.

#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/render.h"

namespace tyndall::test {
namespace {

constexpr double kBound = 1e-4;

/// A grid medium of cubic voxels in a scene that has an eye and an environment.
Scene gridScene(const std::string& eye, const std::vector<float>& voxels, ivec3 size,
                const dmat4& worldFromIndex, double sigma) {
    Scene scene = sceneFromJson(R"({"tyndall": 1, "nodes": [)" + eye +
                                R"(], "camera": "eye", "environment": {"radiance": [1, 1, 1]}})");
    Medium medium;
    medium.name = "grid";
    medium.kind = MediumKind::Grid;
    medium.absorption = vec3(float(sigma));
    medium.density =
        std::make_shared<BrickGrid>(makeBrickGrid(voxels, ivec3(0), size, worldFromIndex));
    medium.version = nextVersion();
    Node node;
    node.name = "grid";
    node.medium = int(scene.media.size());
    scene.media.push_back(medium);
    scene.nodes.push_back(node);
    scene.versions.media = scene.versions.structure = nextVersion();
    return scene;
}

dmat4 scaledAndMoved(double voxel, dvec3 origin) {
    dmat4 m(voxel);
    m[3] = dvec4(origin, 1);
    return m;
}

RenderOptions exactOptions(int size) {
    RenderOptions options;
    options.width = options.height = size;
    options.settings = {"media.integration=exact", "media.march.minTransmittance=0"};
    return options;
}

TEST(Transmittance, LinearDensityHasTheMeanOfItsEnds) {
    // Density grows along -Z by 0.05 a voxel; the eye sits inside at voxel 4.5, an emissive wall at voxel 20.25.
    constexpr int kN = 32;
    std::vector<float> voxels(kN * kN * kN);
    for (int z = 0; z < kN; ++z)
        for (int y = 0; y < kN; ++y)
            for (int x = 0; x < kN; ++x)
                voxels[size_t((z * kN + y) * kN + x)] = 0.05f * float(kN - 1 - z);
    const double h = 0.1, start = 4.5, end = 20.25;
    const auto zOf = [&](double k) { return (kN - 1 - k) * h; }; // voxel k counted from +Z
    const std::string eye = fmt::format(
        R"({{"name": "eye", "camera": {{"type": "perspective", "yfov": 0.02, "znear": 0.001}}, "translation": [1.55, 1.55, {}]}},
           {{"name": "wall", "primitive": {{"shape": "plane", "size": [1, 1, 1]}}, "material": {{"baseColor": [0,0,0], "metallic": 0, "roughness": 1, "specular": 0, "emissive": [1,1,1]}},
             "translation": [1.55, 1.55, {}], "rotation": [0.7071067811865476, 0, 0, 0.7071067811865476]}})",
        zOf(start), zOf(end));
    const Rendered picture = sharedRenderer().render(
        gridScene(eye, voxels, ivec3(kN), scaledAndMoved(h, dvec3(0)), 2.0), exactOptions(9));
    const double expected = std::exp(-2.0 * (end - start) * h * 0.5 * (0.05 * start + 0.05 * end));
    EXPECT_NEAR(double(picture.centre("LE").x), expected, kBound);
}

TEST(Transmittance, GaussianBlobHasTheErrorFunction) {
    // An orthographic eye whose pixel centres fall on voxel centres across the ray, where trilinear interpolation is exact;
    // along the ray the trapezoid sum of a Gaussian of 5 voxels equals its integral to 1e-16.
    constexpr int kN = 65;
    const double s = 5, h = 0.05, sigma = 3;
    std::vector<float> voxels(size_t(kN) * kN * kN);
    for (int z = 0; z < kN; ++z)
        for (int y = 0; y < kN; ++y)
            for (int x = 0; x < kN; ++x) {
                const double r2 = (x - 32) * (x - 32) + (y - 32) * (y - 32) + (z - 32) * (z - 32);
                voxels[(size_t(z) * kN + size_t(y)) * kN + size_t(x)] =
                    float(std::exp(-r2 / (2 * s * s)));
            }
    constexpr int kPixels = 33; // one voxel a pixel
    const std::string eye = fmt::format(
        R"({{"name": "eye", "camera": {{"type": "orthographic", "ymag": {}}}, "translation": [0, 0, 10]}})",
        kPixels * h / 2);
    const Rendered picture = sharedRenderer().render(
        gridScene(eye, voxels, ivec3(kN), scaledAndMoved(h, dvec3(-32 * h)), sigma),
        exactOptions(kPixels));
    for (int y = 0; y < kPixels; ++y)
        for (int x = 0; x < kPixels; ++x) {
            const double b2 = (x - 16) * (x - 16) + (y - 16) * (y - 16);
            const double tau = sigma * h * s * std::sqrt(2 * kPi) * std::exp(-b2 / (2 * s * s)) *
                               std::erf(32.5 / (s * std::sqrt(2.0)));
            ASSERT_NEAR(double(picture.pixel(x, y, "LE").x), std::exp(-tau), kBound)
                << x << ", " << y;
        }
}

TEST(Transmittance, HeightFogHasItsClosedForm) {
    constexpr int kN = 16;
    const double scaleHeight = 3, sigma = 0.4, eyeHeight = 1.2;
    const Rendered picture =
        sharedRenderer().render(sceneFromJson(fmt::format(
                                    R"({{"tyndall": 1, "nodes": [
          {{"name": "haze", "medium": {{"type": "homogeneous", "shape": "height", "scaleHeight": {}, "scattering": [0, 0, 0], "absorption": [{}, {}, {}]}}}},
          {{"name": "eye", "camera": {{"type": "perspective", "yfov": 0.9}}, "translation": [0, {}, 0], "rotation": [0.3826834323650898, 0, 0, 0.9238795325112867]}}],
          "camera": "eye", "environment": {{"radiance": [1, 1, 1]}}}})",
                                    scaleHeight, sigma, 0.5 * sigma, 0.0, eyeHeight)),
                                exactOptions(kN));
    const double pitch = kPi / 4, tangent = std::tan(0.45);
    for (int y = 0; y < kN; ++y)
        for (int x = 0; x < kN; ++x) {
            const dvec3 local((2 * (x + 0.5) / kN - 1) * tangent,
                              (1 - 2 * (y + 0.5) / kN) * tangent, -1);
            const double up =
                (local.y * std::cos(pitch) - local.z * std::sin(pitch)) / glm::length(local);
            ASSERT_GT(up, 0);
            const double tau = std::exp(-eyeHeight / scaleHeight) * scaleHeight / up; // to infinity
            const vec3 seen = picture.pixel(x, y, "LE");
            ASSERT_NEAR(double(seen.x), std::exp(-sigma * tau), kBound);
            ASSERT_NEAR(double(seen.y), std::exp(-0.5 * sigma * tau), kBound);
            ASSERT_EQ(seen.z, 1.0f) << "a channel without extinction is untouched";
        }
}

TEST(Transmittance, BoxAndSphereHaveTheirChords) {
    for (const char* shape : {"box", "sphere"}) {
        const Rendered picture = sharedRenderer().render(
            sceneFromJson(fmt::format(
                R"({{"tyndall": 1, "nodes": [{{"name": "m", "medium": {{"type": "homogeneous", "shape": "{}", "size": [2, 2, 2], "scattering": [0,0,0], "absorption": [0.5, 1, 2]}}}},
               {{"name": "eye", "camera": {{"type": "orthographic", "ymag": 1.5}}, "translation": [0, 0, 8]}}], "camera": "eye", "environment": {{"radiance": [1,1,1]}}}})",
                shape)),
            exactOptions(24));
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 24; ++x) {
                const double px = (x + 0.5) / 24 * 3 - 1.5, py = (y + 0.5) / 24 * 3 - 1.5,
                             r2 = px * px + py * py;
                const bool box = shape[0] == 'b';
                const double chord = box ? (std::abs(px) < 1 && std::abs(py) < 1 ? 2.0 : 0.0)
                                         : 2 * std::sqrt(std::max(0.0, 1 - r2));
                for (int c = 0; c < 3; ++c)
                    ASSERT_NEAR(double(picture.pixel(x, y, "LE")[c]),
                                std::exp(-chord * (c == 0 ? 0.5 : c)), kBound)
                        << shape << " " << x << ", " << y;
            }
    }
}

TEST(Transmittance, OverlappingMediaMultiply) {
    const std::string box =
        R"({"name": "a", "medium": {"type": "homogeneous", "shape": "box", "size": [2, 2, 2], "scattering": [0.1,0.1,0.1], "absorption": [0.3, 0.3, 0.3]}})";
    const std::string ball =
        R"({"name": "b", "medium": {"type": "homogeneous", "shape": "sphere", "size": [2, 2, 2], "scattering": [0,0,0], "absorption": [0.7, 0.7, 0.7]}, "translation": [0.5, 0, 0]})";
    const auto render = [&](const std::string& media) {
        return sharedRenderer().render(
            sceneFromJson(
                R"({"tyndall": 1, "nodes": [)" + media +
                R"(, {"name": "eye", "camera": {"type": "orthographic", "ymag": 1.5}, "translation": [0, 0, 8]}],
            "camera": "eye", "environment": {"radiance": [1,1,1]}})"),
            exactOptions(16));
    };
    const Rendered a = render(box), b = render(ball), both = render(box + "," + ball);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x)
            ASSERT_NEAR(both.pixel(x, y, "LE").x, a.pixel(x, y, "LE").x * b.pixel(x, y, "LE").x,
                        2e-6f);
}

} // namespace
} // namespace tyndall::test
