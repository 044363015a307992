// What virtual lights see, from points that are splatted, against rays through the very texels.

#include <bit>
#include <cmath>
#include <random>

#include "gl/api.h"
#include "gl/buffer.h"
#include "gl/gl_fixture.h"
#include "gl/shader_library.h"
#include "support/content.h"
#include "support/render.h"
#include "volumetric_gi/shared/traced_scene.h"
#include "volumetric_gi/vpl/vpl_maps.h"
#include "volumetric_gi/vpl/vpl_points.h"

namespace tyndall::test {
namespace {

using namespace volumetric_gi;

using VplMaps = GlTest;
TYNDALL_GL_TESTS(VplMaps);

constexpr uint32_t kSide = 32, kPoints = 4096, kSets = 4;
constexpr size_t kTexels = size_t(kSide) * kSide, kStride = kTexels + 1;

/// A room that is open to one side, with a ball and a thin board in it, on a ground of 400 m.
const char* const kOpenRoom = R"({"tyndall": 1, "nodes": [
    {"name": "ground", "primitive": {"shape": "plane", "size": [400, 400]}, "translation": [0, -0.5, 0]},
    {"name": "floor", "primitive": {"shape": "box", "size": [4, 0.1, 4]}, "translation": [0, -0.05, 0]},
    {"name": "ceiling", "primitive": {"shape": "box", "size": [4, 0.1, 4]}, "translation": [0, 3.05, 0]},
    {"name": "left", "primitive": {"shape": "box", "size": [0.1, 3, 4]}, "translation": [-2, 1.5, 0]},
    {"name": "back", "primitive": {"shape": "box", "size": [4, 3, 0.1]}, "translation": [0, 1.5, -2]},
    {"name": "ball", "primitive": {"shape": "sphere", "size": [0.8, 0.8, 0.8]}, "translation": [0.8, 0.4, -0.5]},
    {"name": "board", "primitive": {"shape": "box", "size": [1, 1, 0.02]}, "translation": [-0.5, 1, 0]}
    ]})";

/// A scene, lights in it, and maps of both kinds.
class Maps {
public:
    explicit Maps(const char* json) : scene_(sceneFromJson(json)) {
        surfaces_ = std::move(tracing::SurfaceScene::build(scene_, dvec3(0), 1).value());
        for (const tracing::SceneTriangle& triangle : surfaces_->triangles())
            triangles_.push_back(packTriangle(triangle));
    }

    void addLight(const dvec3& position) {
        lights_.lights.emplace_back();
        lights_.places.push_back({vec4(vec3(position), 0), vec4(0)});
        lights_.positions.push_back(position);
        lights_.margins.push_back(0);
    }

    void castRays() { rays_ = makeVisibilityMaps(*surfaces_, lights_, kSide, 0); }

    std::vector<uint32_t> splat() {
        const SurfacePoints made =
            makeSurfacePoints(*surfaces_, lights_.positions, kPoints, kSets, seed());
        EXPECT_EQ(made.points.size(), size_t(kPoints) * kSets);
        gl::ShaderLibrary library;
        Result<const gl::Program*> program = library.compute("gi/vpl/splat_maps.comp");
        if (!program) throw std::runtime_error(program.message());
        gpu::VplParams params{};
        params.lightCount = uint32_t(lights_.lights.size());
        params.mapSide = kSide;
        const gl::Buffer vpl("vpl", std::as_bytes(std::span(&params, 1))),
            points("params", std::as_bytes(std::span(&made.params, 1))),
            places("places", std::as_bytes(std::span(lights_.places))),
            triangles("triangles", std::as_bytes(std::span(triangles_))),
            all("points", std::as_bytes(std::span(made.points)));
        gl::Buffer maps("maps", lights_.lights.size() * kStride * sizeof(uint32_t));
        const auto bind = [&](GLenum target, const char* name, const gl::Buffer& buffer) {
            glBindBufferBase(target, GLuint((*program)->find(name)->binding), buffer.id());
        };
        glUseProgram((*program)->id());
        bind(GL_UNIFORM_BUFFER, "Vpl", vpl);
        bind(GL_UNIFORM_BUFFER, "Points", points);
        bind(GL_SHADER_STORAGE_BUFFER, "VplPlaces", places);
        bind(GL_SHADER_STORAGE_BUFFER, "TracedTriangles", triangles);
        bind(GL_SHADER_STORAGE_BUFFER, "VplPoints", all);
        bind(GL_SHADER_STORAGE_BUFFER, "VplMaps", maps);
        glDispatchCompute(params.lightCount, 1, 1);
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        glUseProgram(0);
        return maps.readAll<uint32_t>();
    }

    [[nodiscard]] size_t lightCount() const { return lights_.lights.size(); }
    [[nodiscard]] const std::vector<uint32_t>& rays() const { return rays_; }
    [[nodiscard]] bool samePlane(uint32_t one, uint32_t other) const {
        if (one == gpu::kNoTriangle || other == gpu::kNoTriangle) return one == other;
        return glm::all(
            glm::lessThan(glm::abs(triangles_[one].plane - triangles_[other].plane), vec4(1e-3f)));
    }
    /// Do the rays through all texels around meet one plane, or nothing? What is left out is outlines.
    [[nodiscard]] bool plain(size_t light, int x, int y, int around) const {
        for (int dy = -around; dy <= around; ++dy)
            for (int dx = -around; dx <= around; ++dx)
                if (!samePlane(ray(light, x, y), ray(light, x + dx, y + dy))) return false;
        return true;
    }
    [[nodiscard]] uint32_t ray(size_t light, int x, int y) const {
        return rays_[light * kStride + size_t(y) * kSide + size_t(x)];
    }
    /// Metres from a light to the nearest point of any surface.
    [[nodiscard]] double nearest(size_t light) const {
        double squared = 1e30;
        for (const tracing::SceneTriangle& t : surfaces_->triangles())
            for (int i = 0; i <= 40; ++i)
                for (int k = 0; k <= 40 - i; ++k) {
                    const dvec3 off = t.corners[0] + (t.corners[1] - t.corners[0]) * (i / 40.0) +
                                      (t.corners[2] - t.corners[0]) * (k / 40.0) -
                                      lights_.positions[light];
                    squared = std::min(squared, glm::dot(off, off));
                }
        return std::sqrt(squared);
    }

private:
    Scene scene_;
    std::unique_ptr<tracing::SurfaceScene> surfaces_;
    std::vector<gpu::TracedTriangle> triangles_;
    VplSet lights_;
    std::vector<uint32_t> rays_;
};

TEST_P(VplMaps, PointsShowWhatRaysMeet) {
    Maps maps(kOpenRoom);
    std::mt19937_64 random(uint64_t(seed()) + 11);
    std::uniform_real_distribution<double> across(-1.8, 1.8), up(0.15, 2.9);
    for (int i = 0; i < 48; ++i) maps.addLight({across(random), up(random), across(random)});
    maps.castRays();
    const std::vector<uint32_t> splatted = maps.splat();

    size_t plain = 0, wrong = 0, open = 0, filled = 0, all = 0, holes = 0, seen = 0, same = 0;
    for (size_t light = 0; light < maps.lightCount(); ++light) {
        for (int y = 0; y < int(kSide); ++y)
            for (int x = 0; x < int(kSide); ++x) {
                const uint32_t ray = maps.ray(light, x, y),
                               point = splatted[light * kStride + size_t(y) * kSide + size_t(x)];
                ++all;
                same += maps.samePlane(ray, point);
                if (ray != gpu::kNoTriangle) {
                    ++seen;
                    holes += point == gpu::kNoTriangle;
                }
                if (x < 3 || y < 3 || x >= int(kSide) - 3 || y >= int(kSide) - 3) continue;
                if (ray != gpu::kNoTriangle && maps.plain(light, x, y, 1)) {
                    ++plain;
                    wrong += !maps.samePlane(ray, point);
                }
                if (ray == gpu::kNoTriangle && maps.plain(light, x, y, 3)) {
                    ++open;
                    filled += point != gpu::kNoTriangle;
                }
            }
        const float reach = std::bit_cast<float>(splatted[light * kStride + kTexels]);
        EXPECT_GE(reach, 0) << light; // 0: a disc is about it
        EXPECT_LE(reach, maps.nearest(light)) << light;
    }
    const auto part = [](size_t some, size_t of) { return double(some) / double(of); };
    printf(
        "the ray's plane: %.4f of all texels; another than the ray's and all its neighbours': %.5f; "
        "nothing where a ray meets something: %.5f; something where no ray near by does: %.5f\n",
        part(same, all), part(wrong, plain), part(holes, seen), part(filled, open));
    ASSERT_GT(plain, 10000u);
    ASSERT_GT(open, 500u);
    // Half of the points are on the ground and on faces that no light sees: with 2,000 in sight discs are some two texels wide, and outlines, of which
    // a tenth of the texels have one, are as uncertain.
    EXPECT_GT(part(same, all), 0.88);
    // Discs that cover three times the area leave exp(-3) of it open to what is behind, less where points lie evenly.
    EXPECT_LT(part(wrong, plain), 0.02);
    EXPECT_LT(part(holes, seen), 1e-3);
    // The ball's triangles are smaller than discs, which stand out from it.
    EXPECT_LT(part(filled, open), 0.03);
}

TEST_P(VplMaps, PointsGiveTheSameMapWhateverTheOrderOfThreads) {
    Maps maps(kOpenRoom);
    maps.addLight({0.5, 1, 1});
    maps.addLight({-1.9, 0.05, -1.9}); // a corner: more large discs than threads share
    const std::vector<uint32_t> once = maps.splat();
    for (int i = 0; i < 3; ++i) EXPECT_EQ(maps.splat(), once);
}

} // namespace
} // namespace tyndall::test
