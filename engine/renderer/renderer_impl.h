#pragma once
// What a Renderer holds; included by renderer.cpp and renderer_readback.cpp alone.

#include "core/log.h"
#include "gl/shader_library.h"
#include "renderer/accumulation.h"
#include "renderer/frame.h"
#include "renderer/inspect_pass.h"
#include "renderer/renderer.h"
#include "renderer/surface_drawer.h"
#include "renderer/technique_settings.h"
#include "scene/scene_reach.h"

namespace tyndall {

/// Takes plugins' shaders into the library.
class PluginHost final : public plugin::Host {
public:
    explicit PluginHost(gl::ShaderLibrary& library) : library_(library) {}
    void addShader(const char* path, const char* text) override { library_.addSource(path, text); }
    void log(const char* message) override { log::info(message); }

private:
    gl::ShaderLibrary& library_;
};

struct Renderer::Impl {
    Impl(gl::Context& glContext, const RendererOptions& options)
        : context(glContext), executor(shaders, {.poison = options.poison,
                                                 .checkTexels = options.checkTexels,
                                                 .keepAll = false,
                                                 .timings = true}),
          host(shaders) {}

    gl::Context& context;
    gl::ShaderLibrary shaders;
    fg::Executor executor;
    PluginHost host;
    GpuScene surfaces{executor};
    LightSystem lights;
    MediaSystem media{executor};
    EnvironmentMap environment{executor};
    BlendList blended{executor};
    plugin::PluginRegistry plugins;

    SettingsRegistry settings;
    GBufferSettings gbufferSettings{};
    GpuSurfaceDrawer drawer{surfaces, gbufferSettings};
    SurfaceLightSettings surfaceLightSettings{};
    PostSettings postSettings{};
    ConvergeSettings convergeSettings{};
    InspectSettings inspectSettings{};
    TechniqueSettings techniqueSettings{};
    std::vector<Technique> techniques;

    const Scene* scene = nullptr;
    SceneClusters clusters;
    SceneTraits traits;
    SceneVersions seenScene; // of what clusters and traits were made from
    bool knowsScene = false, seenMediaOff = false;
    SceneReach reach;           // of this frame's view
    dvec3 renderOrigin{0};
    std::vector<Bounds> surfaceBounds;
    Accumulation average;
    FrameOrder order;
    FrameImages images;
    bool hasPicture = false; // the last frame succeeded, and its images are still there
    fg::TextureHandle inspected;

    void registerSettings();
    /// Throws gl::NoRoom.
    Result<FrameResult> renderFrame(const FrameRequest& request);
    // The steps of a frame, in order.
    Result<CameraPose> choosePose(const FrameRequest& request) const;
    void updateReach(const Viewer& viewer);
    Result<void> updateScene(const FrameRequest& request, const CameraPose& pose);
    std::string averageKey(const FrameRequest& request) const;
    plugin::SceneState describeScene() const;
    void fillOrder(const FrameRequest& request, const FramePlan& plan);
    fg::FrameGraph& record(const FrameRequest& request);
    void markOutputs(fg::FrameGraph& graph, const FrameRequest& request) const;
    void measureAverage(FrameResult& result);
};

} // namespace tyndall
