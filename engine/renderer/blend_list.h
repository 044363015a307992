#pragma once
// The primitives of blended surfaces in the order in which they must be drawn.

#include <cstdint>
#include <span>
#include <vector>

#include "core/result.h"
#include "plugin/frame_resources.h"
#include "renderer/gpu_scene.h"
#include "shared/blend.h"

namespace tyndall {

/// Consecutive entries with one material and topology: one draw.
struct BlendRun {
    uint32_t material = 0;
    fg::Topology topology = fg::Topology::Triangles;
    uint32_t firstEntry = 0, entryCount = 0; // of `BlendOrder`: a vertex each
};

/// A blended primitive: where its vertices are, and how far its middle is along the view's axis (metres).
struct BlendPrimitive {
    float depth = 0;
    uint32_t item = 0;  // of GpuScene::items(AlphaMode::Blend)
    uint32_t first = 0; // of the mesh's indices
};
/// Far to near; equal depths keep the order of items and indices.
void sortBackToFront(std::vector<BlendPrimitive>& primitives);

class BlendList {
public:
    explicit BlendList(fg::Executor& executor) : executor_(executor) {}
    ~BlendList();
    BlendList(const BlendList&) = delete;
    BlendList& operator=(const BlendList&) = delete;

    /// Collects and sorts what `view` may see of the blended surfaces; nothing is done where neither scene nor view changed
    /// (sub-pixel jitter is no change). Errors: no room on the GPU.
    Result<void> update(const GpuScene& scene, const ViewResources& view);
    /// The scene has blended surfaces, in view or not.
    [[nodiscard]] bool any() const { return any_; }
    [[nodiscard]] std::span<const BlendRun> runs() const { return runs_; }
    [[nodiscard]] fg::StaticBuffer vertices() const { return vertices_; } // `BlendVertices`
    [[nodiscard]] fg::StaticBuffer order() const { return order_; }       // `BlendOrder`
    [[nodiscard]] const GpuScene& scene() const;

private:
    Result<void> updateVertices(const GpuScene& scene);
    Result<void> updateOrder(const GpuScene& scene, const ViewResources& view);
    void collect(const GpuScene& scene, const ViewResources& view);
    void makeEntries(const GpuScene& scene);

    fg::Executor& executor_;
    const GpuScene* scene_ = nullptr;
    Version seen_ = 0;
    vec4 seenPosition_{0}, seenForward_{0};
    mat4 seenView_{0};
    ivec2 seenSize_{0};
    bool any_ = false;
    std::vector<uint32_t> firstVertex_; // by mesh
    std::vector<BlendPrimitive> primitives_;
    std::vector<uvec2> entries_;
    std::vector<BlendRun> runs_;
    fg::StaticBuffer vertices_, order_;
    uint64_t orderBytes_ = 0;
};

} // namespace tyndall
