#include "validation/scenes.h"

#include <cmath>

#include "tracing/sampler.h"
#include "scene/primitives.h"

namespace tyndall::validation {
namespace {

constexpr double kWide = 2e5; // metres: so wide that no light finds the side of a slab
constexpr double kWideWall = 2e6;

} // namespace

Medium matter(MediumKind kind, double albedo, double anisotropy) {
    Medium medium;
    medium.kind = kind;
    medium.scattering = vec3(float(albedo));
    medium.absorption = vec3(1.0f - float(albedo));
    medium.anisotropy = float(anisotropy);
    return medium;
}

int SceneMaker::addNode(const dmat4& worldFromNode) {
    Node node;
    node.name = "node " + std::to_string(scene_.nodes.size());
    node.matrix = worldFromNode;
    scene_.nodes.push_back(node);
    return int(scene_.nodes.size()) - 1;
}

void SceneMaker::addMedium(const Medium& medium, const dmat4& worldFromNode) {
    const int node = addNode(worldFromNode);
    scene_.nodes[size_t(node)].medium = int(scene_.media.size());
    scene_.media.push_back(medium);
}

void SceneMaker::addMedium(const Medium& medium, const dvec3& at) {
    dmat4 place(1.0);
    place[3] = dvec4(at, 1);
    addMedium(medium, place);
}

void SceneMaker::addPrimitive(PrimitiveShape shape, const dvec3& size, const Material& material,
                              const dmat4& worldFromNode) {
    const int node = addNode(worldFromNode);
    Mesh mesh = makePrimitive({shape, size});
    mesh.material = int(scene_.materials.size());
    scene_.materials.push_back(material);
    scene_.nodes[size_t(node)].meshes.push_back(int(scene_.meshes.size()));
    scene_.meshes.push_back(std::move(mesh));
}

void SceneMaker::addBlackPlane(double height) {
    Material black;
    black.baseColor = vec4(0, 0, 0, 1);
    black.metallic = 0;
    black.doubleSided = true;
    black.unlit = true;
    dmat4 place(1.0);
    place[3].y = height;
    addPrimitive(PrimitiveShape::Plane, {kWideWall, 1, kWideWall}, black, place);
}

void SceneMaker::addLight(const Light& light, const dmat4& worldFromNode) {
    const int node = addNode(worldFromNode);
    scene_.nodes[size_t(node)].light = int(scene_.lights.size());
    scene_.lights.push_back(light);
}

void SceneMaker::addPointLight(const dvec3& at, double candela, double radius) {
    Light light;
    light.intensity = float(candela);
    light.radius = float(radius);
    addLight(light, lookAlong({0, 0, -1}, at));
}

void SceneMaker::addSun(const dvec3& direction, double lux) {
    Light light;
    light.type = LightType::Directional;
    light.intensity = float(lux);
    addLight(light, lookAlong(direction));
}

int SceneMaker::addCamera(const dvec3& from, const dvec3& to, double yfov) {
    const int node = addNode(lookAlong(to - from, from));
    Camera camera;
    camera.yfov = yfov;
    camera.znear = 0.01;
    scene_.nodes[size_t(node)].camera = int(scene_.cameras.size());
    scene_.cameras.push_back(camera);
    return node;
}

Material matt(const vec3& colour) {
    Material material;
    material.baseColor = vec4(colour, 1);
    material.metallic = 0;
    material.specular = 0;
    material.doubleSided = true;
    return material;
}

void addSlab(SceneMaker& maker, double albedo, double anisotropy, double tau) {
    Medium slab = matter(MediumKind::Box, albedo, anisotropy);
    slab.size = {kWide, tau, kWide};
    maker.addMedium(slab, dvec3(0, -0.5 * tau, 0));
}

dmat4 lookAlong(const dvec3& direction, const dvec3& at) {
    const tracing::Frame frame(-glm::normalize(direction));
    return {dvec4(frame.x, 0), dvec4(frame.y, 0), dvec4(frame.z, 0), dvec4(at, 1)};
}

std::shared_ptr<const BrickGrid> lumpyGrid(double extent, double densest, uint64_t seed) {
    constexpr int kVoxels = 20;
    const double spacing = extent / (kVoxels - 1);
    std::vector<float> voxels;
    for (uint64_t i = 0; i < uint64_t(kVoxels * kVoxels * kVoxels); ++i) {
        const double u = double(tracing::mixBits(seed * 1000003 + i) >> 11) * 0x1p-53;
        // Much thin matter, some of it empty, and little that is dense.
        voxels.push_back(float(densest * (u < 0.2 ? 0 : u * u * u)));
    }
    dmat4 worldFromIndex(spacing);
    worldFromIndex[3] = dvec4(dvec3(-0.5 * extent), 1);
    return std::make_shared<BrickGrid>(
        makeBrickGrid(voxels, ivec3(0), ivec3(kVoxels), worldFromIndex));
}

void addLampOverABlock(SceneMaker& maker, bool fog) {
    if (fog) {
        Medium medium;
        medium.kind = MediumKind::Sphere;
        medium.size = dvec3(3);
        medium.scattering = {1.2f, 1.0f, 0.8f};
        medium.absorption = {0.1f, 0.1f, 0.1f};
        maker.addMedium(medium);
    }
    maker.addPrimitive(PrimitiveShape::Box, {1, 0.2, 1}, matt({0.7f, 0.6f, 0.5f}));
    maker.addPointLight({0.5, 1.1, 0.4}, 10, 0.2);
}

} // namespace tyndall::validation
