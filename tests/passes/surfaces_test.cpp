// The G-buffer pass: what the textures hold at a pixel, against what glTF says the surface is.

#include <cmath>
#include <optional>

#include <glm/gtc/matrix_transform.hpp>

#include "framegraph/gl/executor.h"
#include "gl/gl_fixture.h"
#include "gl/shader_library.h"
#include "renderer/gbuffer_pass.h"
#include "renderer/view.h"

namespace tyndall::test {
namespace {

constexpr int kSize = 16;
constexpr double kNear = 0.1;

/// A quad of two metres in XY, facing +Z, u to the right, v downwards, tangent +X.
Mesh quad(float handedness = 1) {
    Mesh mesh;
    mesh.name = "quad";
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.normals.assign(4, vec3(0, 0, 1));
    mesh.tangents.assign(4, vec4(1, 0, 0, handedness));
    mesh.uvs[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    for (const vec3& p : mesh.positions) mesh.bounds.include(dvec3(p));
    mesh.version = nextVersion();
    return mesh;
}

/// One texture of one colour, or of 2×2 texels, nearest.
int addTexture(Scene& scene, std::vector<uint8_t> rgba) {
    ImageData image;
    image.width = image.height = rgba.size() == 4 ? 1 : 2;
    image.rgba = std::move(rgba);
    scene.images.push_back(image);
    Texture texture;
    texture.image = int(scene.images.size()) - 1;
    texture.sampler.magnify = texture.sampler.minify = Filter::Nearest;
    texture.sampler.mip = MipFilter::None;
    scene.textures.push_back(texture);
    return int(scene.textures.size()) - 1;
}

Scene sceneOf(Mesh mesh, const Material& material, const dmat4& transform = dmat4(1)) {
    Scene scene;
    mesh.material = 0;
    scene.materials.push_back(material);
    scene.meshes.push_back(std::move(mesh));
    Node node;
    node.meshes = {0};
    node.matrix = transform;
    scene.nodes.push_back(node);
    scene.versions.structure = scene.versions.transforms = scene.versions.meshes =
        scene.versions.materials = scene.versions.textures = nextVersion();
    return scene;
}

/// The texel under the middle of the picture, or elsewhere (from the top left).
struct Texel {
    double depth = 0;
    dvec3 normal{0}, geometricNormal{0}, base{0}, emissive{0};
    double metallic = 0, roughness = 0, specular = 0, occlusion = 0;
    uint32_t flags = 0;
};

dvec3 decodeOctahedral(double x, double y) {
    x = x * 65535.0 / 65534.0 * 2 - 1;
    y = y * 65535.0 / 65534.0 * 2 - 1;
    dvec3 n(x, y, 1 - std::abs(x) - std::abs(y));
    if (n.z < 0)
        n = {(1 - std::abs(y)) * (x >= 0 ? 1 : -1), (1 - std::abs(x)) * (y >= 0 ? 1 : -1), n.z};
    return glm::normalize(n);
}

class SurfacesTest : public GlTest {
protected:
    void SetUp() override {
        GlTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        library_.emplace();
        fg::ExecutorOptions options;
        options.poison = true;
        executor_.emplace(*library_, options);
        surfaces_.emplace(*executor_);
    }
    void TearDown() override {
        surfaces_.reset();
        executor_.reset();
        library_.reset();
        GlTest::TearDown();
    }

    /// Looks along -Z from (0, 0, 3) at a field of 90 degrees; `turned`: from the other side.
    void draw(const Scene& scene, bool turned = false, bool converge = false) {
        const Result<void> updated = surfaces_->update(scene, dvec3(0));
        ASSERT_TRUE(updated.ok()) << updated.message();
        Camera camera;
        camera.yfov = 0.5 * kPi;
        camera.znear = kNear;
        ViewRequest request;
        request.camera = &camera;
        request.worldFromCamera = glm::rotate(dmat4(1), turned ? kPi : 0.0, dvec3(0, 1, 0)) *
                                  glm::translate(dmat4(1), dvec3(0, 0, 3));
        request.width = request.height = kSize;
        request.converge = converge;
        fg::FrameGraph& graph = executor_->beginFrame();
        GBufferSettings settings{0, 1};
        const GBuffer gbuffer = addGBufferPass(graph, *surfaces_, makeView(request), settings);
        for (const fg::TextureHandle texture :
             {gbuffer.depth, gbuffer.normal, gbuffer.base, gbuffer.material, gbuffer.emissive})
            graph.markOutput(texture);
        const Result<void> executed = executor_->execute();
        ASSERT_TRUE(executed.ok()) << executed.message();
        depth_ = executor_->readImage(gbuffer.depth);
        normal_ = executor_->readImage(gbuffer.normal);
        base_ = executor_->readImage(gbuffer.base);
        material_ = executor_->readImage(gbuffer.material);
        emissive_ = executor_->readImage(gbuffer.emissive);
    }

    [[nodiscard]] Texel at(int x = kSize / 2, int y = kSize / 2) const {
        const auto value = [&](const Image& image, int c) { return double(image.at(x, y)[c]); };
        Texel texel;
        texel.depth = value(depth_, 0);
        texel.normal = decodeOctahedral(value(normal_, 0), value(normal_, 1));
        texel.geometricNormal = decodeOctahedral(value(normal_, 2), value(normal_, 3));
        texel.base = {value(base_, 0), value(base_, 1), value(base_, 2)};
        texel.metallic = value(base_, 3);
        texel.roughness = value(material_, 0);
        texel.specular = value(material_, 1);
        texel.occlusion = value(material_, 2);
        texel.flags = uint32_t(std::lround(value(material_, 3) * 65535));
        texel.emissive = {value(emissive_, 0), value(emissive_, 1), value(emissive_, 2)};
        return texel;
    }

    void expectNormal(const dvec3& expected, const dvec3& measured) {
        EXPECT_LT(glm::length(expected - measured), 1e-4)
            << measured.x << " " << measured.y << " " << measured.z;
    }

    std::optional<gl::ShaderLibrary> library_;
    std::optional<fg::Executor> executor_;
    std::optional<GpuScene> surfaces_;
    Image depth_, normal_, base_, material_, emissive_;
};
TYNDALL_GL_TESTS(SurfacesTest);

const dmat4 kMirror = glm::scale(dmat4(1), dvec3(-1, 1, 1));

TEST_P(SurfacesTest, HoldsTheMaterialToSixteenBits) {
    Material material;
    material.baseColor = vec4(0.2f, 0.5f, 0.8f, 1);
    material.metallic = 0.3f;
    material.roughness = 0.6f;
    material.specular = 0.7f;
    material.emissive = vec3(123456.0f, 0.001f, 3);
    draw(sceneOf(quad(), material));
    const Texel texel = at();
    EXPECT_NEAR(texel.depth, kNear / 3.0, 1e-8);
    expectNormal({0, 0, 1}, texel.normal);
    expectNormal({0, 0, 1}, texel.geometricNormal);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(texel.base[c], double(material.baseColor[c]), 1e-5);
    EXPECT_NEAR(texel.metallic, 0.3, 1e-5);
    EXPECT_NEAR(texel.roughness, 0.6, 1e-5);
    EXPECT_NEAR(texel.specular, 0.7, 1e-5);
    EXPECT_NEAR(texel.occlusion, 1.0, 1e-5);
    for (int c = 0; c < 3; ++c) EXPECT_FLOAT_EQ(float(texel.emissive[c]), material.emissive[c]);
    EXPECT_EQ(texel.flags, 0u);
    EXPECT_EQ(at(0, 0).depth, 0.0); // beside the quad
}

TEST_P(SurfacesTest, OneSidedSurfacesAreInvisibleFromBehindMirroredOrNot) {
    for (const bool mirrored : {false, true})
        for (const bool turned : {false, true}) {
            draw(sceneOf(quad(), Material{}, mirrored ? kMirror : dmat4(1)), turned);
            EXPECT_EQ(at().depth > 0, !turned) << "mirrored " << mirrored << ", turned " << turned;
        }
}

TEST_P(SurfacesTest, DoubleSidedSurfacesTurnTheirNormalsToTheEye) {
    Material material;
    material.doubleSided = true;
    for (const bool mirrored : {false, true})
        for (const bool turned : {false, true}) {
            draw(sceneOf(quad(), material, mirrored ? kMirror : dmat4(1)), turned);
            EXPECT_GT(at().depth, 0.0);
            expectNormal({0, 0, turned ? -1 : 1}, at().normal);
            expectNormal({0, 0, turned ? -1 : 1}, at().geometricNormal);
        }
}

TEST_P(SurfacesTest, NormalMapsFollowHandednessMirrorsAndScale) {
    // Texel (x, y, z) in the frame (tangent, bitangent = handedness · normal × tangent, normal).
    const dvec3 stored = dvec3(200, 218, 190) / 255.0 * 2.0 - 1.0;
    for (const float handedness : {1.0f, -1.0f})
        for (const bool mirrored : {false, true})
            for (const float scale : {1.0f, 0.5f}) {
                SCOPED_TRACE(::testing::Message() << "handedness " << handedness << ", mirrored "
                                                  << mirrored << ", scale " << scale);
                Scene scene = sceneOf(quad(handedness), Material{}, mirrored ? kMirror : dmat4(1));
                scene.materials[0].normalScale = scale;
                scene.materials[0].normalTexture.texture = addTexture(scene, {200, 218, 190, 255});
                draw(scene);
                // Mirrored in x: the tangent turns round, the bitangent stays where the mesh has it.
                const double x = stored.x * double(scale) * (mirrored ? -1 : 1),
                             y = stored.y * double(scale) * double(handedness);
                expectNormal(glm::normalize(dvec3(x, y, stored.z)), at().normal);
                expectNormal({0, 0, 1}, at().geometricNormal);
            }
}

TEST_P(SurfacesTest, NormalsOfScaledObjectsStayPerpendicular) {
    // A quad turned about Y by atan(1/2) in local space, then flattened along z: the transform of normals is the inverse transpose.
    Mesh mesh = quad();
    for (vec3& p : mesh.positions) p.z = 0.5f * p.x;
    mesh.normals.assign(4, glm::normalize(vec3(-0.5f, 0, 1)));
    mesh.bounds = {};
    for (const vec3& p : mesh.positions) mesh.bounds.include(dvec3(p));
    draw(sceneOf(mesh, Material{}, glm::scale(dmat4(1), dvec3(1, 1, 0.5))));
    expectNormal(glm::normalize(dvec3(-0.25, 0, 1)), at().normal);
    expectNormal(glm::normalize(dvec3(-0.25, 0, 1)), at().geometricNormal);
}

TEST_P(SurfacesTest, TexturesAreReadInTheirColourSpaces) {
    Scene scene = sceneOf(quad(), Material{});
    const int texture = addTexture(scene, {188, 64, 128, 255});
    Material& material = scene.materials[0];
    material.emissive = vec3(10);
    material.baseColorTexture.texture = material.emissiveTexture.texture = texture;
    material.metallicRoughnessTexture.texture = material.occlusionTexture.texture =
        texture; // the same image, linear
    material.occlusionStrength = 0.5f;
    draw(scene);
    const auto linear = [](double v) {
        return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    };
    const dvec3 expected(linear(188 / 255.0), linear(64 / 255.0), linear(128 / 255.0));
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(at().base[c], expected[c], 1e-3);
        EXPECT_NEAR(at().emissive[c], 10 * expected[c], 1e-2);
    }
    EXPECT_NEAR(at().roughness, 64 / 255.0, 1e-4);
    EXPECT_NEAR(at().metallic, 128 / 255.0, 1e-4);
    EXPECT_NEAR(at().occlusion, 1 + 0.5 * (188 / 255.0 - 1), 1e-4);
}

TEST_P(SurfacesTest, TextureRowsRunFromTheTopAndTransformsTurnThem) {
    // Red, green in the upper row; blue, white in the lower one.
    const std::vector<uint8_t> rgba = {255, 0, 0,   255, 0,   255, 0,   255,
                                       0,   0, 255, 255, 255, 255, 255, 255};
    Scene scene = sceneOf(quad(), Material{});
    scene.materials[0].baseColorTexture.texture = addTexture(scene, rgba);
    draw(scene);
    const dvec3 red(1, 0, 0), green(0, 1, 0), blue(0, 0, 1);
    EXPECT_EQ(at(6, 6).base, red); // upper left of the middle
    EXPECT_EQ(at(9, 6).base, green);
    EXPECT_EQ(at(6, 9).base, blue);
    // The first example of KHR_texture_transform: the lower left quadrant alone, turned.
    scene.materials[0].baseColorTexture.offset = vec2(0, 1);
    scene.materials[0].baseColorTexture.rotation = float(0.5 * kPi);
    scene.materials[0].baseColorTexture.scale = vec2(0.5f);
    scene.versions.materials = nextVersion();
    draw(scene);
    for (const int x : {6, 9})
        for (const int y : {6, 9}) EXPECT_EQ(at(x, y).base, blue) << x << ", " << y;
    // From another UV set.
    scene.materials[0].baseColorTexture =
        TextureRef{scene.materials[0].baseColorTexture.texture, 3};
    scene.meshes[0].uvs[3].assign(4, vec2(0.75f, 0.25f));
    scene.meshes[0].version = nextVersion();
    scene.versions.materials = scene.versions.meshes = nextVersion();
    draw(scene);
    EXPECT_EQ(at(6, 9).base, green);
}

/// The quad in `cells`² squares of two triangles each.
Mesh fineQuad(uint32_t cells) {
    Mesh mesh = quad();
    const std::vector<vec3> corners = mesh.positions;
    mesh.positions.clear();
    mesh.uvs[0].clear();
    mesh.indices.clear();
    for (uint32_t j = 0; j <= cells; ++j)
        for (uint32_t i = 0; i <= cells; ++i) {
            const vec2 at(float(i) / float(cells), float(j) / float(cells));
            mesh.positions.push_back({2 * at.x - 1, 2 * at.y - 1, 0});
            mesh.uvs[0].push_back({at.x, 1 - at.y});
        }
    mesh.normals.assign(mesh.positions.size(), vec3(0, 0, 1));
    mesh.tangents.assign(mesh.positions.size(), vec4(1, 0, 0, 1));
    const uint32_t row = cells + 1;
    for (uint32_t j = 0; j < cells; ++j)
        for (uint32_t i = 0; i < cells; ++i) {
            const uint32_t k = j * row + i;
            mesh.indices.insert(mesh.indices.end(),
                                {k, k + 1, k + row + 1, k, k + row + 1, k + row});
        }
    return mesh;
}

TEST_P(SurfacesTest, TexturesAreAsSharpOnTrianglesSmallerThanPixels) {
    constexpr int kSide = 64;
    // Red on the left and green on the right; the coarsest levels have the mean of both.
    std::vector<uint8_t> rgba;
    for (int i = 0; i < kSide * kSide; ++i) {
        const bool left = i % kSide < kSide / 2;
        rgba.insert(rgba.end(), {uint8_t(left ? 255 : 0), uint8_t(left ? 0 : 255), 0, 255});
    }
    for (const uint32_t cells : {1u, 24u}) {
        // Nine tenths of the picture's width of six metres are a scale of 2.7.
        Scene scene =
            sceneOf(fineQuad(cells), Material{}, glm::scale(dmat4(1), dvec3(2.7, 2.7, 1)));
        const int texture = addTexture(scene, {0, 0, 0, 0});
        scene.images[0].width = scene.images[0].height = kSide;
        scene.images[0].rgba = rgba;
        scene.textures[size_t(texture)].sampler = {};
        scene.textures[size_t(texture)].sampler.wrapU = Wrap::ClampToEdge;
        scene.materials[0].baseColorTexture.texture = texture;
        draw(scene);
        // 4.4 texels a pixel: level 2.2, whose texels are at most two pixels wide.
        for (int y = 1; y < kSize - 1; ++y)
            for (int x = 1; x < kSize - 1; ++x) {
                if (std::abs(x + 0.5 - kSize / 2) < 3) continue;
                const dvec3 expected = x < kSize / 2 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
                ASSERT_LT(glm::length(at(x, y).base - expected), 1e-3)
                    << cells << " cells, pixel " << x << " " << y;
            }
    }
}

TEST_P(SurfacesTest, MaskedSurfacesHaveHolesWhereAlphaIsLow) {
    Scene scene = sceneOf(quad(), Material{});
    scene.materials[0].alphaMode = AlphaMode::Mask;
    scene.materials[0].baseColorTexture.texture = addTexture(
        scene, {255, 255, 255, 255, 255, 255, 255, 100, 255, 255, 255, 130, 255, 255, 255, 127});
    for (const bool converge : {false, true}) {
        draw(scene, false, converge);
        EXPECT_GT(at(6, 6).depth, 0.0);
        EXPECT_EQ(at(9, 6).depth, 0.0);
        EXPECT_GT(at(6, 9).depth, 0.0); // 130 of 255 is above a half
        EXPECT_EQ(at(9, 9).depth, 0.0); // 127 is not
    }
}

TEST_P(SurfacesTest, VertexColoursMultiplyAndUnlitSurfacesShowTheirColour) {
    Mesh mesh = quad();
    mesh.colors.assign(4, vec4(0.5f, 1, 0.25f, 1));
    Material material;
    material.baseColor = vec4(0.8f, 0.8f, 0.8f, 1);
    draw(sceneOf(mesh, material));
    EXPECT_NEAR(at().base.x, 0.4, 1e-5);
    EXPECT_NEAR(at().base.z, 0.2, 1e-5);
    material.unlit = true;
    material.emissive = vec3(7); // unlit materials have none
    draw(sceneOf(mesh, material));
    EXPECT_EQ(at().base, dvec3(0));
    EXPECT_EQ(at().flags, 1u);
    EXPECT_NEAR(at().emissive.x, 0.4, 1e-6);
    EXPECT_NEAR(at().emissive.z, 0.2, 1e-6);
}

TEST_P(SurfacesTest, InstancesAreDrawnEachInItsPlace) {
    Scene scene = sceneOf(quad(), Material{}, glm::scale(dmat4(1), dvec3(0.25)));
    // Mirrored and plain ones, in different runs; one far outside of the view.
    scene.nodes[0].instances = {glm::translate(dmat4(1), dvec3(-4, 4, 0)),
                                glm::translate(dmat4(1), dvec3(4, -4, 0)) * kMirror,
                                glm::translate(dmat4(1), dvec3(4, 4, 0)),
                                glm::translate(dmat4(1), dvec3(4000, 0, 0))};
    draw(scene);
    // A metre is a third of the half picture: centres at 8 ± 8/3 pixels.
    EXPECT_GT(at(5, 5).depth, 0.0);
    EXPECT_GT(at(10, 10).depth, 0.0);
    EXPECT_GT(at(10, 5).depth, 0.0);
    EXPECT_EQ(at(5, 10).depth, 0.0);
    ASSERT_EQ(surfaces_->items().size(), 4u);
    expectNormal({0, 0, 1}, at(10, 10).normal);
}

TEST_P(SurfacesTest, LinesAndPointsWithoutNormalsAreUnlit) {
    for (const MeshTopology topology : {MeshTopology::Lines, MeshTopology::Points}) {
        Mesh mesh;
        mesh.topology = topology;
        mesh.positions = {{-1.3f, 0.1f, 0}, {1.3f, 0.1f, 0}};
        mesh.indices = {0, 1};
        for (const vec3& p : mesh.positions) mesh.bounds.include(dvec3(p));
        mesh.version = nextVersion();
        Material material;
        material.baseColor = vec4(0.25f, 0.5f, 1, 1);
        draw(sceneOf(mesh, material));
        int drawn = 0;
        for (int y = 0; y < kSize; ++y)
            for (int x = 0; x < kSize; ++x)
                if (at(x, y).depth > 0) {
                    ++drawn;
                    EXPECT_EQ(at(x, y).flags, 1u);
                    EXPECT_NEAR(at(x, y).emissive.x, 0.25, 1e-6);
                }
        // Two points, or a line of 2.6 of the picture's six metres.
        if (topology == MeshTopology::Points)
            EXPECT_EQ(drawn, 2);
        else
            EXPECT_NEAR(drawn, 7, 1);
    }
}

TEST_P(SurfacesTest, OnlyWhatChangedIsUploadedAgain) {
    Scene scene = sceneOf(quad(), Material{});
    draw(scene);
    const Version first = surfaces_->version();
    const uint32_t geometry = surfaces_->items()[0].geometry.id;
    draw(scene);
    EXPECT_EQ(surfaces_->version(), first);
    scene.nodes[0].matrix = glm::translate(dmat4(1), dvec3(0, 0, 1));
    scene.versions.transforms = nextVersion();
    draw(scene);
    EXPECT_NE(surfaces_->version(), first);
    EXPECT_EQ(surfaces_->items()[0].geometry.id, geometry); // moved, not uploaded
    EXPECT_NEAR(at().depth, kNear / 2.0, 1e-8);
    scene.meshes[0].positions[0].z = 0.001f;
    scene.meshes[0].version = scene.versions.meshes = nextVersion();
    draw(scene);
    EXPECT_NE(surfaces_->items()[0].geometry.id, geometry);
}

} // namespace
} // namespace tyndall::test
