#pragma once
// The scene on the GPU: meshes, textures, materials and objects, and the list of what can be drawn. Only what changed since
// the last update is uploaded again, by version numbers. Transforms are computed in double precision and moved to render
// space (world minus render origin) before they become floats.

#include <cstdint>
#include <span>
#include <vector>

#include "core/result.h"
#include "framegraph/gl/executor.h"
#include "renderer/mesh_upload.h"
#include "renderer/texture_upload.h"
#include "scene/scene.h"
#include "shared/material.h"
#include "shared/object.h"

namespace tyndall {

/// One mesh of one node or instance. `object` indexes `Objects` and rises along the draw list.
struct DrawItem {
    fg::StaticGeometry geometry;
    uint32_t indexCount = 0;
    uint32_t object = 0;
    uint32_t material =
        0; // index into `Materials` and GpuScene::textures(); the last one is the default material
    fg::Topology topology = fg::Topology::Triangles;
    AlphaMode alphaMode = AlphaMode::Opaque;
    bool doubleSided = false;
    bool mirrored = false; // determinant < 0: front faces are clockwise
    Bounds bounds;         // render space, metres
    int32_t mesh = kNone, node = kNone, instance = 0;
};

/// Consecutive items that are one instanced draw: same mesh, hence same material and state.
struct DrawRun {
    const DrawItem* first = nullptr;
    uint32_t count = 0;
};

/// The textures of one material; what it lacks is white.
struct MaterialTextures {
    fg::StaticTexture baseColor, metallicRoughness, normal, occlusion, emissive;
};

/// False only where the box is outside of one of the planes (dot(plane.xyz, p) + plane.w ≥ 0 inside): may say true for boxes
/// that are outside, never false for one that is not.
bool mayBeInside(const Bounds& box, std::span<const vec4> planes);

class GpuScene {
public:
    /// `executor` must outlive the scene, and its context be current here and in all that follows.
    explicit GpuScene(fg::Executor& executor);
    ~GpuScene();
    GpuScene(const GpuScene&) = delete;
    GpuScene& operator=(const GpuScene&) = delete;

    /// Anisotropic filtering of material textures: 1 (none) to 16. Takes effect with the next update().
    void setAnisotropy(float anisotropy) { textures_.setAnisotropy(anisotropy); }
    [[nodiscard]] float anisotropy() const { return textures_.anisotropy(); }
    /// Uploads what changed. `renderOrigin` is in world space, metres.
    /// Errors: a texture or mesh that is larger than the driver takes.
    Result<void> update(const Scene& scene, const dvec3& renderOrigin);

    /// Everything visible, grouped by alpha mode, state, material and mesh. Until the next update().
    [[nodiscard]] std::span<const DrawItem> items() const { return items_; }
    /// The part of items() with this alpha mode.
    [[nodiscard]] std::span<const DrawItem> items(AlphaMode mode) const;
    [[nodiscard]] const MaterialTextures& textures(uint32_t material) const {
        return materialTextures_.at(material);
    }
    /// What an item of items() is drawn from.
    [[nodiscard]] MeshUpload::Buffers buffers(const DrawItem& item) const {
        return meshes_.buffers(item.mesh);
    }
    [[nodiscard]] fg::StaticBuffer objects() const { return objects_; }     // `Objects`
    [[nodiscard]] fg::StaticBuffer materials() const { return materials_; } // `Materials`
    [[nodiscard]] std::span<const gpu::ObjectData> objectData() const { return objectData_; }
    [[nodiscard]] std::span<const gpu::MaterialData> materialData() const { return materialData_; }
    /// Takes a new number whenever update() changes anything that a picture of the surfaces depends on: for cached passes.
    [[nodiscard]] Version version() const { return version_; }
    /// Of all items, render space.
    [[nodiscard]] const Bounds& bounds() const { return bounds_; }
    [[nodiscard]] const dvec3& renderOrigin() const { return renderOrigin_; }
    /// The scene of the last update; CHECKs that there was one.
    [[nodiscard]] const Scene& scene() const;

private:
    Result<void> updateMaterials(const Scene& scene);
    Result<void> updateItems(const Scene& scene);
    void addItems(const Scene& scene, int node, const dmat4& worldFromNode);
    void sortItems();

    fg::Executor& executor_;
    MeshUpload meshes_;
    TextureUpload textures_;
    const Scene* scene_ = nullptr;
    SceneVersions seen_;
    dvec3 renderOrigin_{0};
    float seenAnisotropy_ = 0;
    std::vector<DrawItem> items_;
    std::vector<gpu::ObjectData> objectData_;
    std::vector<gpu::MaterialData> materialData_;
    std::vector<MaterialTextures> materialTextures_;
    fg::StaticBuffer objects_, materials_;
    Bounds bounds_;
    Version version_ = 0;
};

/// Calls `draw(const DrawRun&)` for the items that may touch the space inside `planes`, in order.
template <typename Draw>
void forEachVisibleRun(std::span<const DrawItem> items, std::span<const vec4> planes, Draw&& draw) {
    DrawRun run;
    for (const DrawItem& item : items) {
        if (!mayBeInside(item.bounds, planes)) continue;
        const bool continues = run.count > 0 && item.mesh == run.first->mesh &&
                               item.mirrored == run.first->mirrored &&
                               item.object == run.first->object + run.count;
        if (!continues) {
            if (run.count > 0) draw(run);
            run = {&item, 0};
        }
        ++run.count;
    }
    if (run.count > 0) draw(run);
}

} // namespace tyndall
