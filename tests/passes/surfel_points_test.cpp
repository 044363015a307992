// Surfels of patches by the tessellator and by the compute shader that stands in for it: the same
// points, and what every set of points of a patch obeys.

#include <cmath>
#include <cstring>
#include <optional>

#include <glm/gtc/matrix_transform.hpp>

#include "framegraph/gl/executor.h"
#include "gl/gl_fixture.h"
#include "gl/shader_library.h"
#include "renderer/gpu_scene.h"
#include "renderer/surface_drawer.h"
#include "volumetric_gi/surfels/surfel_points.h"

namespace tyndall::test {
namespace {

using namespace volumetric_gi;

/// A patch in barycentric coordinates of a triangle, of its second and third corner.
constexpr dvec2 kWhole[3] = {{0, 0}, {1, 0}, {0, 1}},
                kPart[3] = {{0.5, 0.25}, {0.125, 0.75}, {0.25, 0.125}};

/// Two triangles of no particular shape, with colours at their corners and texture coordinates.
Mesh colouredMesh() {
    Mesh mesh;
    mesh.name = "triangles";
    mesh.material = 0;
    mesh.positions = {{0, 0, 0}, {3, 1, 0}, {1, 2, 5}, {-1, 4, 2}};
    mesh.normals.assign(4, vec3(0, 1, 0));
    mesh.uvs[0] = {{0, 0}, {1, 0}, {0.5f, 1}, {0, 1}};
    mesh.colors = {{1, 0.5f, 0.25f, 1}, {0.25f, 1, 0.5f, 1}, {0.5f, 0.25f, 1, 1}, {0, 0, 1, 1}};
    mesh.indices = {0, 1, 2, 2, 1, 3};
    for (const vec3& p : mesh.positions) mesh.bounds.include(dvec3(p));
    mesh.version = nextVersion();
    return mesh;
}

/// One object a transform: rotated, mirrored, scaled unevenly.
const dmat4 kTransforms[] = {
    glm::translate(dmat4(1), dvec3(3, -2, 7)) * glm::rotate(dmat4(1), 0.7, dvec3(0.6, 0, 0.8)),
    glm::translate(dmat4(1), dvec3(-5, 0, 1)) * glm::scale(dmat4(1), dvec3(-1, 1, 1)),
    glm::rotate(dmat4(1), 2.0, dvec3(0, 1, 0)) * glm::scale(dmat4(1), dvec3(0.1, 2, 30)) *
        glm::rotate(dmat4(1), 0.5, dvec3(1, 0, 0))};

Scene sceneOf(const Material& material, bool textured) {
    Scene scene;
    scene.materials.push_back(material);
    if (textured) {
        ImageData image;
        image.width = image.height = 2;
        image.rgba = {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255};
        scene.images.push_back(image);
        Texture texture;
        texture.image = 0;
        scene.textures.push_back(texture);
        scene.materials[0].baseColorTexture.texture = 0;
    }
    scene.meshes.push_back(colouredMesh());
    for (const dmat4& transform : kTransforms) {
        Node node;
        node.meshes = {0};
        node.matrix = transform;
        scene.nodes.push_back(node);
    }
    SceneVersions& v = scene.versions;
    v.structure = v.transforms = v.meshes = v.materials = v.textures = nextVersion();
    return scene;
}

Material lambert() {
    Material material;
    material.baseColor = vec4(0.8f, 0.6f, 0.4f, 1);
    material.metallic = 0;
    material.specular = 0;
    return material;
}

/// A patch where it is in space.
struct Placed {
    dvec3 corners[3];
    dvec3 triangle[3];
    double area = 0;
    [[nodiscard]] dvec3 centre() const { return (corners[0] + corners[1] + corners[2]) / 3.0; }
    [[nodiscard]] double size() const {
        return glm::distance(corners[0], corners[1]) + glm::distance(corners[1], corners[2]);
    }
    /// Barycentric coordinates of a point of the plane.
    [[nodiscard]] dvec3 weights(const dvec3& point) const {
        const dvec3 n = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        dvec3 result;
        for (int i = 0; i < 3; ++i)
            result[i] = glm::dot(n, glm::cross(corners[(i + 2) % 3] - corners[(i + 1) % 3],
                                               point - corners[(i + 1) % 3])) /
                        glm::dot(n, n);
        return result;
    }
};

class SurfelPointsTest : public GlTest {
protected:
    void SetUp() override {
        GlTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        library_.emplace();
        executor_.emplace(*library_);
        surfaces_.emplace(*executor_);
        drawer_.emplace(*surfaces_, settings_);
    }
    void TearDown() override {
        drawer_.reset();
        surfaces_.reset();
        executor_.reset();
        library_.reset();
        GlTest::TearDown();
    }

    /// Patches of all levels, in all objects: whole triangles and parts of them.
    void place(const Scene& scene) {
        const Result<void> updated = surfaces_->update(scene, dvec3(0));
        ASSERT_TRUE(updated.ok()) << updated.message();
        drawer_->update();
        plan_ = {};
        placed_.clear();
        ASSERT_EQ(drawer_->triangleSetCount(), std::size(kTransforms));
        for (uint32_t set = 0; set < drawer_->triangleSetCount(); ++set) {
            const dmat4 renderFromLocal = dmat4(drawer_->triangles(set).renderFromLocal);
            SurfelPlan::Set made{set, uint32_t(plan_.patches.size()), 0, plan_.surfels, 0};
            for (uint32_t level = 1; level <= gpu::kSurfelMostLevel; ++level)
                for (const dvec2* corners : {kWhole, kPart})
                    add(scene.meshes[0], renderFromLocal, corners, level);
            made.patches = uint32_t(plan_.patches.size()) - made.firstPatch;
            made.surfels = plan_.surfels - made.firstSurfel;
            plan_.sets.push_back(made);
        }
    }

    std::vector<gpu::Surfel> surfels(Surfelizer by) {
        fg::FrameGraph& graph = executor_->beginFrame();
        plugin::FrameInputs inputs{};
        inputs.surfaces = &*drawer_;
        const fg::BufferHandle made = addSurfels(graph, inputs, plan_, by, ++key_);
        graph.markOutput(made);
        const Result<void> done = executor_->execute();
        EXPECT_TRUE(done.ok()) << done.message();
        const std::vector<std::byte> bytes = executor_->readBuffer(made);
        std::vector<gpu::Surfel> result(plan_.surfels);
        EXPECT_GE(bytes.size(), result.size() * sizeof(gpu::Surfel));
        std::memcpy(result.data(), bytes.data(), result.size() * sizeof(gpu::Surfel));
        return result;
    }

    /// The surfels of a patch.
    [[nodiscard]] std::span<const gpu::Surfel> of(size_t patch,
                                                  const std::vector<gpu::Surfel>& all) const {
        return std::span(all).subspan(plan_.patches[patch].firstSurfel,
                                      surfelsOfLevel(plan_.patches[patch].level));
    }

    std::optional<gl::ShaderLibrary> library_;
    std::optional<fg::Executor> executor_;
    std::optional<GpuScene> surfaces_;
    GBufferSettings settings_{0, 1};
    std::optional<GpuSurfaceDrawer> drawer_;
    SurfelPlan plan_;
    std::vector<Placed> placed_;
    uint64_t key_ = 0;

private:
    void add(const Mesh& mesh, const dmat4& renderFromLocal, const dvec2* corners, uint32_t level) {
        const uint32_t triangle = level % 2;
        Placed placed;
        for (size_t i = 0; i < 3; ++i)
            placed.triangle[i] = dvec3(
                renderFromLocal * dvec4(dvec3(mesh.positions[mesh.indices[3 * triangle + i]]), 1));
        for (size_t i = 0; i < 3; ++i)
            placed.corners[i] = placed.triangle[0] +
                                corners[i].x * (placed.triangle[1] - placed.triangle[0]) +
                                corners[i].y * (placed.triangle[2] - placed.triangle[0]);
        placed.area = 0.5 * glm::length(glm::cross(placed.corners[1] - placed.corners[0],
                                                   placed.corners[2] - placed.corners[0]));
        gpu::SurfelPatch patch{};
        patch.corners = vec4(vec2(corners[0]), vec2(corners[1]));
        patch.lastCorner = vec2(corners[2]);
        patch.triangle = triangle;
        patch.level = level;
        patch.area = float(placed.area);
        patch.firstSurfel = plan_.surfels;
        plan_.surfels += surfelsOfLevel(level);
        plan_.patches.push_back(patch);
        placed_.push_back(placed);
    }
};
TYNDALL_GL_TESTS(SurfelPointsTest);

// Tessellators compute in fixed point with 16 bits after the point: some 1.5e-5 of the patch.
// The compute shader rounds as floats do.
constexpr double kFixedPoint = 4e-5;

TEST_P(SurfelPointsTest, TheTessellatorsSurfelsAreThoseOfTheComputeShader) {
    for (const bool textured : {false, true}) {
        place(sceneOf(lambert(), textured));
        const std::vector<gpu::Surfel> tessellated = surfels(Surfelizer::Tessellator),
                                       computed = surfels(Surfelizer::Compute);
        double farthest = 0, otherArea = 0, otherBase = 0, otherNormal = 0;
        for (size_t patch = 0; patch < placed_.size(); ++patch) {
            std::vector<bool> taken(surfelsOfLevel(plan_.patches[patch].level));
            for (const gpu::Surfel& one : of(patch, computed)) {
                size_t nearest = 0;
                double distance = 1e30;
                const auto others = of(patch, tessellated);
                for (size_t i = 0; i < others.size(); ++i) {
                    const double d =
                        double(glm::distance(vec3(others[i].position), vec3(one.position)));
                    if (d >= distance) continue;
                    distance = d;
                    nearest = i;
                }
                const gpu::Surfel& other = others[nearest];
                EXPECT_FALSE(taken[nearest]) << "level " << plan_.patches[patch].level;
                taken[nearest] = true;
                farthest = std::max(farthest, distance / placed_[patch].size());
                otherArea =
                    std::max(otherArea, std::abs(double(other.position.w / one.position.w) - 1));
                otherBase =
                    std::max(otherBase, double(glm::distance(other.base, one.base)));
                otherNormal =
                    std::max(otherNormal, double(glm::distance(other.normal, one.normal)));
            }
        }
        printf(
            "positions differ by %.1e of the patch, areas by %.1e, colours by %.1e, normals by %.1e\n",
            farthest, otherArea, otherBase, otherNormal);
        EXPECT_LT(farthest, kFixedPoint);
        EXPECT_LT(otherArea, 1e-6);
        // Interpolated colours change as places do; a texture of two texels changes twice as fast.
        EXPECT_LT(otherBase, 4 * kFixedPoint);
        EXPECT_LT(otherNormal, 1e-6);
    }
}

TEST_P(SurfelPointsTest, AsManyPatchesAsThereMayBeAreTessellated) {
    // Points of one object that outnumber what 16 bits count.
    place(sceneOf(lambert(), false));
    const gpu::SurfelPatch pattern = plan_.patches[2 * gpu::kSurfelMostLevel - 2];
    ASSERT_EQ(pattern.level, gpu::kSurfelMostLevel);
    const uint32_t each = surfelsOfLevel(pattern.level);
    for (const uint32_t surfels : {60000u, 66000u, 130000u}) {
        plan_ = {};
        const uint32_t patches = surfels / each;
        for (uint32_t i = 0; i < patches; ++i) {
            gpu::SurfelPatch patch = pattern;
            patch.firstSurfel = i * each;
            patch.area = float(i + 1); // which tells patches apart
            plan_.patches.push_back(patch);
        }
        plan_.surfels = patches * each;
        addSets(plan_, 0, 0);
        const std::vector<gpu::Surfel> tessellated = this->surfels(Surfelizer::Tessellator),
                                       computed = this->surfels(Surfelizer::Compute);
        size_t wrong = 0, first = 0;
        for (size_t patch = 0; patch < patches; ++patch) {
            double area = 0, expected = 0;
            for (uint32_t i = 0; i < each; ++i) {
                area += double(tessellated[patch * each + i].position.w);
                expected += double(computed[patch * each + i].position.w);
            }
            EXPECT_NEAR(expected / double(patch + 1), 1, 1e-5);
            if (std::abs(area / expected - 1) < 1e-5) continue;
            if (wrong++ == 0) first = patch;
        }
        EXPECT_EQ(wrong, 0u) << "of " << patches << " patches, of " << plan_.surfels
                             << " surfels; the first is patch " << first << ", from surfel "
                             << first * each;
    }
}

TEST_P(SurfelPointsTest, AreasSumToThePatchAndPointsToItsCentre) {
    place(sceneOf(lambert(), false));
    for (const Surfelizer by : {Surfelizer::Tessellator, Surfelizer::Compute}) {
        const std::vector<gpu::Surfel> all = surfels(by);
        const double tolerance = by == Surfelizer::Tessellator ? kFixedPoint : 1e-5;
        for (size_t patch = 0; patch < placed_.size(); ++patch) {
            SCOPED_TRACE(::testing::Message() << "by " << int(by) << ", patch " << patch
                                              << ", level " << plan_.patches[patch].level);
            const Placed& placed = placed_[patch];
            double area = 0, innermost = 1;
            dvec3 centre(0);
            for (const gpu::Surfel& surfel : of(patch, all)) {
                const dvec3 position = dvec3(surfel.position);
                area += double(surfel.position.w);
                centre += double(surfel.position.w) * position;
                const dvec3 weights = placed.weights(position);
                for (int i = 0; i < 3; ++i) innermost = std::min(innermost, weights[i]);
                EXPECT_NEAR(glm::dot(dvec3(surfel.normal), position - placed.corners[0]), 0,
                            1e-5 * placed.size());
            }
            EXPECT_NEAR(area / placed.area, 1, 1e-5); // sums of 61 floats
            EXPECT_LT(glm::distance(centre / area, placed.centre()), tolerance * placed.size());
            // The outermost ring is 1/(n + 1) of the way from the edges to the middle.
            EXPECT_NEAR(innermost, 1 / (3.0 * (plan_.patches[patch].level + 1)), 1e-3);
        }
    }
}

TEST_P(SurfelPointsTest, SharesAreThoseOfBandsBetweenScaledTriangles) {
    // Ring k is in the band between the triangles scaled by 1 - 2k/(n + 1) and 1 - 2(k +
    // 1)/(n + 1), of which its points have equal parts.
    place(sceneOf(lambert(), false));
    const std::vector<gpu::Surfel> all = surfels(Surfelizer::Tessellator);
    for (size_t patch = 0; patch < placed_.size(); ++patch) {
        const double n = plan_.patches[patch].level, step = 1 / (n + 1);
        std::vector<int> points(size_t(n / 2) + 1);
        for (const gpu::Surfel& surfel : of(patch, all)) {
            const dvec3 weights = placed_[patch].weights(dvec3(surfel.position));
            const double scale = 1 - 3 * std::min({weights.x, weights.y, weights.z}); // of the ring
            const double ring = std::floor((1 - scale) / (2 * step) + 1e-3);
            ASSERT_GE(ring, 0);
            ASSERT_LT(ring, double(points.size()));
            ++points[size_t(ring)];
            const double outer = 1 - 2 * ring * step, inner = std::max(outer - 2 * step, 0.0);
            const double segments = n - 2 * ring, count = segments > 0 ? 3 * segments : 1;
            EXPECT_NEAR(double(surfel.position.w) / placed_[patch].area,
                        (outer * outer - inner * inner) / count, 1e-6)
                << n;
        }
        for (size_t ring = 0; ring < points.size(); ++ring)
            EXPECT_EQ(points[ring], n > 2 * double(ring) ? 3 * int(n - 2 * double(ring)) : 1)
                << n << ", ring " << ring;
    }
}

TEST_P(SurfelPointsTest, ThreePointsIntegrateQuadraticFunctions) {
    // Over a triangle the mean of (x·v)² is (c₀² + c₁² + c₂² + 9 m²)/12, c at the corners
    // and m at the centre.
    place(sceneOf(lambert(), false));
    const std::vector<gpu::Surfel> all = surfels(Surfelizer::Compute);
    for (size_t patch = 0; patch < placed_.size(); ++patch) {
        if (plan_.patches[patch].level != 1) continue;
        const Placed& placed = placed_[patch];
        for (const dvec3& v : {dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0.3, 0.4, -2)}) {
            const auto along = [&](const dvec3& p) {
                return glm::dot(v, p - placed.corners[0]) / placed.size();
            };
            const double middle = along(placed.centre());
            double expected = 9 * middle * middle, found = 0;
            for (const dvec3& corner : placed.corners) expected += along(corner) * along(corner);
            for (const gpu::Surfel& surfel : of(patch, all))
                found += double(surfel.position.w) / placed.area * along(dvec3(surfel.position)) *
                         along(dvec3(surfel.position));
            EXPECT_NEAR(found, expected / 12, 1e-5);
        }
    }
}

TEST_P(SurfelPointsTest, BaseColourIsTheMaterialsTimesTheColourThere) {
    // Vertex colours are linear.
    const Scene scene = sceneOf(lambert(), false);
    place(scene);
    for (const Surfelizer by : {Surfelizer::Tessellator, Surfelizer::Compute}) {
        const std::vector<gpu::Surfel> all = surfels(by);
        for (size_t patch = 0; patch < placed_.size(); ++patch) {
            Placed triangle = placed_[patch];
            std::copy(std::begin(triangle.triangle), std::end(triangle.triangle),
                      std::begin(triangle.corners));
            const Mesh& mesh = scene.meshes[0];
            for (const gpu::Surfel& surfel : of(patch, all)) {
                const dvec3 weights = triangle.weights(dvec3(surfel.position));
                dvec3 expected(0);
                for (size_t i = 0; i < 3; ++i)
                    expected +=
                        weights[int(i)] *
                        dvec3(mesh.colors[mesh.indices[3 * plan_.patches[patch].triangle + i]]);
                expected *= dvec3(0.8, 0.6, 0.4);
                EXPECT_LT(glm::distance(dvec3(surfel.base), expected), 1e-4);
            }
        }
    }
    // Who is drawn without light reflects none.
    Material unlit = lambert();
    unlit.unlit = true;
    place(sceneOf(unlit, false));
    for (const gpu::Surfel& surfel : surfels(Surfelizer::Tessellator))
        EXPECT_EQ(surfel.surface.y, 0);
}

TEST_P(SurfelPointsTest, HolesHaveNoArea) {
    // Half of the surface is cut out: alpha falls from 1 to 0 from the first corner to the others.
    Material mask = lambert();
    mask.alphaMode = AlphaMode::Mask;
    mask.alphaCutoff = 0.5f;
    Scene scene = sceneOf(mask, false);
    for (size_t i = 0; i < 4; ++i) scene.meshes[0].colors[i].a = i == 0 || i == 3 ? 1 : 0;
    place(scene);
    for (const Surfelizer by : {Surfelizer::Tessellator, Surfelizer::Compute}) {
        const std::vector<gpu::Surfel> all = surfels(by);
        size_t holes = 0;
        for (size_t patch = 0; patch < placed_.size(); ++patch) {
            Placed triangle = placed_[patch];
            std::copy(std::begin(triangle.triangle), std::end(triangle.triangle),
                      std::begin(triangle.corners));
            const bool second = plan_.patches[patch].triangle == 1; // of the vertices 2, 1, 3
            for (const gpu::Surfel& surfel : of(patch, all)) {
                const double alpha = triangle.weights(dvec3(surfel.position))[second ? 2 : 0];
                if (std::abs(alpha - 0.5) < 1e-3) continue; // where rounding decides
                EXPECT_EQ(surfel.position.w > 0, alpha > 0.5) << alpha;
                holes += alpha < 0.5;
            }
        }
        EXPECT_GT(holes, 100u);
    }
}

} // namespace
} // namespace tyndall::test
