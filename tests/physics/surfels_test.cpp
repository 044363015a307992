// Surfels in pictures: the hierarchy against all pairs, all pairs against integrals in double
// precision, and what theory says of planes. technique_laws_test.cpp has what holds for all
// techniques.

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/image_metrics.h"
#include "gi_scenes.h"
#include "scene/scene_edit.h"
#include "support/render.h"

namespace tyndall::test {
namespace {

const std::string kFog =
    R"({"name": "fog", "medium": {"type": "homogeneous", "shape": "box", "size": [4, 3, 4], "scattering": [0.3, 0.3, 0.3],
    "absorption": [0, 0.1, 0.2], "anisotropy": 0.5}, "translation": [0, 1.5, 0]},)";

RenderOptions surfels(std::vector<std::string> settings, int width = 32, int height = 24) {
    RenderOptions options;
    options.width = width;
    options.height = height;
    options.gi = "surfels";
    options.terms = terms(Term::LSVE);
    options.settings = std::move(settings);
    return options;
}

std::vector<std::string> with(std::vector<std::string> settings,
                              const std::vector<std::string>& more) {
    settings.insert(settings.end(), more.begin(), more.end());
    return settings;
}

Image pictureOf(const Scene& scene, const RenderOptions& options) {
    return sharedRenderer().render(scene, options).terms.at("LSVE");
}

/// Means of 4 × 4 blocks of a picture, all channels, and of the whole.
std::array<double, 17> blocksOf(const Image& image) {
    std::array<double, 17> sums{};
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int c = 0; c < 3; ++c) {
                const double value = double(image.at(x, y)[c]) / (3.0 * image.width * image.height);
                sums[16] += value;
                sums[size_t(y * 4 / image.height * 4 + x * 4 / image.width)] += 16 * value;
            }
    return sums;
}

/// A floor and a wall, each of one face, in fog; `more` between them. All pieces are of three
/// surfels
/// and more, and the lamp is a point: nothing but the hierarchy and the choice of rays is by
/// chance.
Scene twoFaces(const std::string& more = "") {
    return sceneFromJson(fmt::format(
        R"({{"tyndall": 1, "nodes": [
        {{"name": "floor", "primitive": {{"shape": "plane", "size": [4, 4]}}, "material": {{"baseColor": [0.8, 0.6, 0.4], "specular": 0}}}},
        {{"name": "wall", "primitive": {{"shape": "plane", "size": [4, 3]}}, "material": {{"baseColor": [0.3, 0.5, 0.8], "specular": 0}},
            "translation": [0, 1.5, -2], "rotation": [0.70710678, 0, 0, 0.70710678]}}, {}{}
        {{"name": "lamp", "light": {{"type": "point", "intensity": 50}}, "translation": [0.5, 2, 0.3]}},
        {{"name": "eye", "camera": {{"type": "perspective", "yfov": 0.6}}, "translation": [0, 1.5, 6]}}],
        "camera": "eye"}})",
        kFog, more));
}

/// Pictures of many seeds against one: t of the mean difference, of the picture and of each block.
void expectMean(const Scene& scene, const RenderOptions& options, const Image& expected,
                uint32_t seeds, double precision) {
    const auto wanted = blocksOf(expected);
    std::array<double, 17> sum{}, squares{};
    for (uint32_t seed = 0; seed < seeds; ++seed) {
        RenderOptions seeded = options;
        seeded.seed = seed;
        const auto found = blocksOf(pictureOf(scene, seeded));
        for (size_t i = 0; i < found.size(); ++i) {
            const double off = found[i] / wanted[i] - 1;
            sum[i] += off;
            squares[i] += off * off;
        }
    }
    const double n = seeds;
    for (size_t i = 0; i < sum.size(); ++i) {
        const double mean = sum[i] / n,
                     error = std::sqrt((squares[i] - n * mean * mean) / (n - 1) / n);
        printf("%s %zu: %+.5f of the light, standard error %.5f, t %+.2f\n",
               i == 16 ? "picture" : "block", i, mean, error, mean / error);
        EXPECT_GT(wanted[i], 0);
        EXPECT_LE(std::abs(mean), 3.5 * error) << i; // one block in a thousand by chance
        // An estimate that says nothing is no evidence.
        EXPECT_LT(error, i == 16 ? precision : 10 * precision) << i;
    }
}

const std::vector<std::string> kFew = {"gi.surfels.blur=false",   "gi.surfels.march=full",
                                       "gi.surfels.jitter=false", "gi.surfels.most=384",
                                       "gi.surfels.intervals=8",  "media.march.minTransmittance=0"};

TEST(SurfelHierarchy, ItsMeanIsThatOfAllPairs) {
    const Scene scene = twoFaces();
    const auto given = with(kFew, {"gi.surfels.rays=none"});
    RenderOptions all = surfels(with(given, {"gi.surfels.pairs=all"}));
    const Image expected = pictureOf(scene, all);
    all.seed = 7;
    EXPECT_EQ(pictureOf(scene, all).pixels, expected.pixels) << "all pairs are by chance";
    // A threshold that is reached near by, so that most pairs are of coarse levels.
    expectMean(scene, surfels(with(given, {"gi.surfels.levels=5", "gi.surfels.epsilon=0.3"})),
               expected, 64, 0.01);
}

TEST(SurfelHierarchy, ItsMeanIsThatOfAllPairsWithARayEach) {
    // A screen stands in the way: what a ray does not ask is not in the mean.
    const Scene scene = twoFaces(
        R"({"name": "screen", "primitive": {"shape": "box", "size": [0.2, 2, 2]}, "material": {"baseColor": [0, 0, 0], "specular": 0}, "translation": [-0.4, 1, 0.3]},)");
    const Image expected =
        pictureOf(scene, surfels(with(kFew, {"gi.surfels.rays=every", "gi.surfels.pairs=all"})));
    const Image open =
        pictureOf(scene, surfels(with(kFew, {"gi.surfels.rays=none", "gi.surfels.pairs=all"})));
    EXPECT_LT(test::meanOf(expected), 0.95 * test::meanOf(open)) << "the screen hides nothing";
    expectMean(scene,
               surfels(with(
                   kFew, {"gi.surfels.rays=one", "gi.surfels.levels=5", "gi.surfels.epsilon=0.3"})),
               expected, 64, 0.01);
}

TEST(SurfelHierarchy, ARayForOneIntervalStandsForAll) {
    // The same without the hierarchy's noise: whichever interval is asked, the mean is that of all.
    const Scene scene = twoFaces(
        R"({"name": "screen", "primitive": {"shape": "box", "size": [3, 0.05, 2]}, "material": {"baseColor": [0, 0, 0], "specular": 0}, "translation": [0, 1, 0.3]},)");
    const auto given = with(kFew, {"gi.surfels.most=96", "gi.surfels.pairs=all"});
    const Image expected =
        pictureOf(scene, surfels(with(given, {"gi.surfels.rays=every"}), 16, 12));
    expectMean(scene, surfels(with(given, {"gi.surfels.rays=one"}), 16, 12), expected, 64, 0.003);
}

/// A plane of 4 m by 4 m in y = 0 under a sun, and a box of fog beside it that is not in the
/// sun's way.
struct PlaneAndFog {
    static constexpr double kLux = 30, kAlbedo = 0.8;
    dvec3 scattering{0.3, 0.5, 0.2}, absorption{0.1, 0, 0.3};
    double anisotropy = 0.4;
    dvec3 minimum{2.5, 0.5, -1.5}, maximum{4.5, 2, 1.5};
    dvec3 eye{3, 1.2, 6};
    double yfov = 0.5;
    bool turned = false; // the plane's normal down

    [[nodiscard]] std::string json() const {
        const dvec3 size = maximum - minimum, middle = 0.5 * (maximum + minimum);
        return fmt::format(
            R"({{"tyndall": 1, "nodes": [
            {{"name": "floor", "primitive": {{"shape": "plane", "size": [4, 4]}}, "material": {{"baseColor": [{0}, {0}, {0}], "specular": 0}},
                "rotation": [0, 0, {19}, {20}]}},
            {{"name": "fog", "medium": {{"type": "homogeneous", "shape": "box", "size": [{1}, {2}, {3}], "scattering": [{4}, {5}, {6}],
                "absorption": [{7}, {8}, {9}], "anisotropy": {10}}}, "translation": [{11}, {12}, {13}]}},
            {{"name": "sun", "light": {{"type": "directional", "intensity": {14}}}, "rotation": [-0.70710678, 0, 0, 0.70710678]}},
            {{"name": "eye", "camera": {{"type": "perspective", "yfov": {15}}}, "translation": [{16}, {17}, {18}]}}],
            "camera": "eye"}})",
            kAlbedo, size.x, size.y, size.z, scattering.x, scattering.y, scattering.z, absorption.x,
            absorption.y, absorption.z, anisotropy, middle.x, middle.y, middle.z, kLux, yfov, eye.x,
            eye.y, eye.z, turned ? 1 : 0, turned ? 0 : 1);
    }

    [[nodiscard]] dvec3 direction(int x, int y, int width, int height) const {
        const double slope = std::tan(yfov / 2);
        return glm::normalize(dvec3(((x + 0.5) / width * 2 - 1) * slope * width / height,
                                    (1 - (y + 0.5) / height * 2) * slope, -1));
    }

    /// Metres of a ray inside the fog, from and to.
    [[nodiscard]] dvec2 span(const dvec3& origin, const dvec3& along, double end) const {
        double t0 = 0, t1 = end;
        for (int axis = 0; axis < 3; ++axis) {
            double a = (minimum[axis] - origin[axis]) / along[axis],
                   b = (maximum[axis] - origin[axis]) / along[axis];
            if (a > b) std::swap(a, b);
            t0 = std::max(t0, a);
            t1 = std::min(t1, b);
        }
        return {t0, std::max(t0, t1)};
    }

    /// Nits that reach the eye: midpoints along the ray and over the plane.
    [[nodiscard]] dvec3 lightTo(const dvec3& along) const {
        constexpr int kSteps = 48, kCells = 96;
        const dvec2 way = span(eye, along, 1e9);
        const dvec3 extinction = scattering + absorption;
        const double step = (way.y - way.x) / kSteps, cell = 4.0 / kCells,
                     radiance = kAlbedo / kPi * kLux;
        dvec3 sum(0);
        for (int i = 0; i < kSteps && step > 0; ++i) {
            const dvec3 point = eye + along * (way.x + (i + 0.5) * step);
            dvec3 arriving(0);
            for (int z = 0; z < kCells; ++z)
                for (int x = 0; x < kCells; ++x) {
                    const dvec3 off = dvec3((x + 0.5) * cell - 2, 0, (z + 0.5) * cell - 2) - point;
                    const double squared = glm::dot(off, off), distance = std::sqrt(squared);
                    const dvec2 inside = span(point, off / distance, distance);
                    // Light travels along -off, then to the eye along -along.
                    const double cosine = glm::dot(off / distance, along), g = anisotropy;
                    const double phase =
                        (1 - g * g) / (4 * kPi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
                    arriving += glm::exp(-extinction * (inside.y - inside.x)) *
                                (radiance * point.y / distance / squared * cell * cell * phase);
                }
            const dvec3 before = glm::exp(-extinction * ((i + 0.5) * step));
            sum += before * scattering * arriving * step;
        }
        return sum;
    }
};

TEST(Surfels, AllPairsAreTheIntegralOverThePlaneAndTheRay) {
    const PlaneAndFog scene;
    const std::vector<std::string> settings = {
        "gi.surfels.pairs=all",    "gi.surfels.size=0.5",
        "gi.surfels.most=131072",  "gi.surfels.far=0",
        "gi.surfels.intervals=32", "gi.surfels.jitter=false",
        "gi.surfels.rays=none",    "gi.surfels.blur=false",
        "gi.surfels.march=full",   "media.march.minTransmittance=0"};
    const int width = 16, height = 12;
    const Image picture = pictureOf(sceneFromJson(scene.json()), surfels(settings, width, height));
    int compared = 0;
    for (int y = 1; y < height; y += 3)
        for (int x = 1; x < width; x += 2) {
            const dvec3 expected = scene.lightTo(scene.direction(x, y, width, height));
            const float* found = picture.at(x, y);
            if (expected.x == 0) {
                EXPECT_EQ(found[0], 0) << x << ", " << y;
                continue;
            }
            ++compared;
            printf("%2d, %2d: %.4f %.4f %.4f, over the integral %.4f %.4f %.4f\n", x, y,
                   double(found[0]), double(found[1]), double(found[2]),
                   double(found[0]) / expected.x, double(found[1]) / expected.y,
                   double(found[2]) / expected.z);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(double(found[c]) / expected[c], 1, 0.02)
                    << x << ", " << y << ", channel " << c;
        }
    EXPECT_GE(compared, 8);
}

TEST(Surfels, BothSidesOfAPlaneReflectWhatReachesThem) {
    const std::vector<std::string> settings = {"gi.surfels.pairs=all", "gi.surfels.rays=none",
                                               "gi.surfels.jitter=false", "gi.surfels.blur=false",
                                               "gi.surfels.march=full"};
    PlaneAndFog scene;
    const double up =
        test::meanOf(pictureOf(sceneFromJson(scene.json()), surfels(settings, 16, 12)));
    scene.turned = true;
    const double down =
        test::meanOf(pictureOf(sceneFromJson(scene.json()), surfels(settings, 16, 12)));
    EXPECT_GT(up, 0);
    EXPECT_NEAR(down / up, 1, 0.005); // triangles are cut elsewhere
    // No light leaves the side that the sun does not see.
    for (const bool turned : {false, true}) {
        scene.turned = turned;
        scene.minimum = {2.5, -2, -1.5};
        scene.maximum = {4.5, -0.5, 1.5};
        scene.eye = {3, -1.2, 6};
        EXPECT_EQ(test::meanOf(pictureOf(sceneFromJson(scene.json()), surfels(settings, 16, 12))),
                  0)
            << turned;
    }
}

TEST(Surfels, OneSurfelIsADisk) {
    // A triangle of three surfels, two of which are cut out: the corner with alpha 1 has two
    // thirds of it at the surfel next to it. A layer of thin fog lies above; a ray down the
    // disk's axis sees πr²/(r² + d²) of its radiance, and one far aside A cos θ/d².
    const double area = 1.5, side = std::sqrt(area * 4 / std::sqrt(3.0)), disk = area / 3, lux = 20,
                 albedo = 0.7, sigma = 0.01, thickness = 0.002, pixel = 1;
    const int size = 21;
    for (const double height : {0.03, 0.1, 0.4, 1.0, 4.0}) {
        Scene scene = sceneFromJson(fmt::format(
            R"({{"tyndall": 1, "nodes": [
            {{"name": "surface", "primitive": {{"shape": "plane", "size": [1, 1]}}, "material": {{"baseColor": [{0}, {0}, {0}], "specular": 0}}}},
            {{"name": "fog", "medium": {{"type": "homogeneous", "shape": "box", "size": [60, {1}, 60], "scattering": [{2}, {2}, {2}],
                "absorption": [0, 0, 0]}}, "translation": [0, {3}, 0]}},
            {{"name": "sun", "light": {{"type": "directional", "intensity": {4}}}, "rotation": [-0.70710678, 0, 0, 0.70710678]}},
            {{"name": "eye", "camera": {{"type": "orthographic", "ymag": {5}}}, "translation": [0, 20, 0], "rotation": [-0.70710678, 0, 0, 0.70710678]}}],
            "camera": "eye"}})",
            albedo, thickness, sigma, height, lux, 0.5 * pixel * size));
        Mesh& mesh = scene.meshes.at(0);
        const auto corner = [&](double turn) {
            return vec3(float(side / std::sqrt(3.0) * std::sin(turn)), 0,
                        float(side / std::sqrt(3.0) * std::cos(turn)));
        };
        mesh.positions = {corner(0), corner(2 * kPi / 3), corner(4 * kPi / 3)};
        // Of weights 2/3, 1/6, 1/6: half of the way from the middle to the first corner.
        const vec3 surfel = 0.5f * mesh.positions[0];
        for (vec3& position : mesh.positions) position -= surfel;
        mesh.normals.assign(3, vec3(0, 1, 0));
        mesh.tangents.clear();
        mesh.uvs = {};
        mesh.colors = {vec4(1), vec4(1, 1, 1, 0), vec4(1, 1, 1, 0)};
        mesh.indices = {0, 1, 2};
        mesh.bounds = {};
        for (const vec3& position : mesh.positions) mesh.bounds.include(dvec3(position));
        scene.materials.at(0).alphaMode = AlphaMode::Mask;
        scene.materials.at(0).alphaCutoff = 0.5f;
        const Image picture = pictureOf(
            scene, surfels({"gi.surfels.pairs=all", "gi.surfels.size=256", "gi.surfels.far=0",
                            "gi.surfels.intervals=8", "gi.surfels.rays=none",
                            "gi.surfels.blur=false", "gi.surfels.march=full"},
                           size, size));
        const double unit = albedo / kPi * lux * sigma / (4 * kPi) * thickness, r2 = disk / kPi;
        const auto at = [&](int x, int y) {
            return double(picture.at(size / 2 + x, size / 2 + y)[0]) / unit;
        };
        const double onAxis = at(0, 0), expected = kPi * r2 / (r2 + height * height);
        printf("%.2f m before the disk of %.2f m: %.4f of its light\n", height, std::sqrt(r2),
               onAxis / expected);
        EXPECT_NEAR(onAxis / expected, 1, 0.01)
            << height; // the fog's own depth, and a layer as thick as 1/15 of the least height
        if (height < 3) continue;
        // From ten radii away, in all directions: by (r/d)² and less.
        for (const auto& [x, y] :
             {std::pair(3, 0), std::pair(0, -5), std::pair(-6, 6), std::pair(10, 10)}) {
            const double squared = x * x + y * y + height * height;
            EXPECT_NEAR(at(x, y) / (disk * height / std::pow(squared, 1.5)), 1, 0.015)
                << x << ", " << y;
        }
    }
}

TEST(Surfels, LightOfAPlaneIsEvenDownToItsSurface) {
    // A plane of 6 m, lit evenly, seen from above in parallel; a layer of fog at `height`
    // surfels above it. From each point of it the plane fills 2π, less what lies behind its
    // edges: four rectangles with a corner below the point.
    const double side = 6, lux = 20, albedo = 0.7, sigma = 0.01, thickness = 0.002,
                 pixel = 0.2; // metres
    const int width = 12, height = 30;
    for (const double above : {0.05, 0.2, 1.0, 3.0}) {
        const double level = above * pixel;
        const Scene scene = sceneFromJson(fmt::format(
            R"({{"tyndall": 1, "nodes": [
            {{"name": "floor", "primitive": {{"shape": "plane", "size": [{0}, {0}]}}, "material": {{"baseColor": [{1}, {1}, {1}], "specular": 0}}}},
            {{"name": "fog", "medium": {{"type": "homogeneous", "shape": "box", "size": [30, {2}, 30], "scattering": [{3}, {3}, {3}],
                "absorption": [0, 0, 0]}}, "translation": [0, {4}, 0]}},
            {{"name": "sun", "light": {{"type": "directional", "intensity": {5}}}, "rotation": [-0.70710678, 0, 0, 0.70710678]}},
            {{"name": "eye", "camera": {{"type": "orthographic", "ymag": {6}}}, "translation": [0, 10, 0], "rotation": [-0.70710678, 0, 0, 0.70710678]}}],
            "camera": "eye"}})",
            side, albedo, thickness, sigma, level, lux, 0.5 * pixel * height));
        const Image picture = pictureOf(
            scene, surfels({"gi.surfels.pairs=all", "gi.surfels.size=1", "gi.surfels.most=131072",
                            "gi.surfels.far=0", "gi.surfels.intervals=8", "gi.surfels.rays=none",
                            "gi.surfels.blur=false", "gi.surfels.march=full"},
                           width, height));
        double sum = 0, least = 1e30, most = 0;
        int pixels = 0;
        for (int y = height / 2 - 6; y < height / 2 + 6; ++y)
            for (int x = 0; x < width; ++x) {
                const double px = (x + 0.5 - width / 2) * pixel,
                             py = (y + 0.5 - height / 2) * pixel;
                double angle = 0;
                for (const double a : {side / 2 - px, side / 2 + px})
                    for (const double b : {side / 2 - py, side / 2 + py})
                        angle +=
                            std::atan(a * b / (level * std::sqrt(a * a + b * b + level * level)));
                const double expected = albedo / kPi * lux * angle * sigma / (4 * kPi) * thickness;
                const double ratio = double(picture.at(x, y)[0]) / expected;
                sum += ratio;
                least = std::min(least, ratio);
                most = std::max(most, ratio);
                ++pixels;
            }
        printf("%.2f surfels above the plane: %.4f of the light, from %.4f to %.4f\n", above,
               sum / pixels, least, most);
        EXPECT_NEAR(sum / pixels, 1, 0.05) << above;
    }
}

TEST(Surfels, AFogOfNoDensityChangesNoBit) {
    const std::string nothing =
        R"({"name": "nothing", "medium": {"type": "homogeneous", "shape": "box", "size": [2, 2, 2], "scattering": [0, 0, 0],
        "absorption": [0, 0, 0]}, "translation": [0.3, 1, 0.2]},)";
    for (const std::string& fog : {std::string(), kFog}) {
        RenderOptions options = surfels({});
        options.terms = kAllTerms;
        const Image
            without = sharedRenderer().render(sceneFromJson(corner(50, fog)), options).beauty,
            other =
                sharedRenderer().render(sceneFromJson(corner(50, fog + nothing)), options).beauty;
        EXPECT_GT(test::meanOf(without), 0);
        EXPECT_EQ(without.pixels, other.pixels);
    }
}

TEST(Surfels, AHundredThousandDimSurfelsAddUp) {
    // A narrow view makes surfels of 12 mm and fewer of 24 mm; in either case of more than
    // single steps of 16 bits or of half precision. Each has 1e-5 of the light.
    const Scene scene = sceneFromJson(fmt::format(
        R"({{"tyndall": 1, "nodes": [
        {{"name": "floor", "primitive": {{"shape": "plane", "size": [4, 4]}}, "material": {{"baseColor": [0.8, 0.6, 0.4], "specular": 0}}}}, {}
        {{"name": "lamp", "light": {{"type": "point", "intensity": 1e-6}}, "translation": [0.5, 2, 0.3]}},
        {{"name": "eye", "camera": {{"type": "perspective", "yfov": 0.07}}, "translation": [0, 1.5, 6]}}],
        "camera": "eye"}})",
        kFog));
    const auto meanWith = [&](const char* most, const char* surfelizer) {
        return test::meanOf(pictureOf(
            scene, surfels({"gi.surfels.pairs=all", "gi.surfels.far=0", "gi.surfels.size=0.5",
                            "gi.surfels.intervals=8", "gi.surfels.rays=none",
                            "gi.surfels.jitter=false", "gi.surfels.blur=false",
                            "gi.surfels.march=eighth", std::string("gi.surfels.most=") + most,
                            std::string("gi.surfels.surfelizer=") + surfelizer},
                           16, 12)));
    };
    const double few = meanWith("2048", "compute"), quarter = meanWith("32768", "compute");
    EXPECT_GT(few, 0);
    for (const char* surfelizer : {"tessellator", "compute"}) {
        const double all = meanWith("131072", surfelizer);
        printf("%s: %.6e with 1e5 surfels, %.5f of a quarter's, %.5f of 2e3 surfels'\n", surfelizer,
               all, all / quarter, all / few);
        EXPECT_NEAR(all / quarter, 1, 0.001)
            << surfelizer; // with half precision it would be some hundredths
        EXPECT_NEAR(all / few, 1, 0.02) << surfelizer;
    }
}

/// Of both receivers, with a medium that only some rays meet.
Image beautyBy(TestRenderer& renderer, const std::vector<std::string>& settings) {
    RenderOptions options = surfels(settings, 24, 16);
    options.terms = terms(Term::LSVE, Term::LSSE);
    return renderer
        .render(twoFaces(
                    R"({"name": "ball", "medium": {"type": "homogeneous", "shape": "sphere", "size": [1, 1, 1], "scattering": [2, 2, 2],
                    "absorption": [0, 0, 0], "anisotropy": -0.4}, "translation": [0.5, 3.4, 0]},)"),
                options)
        .beauty;
}

TEST(Surfels, UndefinedMemoryNeverReachesThePicture) {
    RendererOptions poisoned;
    poisoned.poison = true;
    static TestRenderer renderer(gl::Backend::Egl, poisoned);
    for (const char* mode : {"gi.mode=corrected", "gi.mode=paper"})
        for (const char* march : {"gi.surfels.march=full", "gi.surfels.march=quarter"})
            EXPECT_EQ(beautyBy(renderer, {mode, march}).pixels,
                      beautyBy(sharedRenderer(), {mode, march}).pixels)
                << mode << ", " << march;
}

/// A picture does not depend on the view that was rendered before, and moving the eye a little moves light a little: no more than other chances of the hierarchy do.
TEST(Surfels, ASmallStepOfTheEyeDoesNotMakeLightFlicker) {
    const auto from = [&](double step, uint32_t seed) {
        Scene scene = twoFaces();
        for (size_t node = 0; node < scene.nodes.size(); ++node)
            if (scene.nodes[node].camera != kNone)
                setNodeTransform(scene, int(node), {step, 1.5, 6}, dquat(1, 0, 0, 0), dvec3(1));
        RenderOptions options = surfels({"gi.surfels.blur=false", "gi.surfels.epsilon=0.3"});
        options.seed = seed;
        return pictureOf(scene, options);
    };
    const auto relmse = [](const Image& a, const Image& b) {
        return compareImages(a, b).value().relmse;
    };
    double steps = 0, seeds = 0;
    for (uint32_t i = 0; i < 6; ++i) {
        steps += relmse(from(0.002 * (i + 1), 0), from(0.002 * i, 0)) / 6;
        seeds += relmse(from(0, i + 1), from(0, i)) / 6;
    }
    printf("relmse from step to step %.5f, from seed to seed %.5f\n", steps, seeds);
    EXPECT_LT(steps, 0.1 * seeds);
}

TEST(Surfels, WhatIsDarkOrOutOfReachIsNotSplatted) {
    const auto countsOf = [](const Scene& scene, const std::vector<std::string>& settings) {
        RenderOptions options = surfels(settings, 16, 12);
        options.statistics = true;
        return sharedRenderer().render(scene, options).statistics;
    };
    // A lamp that looks down, at a height above the floor.
    const auto scene = [](double y, double far) {
        return sceneFromJson(fmt::format(
            R"({{"tyndall": 1, "nodes": [
            {{"name": "floor", "primitive": {{"shape": "plane", "size": [4, 4]}}, "translation": [0, 0, {0}]}},
            {{"name": "wall", "primitive": {{"shape": "box", "size": [4, 3, 0.1]}}, "translation": [0, 1.5, {1}]}}, {2}
            {{"name": "lamp", "light": {{"type": "spot", "intensity": 50, "outerConeAngle": {4}}}, "translation": [0, {3}, {0}],
                "rotation": [-0.70710678, 0, 0, 0.70710678]}},
            {{"name": "eye", "camera": {{"type": "perspective", "yfov": 0.8}}, "translation": [0, 1.5, 6]}}],
            "camera": "eye"}})",
            far, far - 2, kFog, y, far < 0 ? 1.2 : 0.3));
    };
    const auto lit = countsOf(scene(2, 0), {});
    EXPECT_GT(lit.at("surfels_lit.gi.surfels"), 0);
    EXPECT_LT(lit.at("surfels_lit.gi.surfels"), 0.5 * lit.at("surfels.gi.surfels"));
    // A quad a level at most.
    EXPECT_GE(lit.at("splats.gi.surfels"), lit.at("surfels_lit.gi.surfels"));
    EXPECT_LE(lit.at("splats.gi.surfels"), 6 * lit.at("surfels_lit.gi.surfels"));
    EXPECT_GT(lit.at("pairs.gi.surfels"), 0);
    // The printed shells end: a floor farther away than that reaches no fog.
    const auto far = countsOf(scene(2, -100), {"gi.mode=paper", "gi.surfels.levels=1",
                                               "gi.surfels.size=0.5"});
    EXPECT_GT(far.at("surfels_lit.gi.surfels"), 0);
    EXPECT_EQ(far.at("splats.gi.surfels"), 0);
    EXPECT_EQ(far.at("pairs.gi.surfels"), 0);
    // Nothing is below it.
    const auto dark = countsOf(scene(-1, 0), {});
    EXPECT_EQ(dark.at("surfels_lit.gi.surfels"), 0);
    EXPECT_EQ(dark.at("splats.gi.surfels"), 0);
}

} // namespace
} // namespace tyndall::test
