#include "volumetric_gi/vpl/traced_scene.h"

#include <algorithm>
#include <bit>
#include <cstddef>

#include "framegraph/hash.h"

namespace tyndall::volumetric_gi {
namespace {

static_assert(sizeof(gpu::VplTreeNode) == sizeof(reference::TreeNode));
static_assert(offsetof(gpu::VplTreeNode, next) == offsetof(reference::TreeNode, next));
static_assert(offsetof(gpu::VplTreeNode, triangle) == offsetof(reference::TreeNode, triangle));
static_assert(gpu::kVplNothing == reference::TreeNode::kInner);

gpu::VplTriangle pack(const reference::SceneTriangle& from) {
    gpu::VplTriangle triangle{};
    const dvec3 &corner = from.corners[0], a = from.corners[1] - corner,
                b = from.corners[2] - corner;
    triangle.corner = vec4(vec3(corner), from.opaque ? 1 : 0);
    const dvec3 across = glm::cross(a, b);
    const double twiceArea = glm::length(across);
    if (!(twiceArea > 0)) return triangle;
    const dvec3 normal = across / twiceArea;
    triangle.plane = vec4(vec3(normal), float(-glm::dot(normal, corner)));
    triangle.second = vec4(vec3(glm::cross(b, normal) / twiceArea), 0);
    triangle.third = vec4(vec3(glm::cross(normal, a) / twiceArea), 0);
    return triangle;
}

} // namespace

Result<void> TracedScene::updateSurfaces(const Scene& scene, const dvec3& origin) {
    scene_.surfaces.reset();
    auto built = reference::SurfaceScene::build(scene, origin, 0);
    if (!built.ok()) return built.error();
    scene_.surfaces = std::move(*built);
    const std::vector<reference::SceneTriangle> triangles = scene_.surfaces->triangles();
    auto tree = reference::buildTriangleTree(triangles);
    if (!tree.ok()) return tree.error();
    tree_ = std::move(*tree);
    triangles_.resize(triangles.size());
    std::transform(triangles.begin(), triangles.end(), triangles_.begin(), pack);
    return {};
}

Result<void> TracedScene::update(const plugin::FrameInputs& inputs) {
    const Scene& scene = *inputs.whole;
    const SceneVersions& now = scene.versions;
    const dvec3 origin(inputs.origin[0], inputs.origin[1], inputs.origin[2]);
    uint64_t surfaces = fg::kHashStart;
    for (const uint64_t version :
         {now.structure, now.transforms, now.meshes, now.materials, now.textures})
        surfaces = fg::mixHash(surfaces, version);
    for (const double coordinate : inputs.origin)
        surfaces = fg::mixHash(surfaces, std::bit_cast<uint64_t>(coordinate));
    uint64_t key = surfaces;
    for (const uint64_t version : {now.lights, now.media, now.environment})
        key = fg::mixHash(key, version);
    if (whole_ == &scene && key == key_) return {};

    emission_.reset();
    scene_.lights.reset();
    if (whole_ != &scene || surfaces != surfacesKey_) {
        if (Result<void> built = updateSurfaces(scene, origin); !built.ok()) {
            whole_ = nullptr;
            return built;
        }
    }
    scene_.media = std::make_unique<reference::MediaField>(scene, origin);
    scene_.lights =
        std::make_unique<reference::Lights>(scene, origin, *scene_.surfaces, *scene_.media);
    Bounds content = scene.contentBounds();
    if (!content.empty()) {
        content.minimum -= origin;
        content.maximum -= origin;
    }
    emission_ = std::make_unique<reference::LightEmission>(scene_, content);
    whole_ = &scene;
    key_ = key;
    surfacesKey_ = surfaces;
    return {};
}

} // namespace tyndall::volumetric_gi
