#pragma once
// The scene for rays on the processor, with its triangles for shaders; parts that change are built again. One instance serves all techniques of the plugin.

#include "plugin/plugin_api.h"
#include "shared/traced.h"
#include "tracing/light_emission.h"
#include "tracing/triangle_tree.h"

namespace tyndall::volumetric_gi {

/// As shaders read it.
gpu::TracedTriangle packTriangle(const tracing::SceneTriangle& triangle);

/// For shaders that include gi/shared/visibility.glsl.
struct TracedBuffers {
    fg::BufferHandle triangles, tree;
    gpu::TracedParams params{};
};

/// Declares that a pass reads them; the result is what bindTraced() takes.
[[nodiscard]] TracedBuffers readTraced(fg::Builder& builder, const TracedBuffers& buffers);

template <typename Command> Command& bindTraced(Command& command, const TracedBuffers& buffers) {
    return command.params(buffers.params, "Traced")
        .bind("TracedTriangles", buffers.triangles)
        .bind("TracedTree", buffers.tree);
}

struct TracedSceneOptions {
    /// Paths go through proxy media, which small changes of the media do not change (tracing/proxy_media.h).
    bool proxyMedia = false;
};

class TracedScene {
public:
    /// Parts that have not changed since the last call stay, so that a second technique's call in a frame costs nothing. With other options media
    /// and lights are built again, but not surfaces; proxy media stay alive, because kept paths point to them.
    /// Errors: the surfaces do not fit into memory.
    Result<void> update(const plugin::FrameInputs& inputs, const TracedSceneOptions& options);

    // As of the last update().

    /// The media and surfaces that paths go through.
    [[nodiscard]] const tracing::TracerScene& scene() const { return scene_; }
    [[nodiscard]] const tracing::LightEmission& emission() const { return *emission_; }
    /// Around the objects of the scene, without the landscape around them; render space.
    [[nodiscard]] const Bounds& content() const { return content_; }
    /// Are the media there proxies?
    [[nodiscard]] bool usesProxies() const { return usesProxies_; }
    /// The actual media.
    [[nodiscard]] const tracing::MediaField& media() const {
        return usesProxies_ ? *otherMedia_ : *scene_.media;
    }
    /// All triangles, and a tree over them, as shaders read them.
    [[nodiscard]] const std::vector<gpu::TracedTriangle>& triangles() const { return triangles_; }
    [[nodiscard]] const std::vector<tracing::TreeNode>& tree() const { return tree_; }
    /// Are there triangles with holes?
    [[nodiscard]] bool hasHoles() const { return hasHoles_; }
    /// Of everything that the paths of walks depend on, of everything that their power depends on, and of the surfaces alone.
    [[nodiscard]] uint64_t walksKey() const { return walksKey_; }
    [[nodiscard]] uint64_t key() const { return key_; }
    [[nodiscard]] uint64_t surfacesKey() const { return surfacesKey_; }

    /// Triangles and tree on the GPU: uploaded at the first call in a frame; later calls return the same.
    [[nodiscard]] const TracedBuffers& buffers(fg::FrameGraph& graph);
    /// Handles end with their frame: to be called when all of its passes have been added.
    void endFrame() { buffers_ = {}; }

private:
    Result<void> updateSurfaces(const Scene& scene, const dvec3& origin);
    bool moveSurfaces(const Scene& scene, const dvec3& origin);
    void updateMedia(const Scene& scene, const dvec3& origin, bool off, bool useProxies);

    tracing::TracerScene scene_;
    std::unique_ptr<tracing::MediaField>
        otherMedia_; // if those in scene_ are proxies, the actual media; else the last proxies, if any
    std::unique_ptr<tracing::LightEmission> emission_;
    Bounds content_;
    std::vector<gpu::TracedTriangle> triangles_;
    std::vector<tracing::TreeNode> tree_;
    TracedBuffers buffers_; // of this frame
    bool hasHoles_ = false, usesProxies_ = false;
    const Scene* whole_ = nullptr;
    uint64_t key_ = 0, walksKey_ = 0, proxyHash_ = 0, surfacesKey_ = 0, shapesKey_ = 0;
};

} // namespace tyndall::volumetric_gi
