#pragma once
// The scene as random walks see it, made anew where it has changed.

#include <string>

#include "plugin/plugin_api.h"
#include "reference/light_walk.h"
#include "reference/triangle_tree.h"
#include "shared/vpl.h"

namespace tyndall::volumetric_gi {

class TracedScene {
public:
    /// Errors: the surfaces do not fit into memory.
    Result<void> update(const plugin::FrameInputs& inputs);

    [[nodiscard]] const reference::TracerScene& scene() const { return scene_; }
    [[nodiscard]] const reference::LightEmission& emission() const { return *emission_; }
    /// All triangles, and a tree over them, as shaders read them.
    [[nodiscard]] const std::vector<gpu::VplTriangle>& triangles() const { return triangles_; }
    [[nodiscard]] const std::vector<reference::TreeNode>& tree() const { return tree_; }
    /// Of everything that walks follow from, and of the surfaces alone.
    [[nodiscard]] uint64_t key() const { return key_; }
    [[nodiscard]] uint64_t surfacesKey() const { return surfacesKey_; }

private:
    Result<void> updateSurfaces(const Scene& scene, const dvec3& origin);

    reference::TracerScene scene_;
    std::unique_ptr<reference::LightEmission> emission_;
    std::vector<gpu::VplTriangle> triangles_;
    std::vector<reference::TreeNode> tree_;
    const Scene* whole_ = nullptr;
    uint64_t key_ = 0, surfacesKey_ = 0;
};

} // namespace tyndall::volumetric_gi
