#include "volumetric_gi/vpl/traced_scene.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>

#include "framegraph/hash.h"
#include "tracing/proxy_media.h"

namespace tyndall::volumetric_gi {
namespace {

static_assert(sizeof(gpu::VplTreeNode) == sizeof(tracing::TreeNode));
static_assert(offsetof(gpu::VplTreeNode, next) == offsetof(tracing::TreeNode, next));
static_assert(offsetof(gpu::VplTreeNode, triangle) == offsetof(tracing::TreeNode, triangle));
static_assert(gpu::kVplNothing == tracing::TreeNode::kInner);

/// Of surfaces, and of lights but for glowing media. Versions tell that nodes have moved, not which.
struct Keys {
    uint64_t shapes = fg::kHashStart; // surfaces, wherever they are
    uint64_t surfaces = fg::kHashStart, lights = fg::kHashStart;
};

uint64_t mixMatrix(uint64_t key, const dmat4& m) {
    for (int i = 0; i < 16; ++i) key = fg::mixHash(key, std::bit_cast<uint64_t>(m[i / 4][i % 4]));
    return key;
}

Keys keysOf(const Scene& scene, const dvec3& origin) {
    Keys keys;
    const SceneVersions& now = scene.versions;
    for (const uint64_t version : {now.structure, now.meshes, now.materials, now.textures})
        keys.shapes = fg::mixHash(keys.shapes, version);
    keys.surfaces = keys.shapes;
    for (const uint64_t version : {now.lights, now.environment})
        keys.lights = fg::mixHash(keys.lights, version);
    for (int axis = 0; axis < 3; ++axis) {
        const auto bits = std::bit_cast<uint64_t>(origin[axis]);
        keys.surfaces = fg::mixHash(keys.surfaces, bits);
        keys.lights = fg::mixHash(keys.lights, bits);
    }
    const std::vector<dmat4> world = scene.worldTransforms();
    const std::vector<bool> visible = scene.worldVisibility();
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        if (!node.meshes.empty()) {
            keys.surfaces = fg::mixHash(mixMatrix(keys.surfaces, world[i]), visible[i]);
            for (const dmat4& instance : node.instances)
                keys.surfaces = mixMatrix(keys.surfaces, instance);
        }
        if (node.light != kNone)
            keys.lights = fg::mixHash(mixMatrix(keys.lights, world[i]), visible[i]);
    }
    return keys;
}

/// Outwards to eighths of a power of two: what moves a little leaves it as it is.
Bounds roughly(const Bounds& bounds) {
    if (bounds.empty()) return bounds;
    const dvec3 extent = bounds.extent();
    const double cell =
        std::exp2(std::ceil(std::log2(std::max({extent.x, extent.y, extent.z}))) - 3);
    if (!(cell > 0) || !std::isfinite(cell)) return bounds;
    return {cell * glm::floor(bounds.minimum / cell), cell * glm::ceil(bounds.maximum / cell)};
}

} // namespace

gpu::VplTriangle packTriangle(const tracing::SceneTriangle& from) {
    gpu::VplTriangle triangle{};
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

/// Surfaces that are what they were, but not all where they were.
bool TracedScene::moveSurfaces(const Scene& scene, const dvec3& origin) {
    std::vector<uint32_t> moved;
    tracing::SurfaceScene& surfaces = *scene_.surfaces;
    if (!surfaces.move(scene, origin, moved)) return false;
    for (const uint32_t number : moved) {
        const tracing::MeshInstance& instance = surfaces.instances()[number];
        for (uint32_t i = 0; i < instance.mesh->indices.size() / 3; ++i) {
            gpu::VplTriangle& triangle = triangles_[instance.firstTriangle + i];
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

void TracedScene::updateMedia(const Scene& scene, const dvec3& origin, bool guessed) {
    scene_.lights.reset(); // keeps references to media
    if (!guessed) {
        scene_.media = std::make_unique<tracing::MediaField>(scene, origin);
        media_.reset();
        return;
    }
    tracing::ProxyMedia guess = tracing::makeProxyMedia(scene, origin);
    // Walks that are kept name the media that they went through: these stay while nothing about them changes.
    if (!media_ || guess.hash != guessHash_)
        scene_.media = std::make_unique<tracing::MediaField>(std::move(guess.field));
    guessHash_ = guess.hash;
    media_ = std::make_unique<tracing::MediaField>(scene, origin);
}

Result<void> TracedScene::update(const plugin::FrameInputs& inputs, bool guessed) {
    const Scene& scene = *inputs.whole;
    const SceneVersions& now = scene.versions;
    const dvec3 origin(inputs.origin[0], inputs.origin[1], inputs.origin[2]);
    uint64_t changes = fg::mixHash(fg::kHashStart, guessed);
    for (const uint64_t version : {now.structure, now.transforms, now.meshes, now.materials,
                                   now.textures, now.lights, now.media, now.environment})
        changes = fg::mixHash(changes, version);
    for (const double coordinate : inputs.origin)
        changes = fg::mixHash(changes, std::bit_cast<uint64_t>(coordinate));
    if (whole_ == &scene && changes == changesKey_) return {};

    const Keys keys = keysOf(scene, origin);
    if (whole_ != &scene || keys.surfaces != surfacesKey_) {
        emission_.reset();
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
    emission_.reset();
    key_ = changes;
    updateMedia(scene, origin, guessed);
    scene_.lights =
        std::make_unique<tracing::Lights>(scene, origin, *scene_.surfaces, *scene_.media);
    Bounds content = scene.contentBounds();
    if (!content.empty()) {
        content.minimum -= origin;
        content.maximum -= origin;
    }
    content = roughly(content);
    content_ = content;
    emission_ = std::make_unique<tracing::LightEmission>(scene_, content);
    walksKey_ = key_;
    if (guessed) {
        walksKey_ = fg::mixHash(fg::mixHash(guessHash_, keys.surfaces), keys.lights);
        for (const dvec3& end : {content.minimum, content.maximum})
            for (int axis = 0; axis < 3; ++axis)
                walksKey_ = fg::mixHash(walksKey_, std::bit_cast<uint64_t>(end[axis]));
    }
    whole_ = &scene;
    changesKey_ = changes;
    surfacesKey_ = keys.surfaces;
    shapesKey_ = keys.shapes;
    return {};
}

} // namespace tyndall::volumetric_gi
