#pragma once
// The scene's surfaces for plugins.

#include "plugin/plugin_api.h"
#include "renderer/gpu_scene.h"
#include "renderer/surface_settings.h"

namespace tyndall {

class GpuSurfaceDrawer final : public plugin::SurfaceDrawer {
public:
    GpuSurfaceDrawer(const GpuScene& scene, const GBufferSettings& settings)
        : scene_(scene), settings_(settings) {}

    [[nodiscard]] uint32_t triangleSetCount() const override { return uint32_t(sets_.size()); }
    [[nodiscard]] plugin::SurfaceTriangles triangles(uint32_t set) const override;
    [[nodiscard]] fg::StaticBuffer objects() const override { return scene_.objects(); }
    [[nodiscard]] fg::StaticBuffer materials() const override { return scene_.materials(); }
    GBuffer addGBuffer(fg::FrameGraph& graph, const char* name, const plugin::SurfaceView& from,
                       ViewResources& view) override;

    /// After each update of the scene.
    void update();

private:
    const GpuScene& scene_;
    const GBufferSettings& settings_;
    std::vector<const DrawItem*> sets_;
};

} // namespace tyndall
