#include "volumetric_gi/shared/traced_scene.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "plugin/cache_key.h"
#include "plugin/cached_upload.h"
#include "tracing/proxy_media.h"
#include "volumetric_gi/shared/scene_bounds.h"

namespace tyndall::volumetric_gi {
namespace {

static_assert(sizeof(gpu::TracedTreeNode) == sizeof(tracing::TreeNode));
static_assert(offsetof(gpu::TracedTreeNode, next) == offsetof(tracing::TreeNode, next));
static_assert(offsetof(gpu::TracedTreeNode, triangle) == offsetof(tracing::TreeNode, triangle));
static_assert(gpu::kNoTriangle == tracing::TreeNode::kInner);

/// Of surfaces, and of lights except glowing media. Versions show that nodes have moved, not which.
struct Keys {
    uint64_t shapes; // surfaces, wherever they are
    uint64_t surfaces, lights;
};

Keys keysOf(const Scene& scene, const dvec3& origin) {
    const SceneVersions& now = scene.versions;
    Keys keys{};
    keys.shapes = cacheKey(now.structure, now.meshes, now.materials, now.textures);
    keys.surfaces = cacheKey(keys.shapes, origin);
    keys.lights = cacheKey(now.lights, now.environment, origin);
    const std::vector<dmat4> world = scene.worldTransforms();
    const std::vector<bool> visible = scene.worldVisibility();
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        if (!node.meshes.empty()) {
            keys.surfaces = cacheKey(keys.surfaces, world[i], visible[i]);
            for (const dmat4& instance : node.instances)
                keys.surfaces = cacheKey(keys.surfaces, instance);
        }
        if (node.light != kNone) keys.lights = cacheKey(keys.lights, world[i], visible[i]);
    }
    return keys;
}

/// Rounded outwards to eighths of a power of two, so that small movements do not change it.
Bounds roughly(const Bounds& bounds) {
    if (bounds.empty()) return bounds;
    const dvec3 extent = bounds.extent();
    const double cell =
        std::exp2(std::ceil(std::log2(std::max({extent.x, extent.y, extent.z}))) - 3);
    if (!(cell > 0) || !std::isfinite(cell)) return bounds;
    return {cell * glm::floor(bounds.minimum / cell), cell * glm::ceil(bounds.maximum / cell)};
}

} // namespace

gpu::TracedTriangle packTriangle(const tracing::SceneTriangle& from) {
    gpu::TracedTriangle triangle{};
    const dvec3 &corner = from.corners[0], a = from.corners[1] - corner,
                b = from.corners[2] - corner;
    triangle.corner = vec4(vec3(corner), from.opaque() ? 1 : 0);
    const dvec3 across = glm::cross(a, b);
    const double twiceArea = glm::length(across);
    if (!(twiceArea > 0)) return triangle;
    const dvec3 normal = across / twiceArea;
    triangle.plane = vec4(vec3(normal), float(-glm::dot(normal, corner)));
    triangle.second = vec3(glm::cross(b, normal) / twiceArea);
    triangle.third = vec3(glm::cross(normal, a) / twiceArea);
    triangle.coversLow = uint32_t(from.covers);
    triangle.coversHigh = uint32_t(from.covers >> 32);
    return triangle;
}

Result<void> TracedScene::updateSurfaces(const Scene& scene, const dvec3& origin) {
    scene_.surfaces.reset();
    auto built = tracing::SurfaceScene::build(scene, origin, 0);
    if (!built.ok()) return built.error();
    scene_.surfaces = std::move(*built);
    const std::vector<tracing::SceneTriangle> triangles = scene_.surfaces->triangles();
    auto tree = tracing::buildTriangleTree(triangles);
    if (!tree.ok()) return tree.error();
    tree_ = std::move(*tree);
    hasHoles_ = std::any_of(triangles.begin(), triangles.end(),
                            [](const auto& triangle) { return !triangle.opaque(); });
    triangles_.resize(triangles.size());
    std::transform(triangles.begin(), triangles.end(), triangles_.begin(), packTriangle);
    return {};
}

/// The same surfaces as before, some of them moved.
bool TracedScene::moveSurfaces(const Scene& scene, const dvec3& origin) {
    std::vector<uint32_t> moved;
    tracing::SurfaceScene& surfaces = *scene_.surfaces;
    if (!surfaces.move(scene, origin, moved)) return false;
    for (const uint32_t number : moved) {
        const tracing::MeshInstance& instance = surfaces.instances()[number];
        for (uint32_t i = 0; i < instance.mesh->indices.size() / 3; ++i) {
            gpu::TracedTriangle& triangle = triangles_[instance.firstTriangle + i];
            const uint64_t covers =
                (uint64_t(triangle.coversHigh) << 32) | uint64_t(triangle.coversLow);
            triangle = packTriangle({surfaces.corners(number, i), covers});
        }
    }
    if (!moved.empty())
        tracing::refitTriangleTree(tree_, [&](uint32_t triangle) {
            const uint32_t number = surfaces.instanceOf(triangle);
            return surfaces.corners(number, triangle - surfaces.instances()[number].firstTriangle);
        });
    return true;
}

void TracedScene::updateMedia(const Scene& scene, const dvec3& origin, bool off, bool useProxies) {
    scene_.lights.reset(); // keeps references to media
    std::unique_ptr<tracing::MediaField> proxies = std::move(usesProxies_ ? scene_.media : otherMedia_);
    auto actual = off ? std::make_unique<tracing::MediaField>()
                      : std::make_unique<tracing::MediaField>(scene, origin);
    if (useProxies) {
        tracing::ProxyMedia made = tracing::makeProxyMedia(scene, origin);
        // Kept paths point to their media, which therefore stay while nothing about them changes.
        if (!proxies || made.hash != proxyHash_)
            proxies = std::make_unique<tracing::MediaField>(std::move(made.field));
        proxyHash_ = made.hash;
    }
    usesProxies_ = useProxies;
    scene_.media = std::move(useProxies ? proxies : actual);
    otherMedia_ = std::move(useProxies ? actual : proxies);
}

Result<void> TracedScene::update(const plugin::FrameInputs& inputs,
                                 const TracedSceneOptions& options) {
    const Scene& scene = *inputs.whole;
    const SceneVersions& now = scene.versions;
    const dvec3 origin(inputs.origin[0], inputs.origin[1], inputs.origin[2]);
    const Bounds content = roughly(boundsOf(inputs.scene.contentMinimum, inputs.scene.contentMaximum)),
                 surroundings = roughly(boundsOf(inputs.scene.boundsMinimum, inputs.scene.boundsMaximum));
    const bool useProxies = options.proxyMedia && !inputs.mediaOff;
    const uint64_t key =
        cacheKey(useProxies, inputs.mediaOff, content, surroundings, now.structure, now.transforms, now.meshes, now.materials,
                 now.textures, now.lights, now.media, now.environment, origin);
    if (whole_ == &scene && key == key_) return {};

    const Keys keys = keysOf(scene, origin);
    emission_.reset();
    if (whole_ != &scene || keys.surfaces != surfacesKey_) {
        scene_.lights.reset();
        const bool moved =
            whole_ == &scene && keys.shapes == shapesKey_ && moveSurfaces(scene, origin);
        if (!moved) {
            if (Result<void> built = updateSurfaces(scene, origin); !built.ok()) {
                whole_ = nullptr;
                return built;
            }
        }
    }
    updateMedia(scene, origin, inputs.mediaOff, useProxies);
    scene_.lights =
        std::make_unique<tracing::Lights>(scene, origin, *scene_.surfaces, *scene_.media);
    content_ = content;
    emission_ = std::make_unique<tracing::LightEmission>(scene_, content, surroundings);
    key_ = key;
    walksKey_ = usesProxies_ ? cacheKey(proxyHash_, keys.surfaces, keys.lights, content, surroundings) : key;
    whole_ = &scene;
    surfacesKey_ = keys.surfaces;
    shapesKey_ = keys.shapes;
    return {};
}

const TracedBuffers& TracedScene::buffers(fg::FrameGraph& graph) {
    if (buffers_.triangles) return buffers_;
    buffers_.triangles = addCachedUpload(graph, "gi.traced.triangles", triangles_, surfacesKey_);
    buffers_.tree = addCachedUpload(graph, "gi.traced.tree", tree_, surfacesKey_);
    buffers_.params.treeSize = uint32_t(tree_.size());
    return buffers_;
}

TracedBuffers readTraced(fg::Builder& builder, const TracedBuffers& buffers) {
    return {builder.read(buffers.triangles), builder.read(buffers.tree), buffers.params};
}

} // namespace tyndall::volumetric_gi
