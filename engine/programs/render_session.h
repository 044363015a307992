#pragma once
// A scene, a GL context and a renderer with its settings applied: what capture and graph have in common.

#include <memory>
#include <string>

#include "core/cpu_profiler.h"
#include "core/progress.h"
#include "gl/context.h"
#include "programs/render_options.h"
#include "renderer/renderer.h"
#include "scene/scene_file.h"

namespace tyndall {

class RenderSession {
public:
    /// Reads the scene first, so that a wrong file is refused before anything else is done; then context, renderer, settings:
    /// those of the scene file, over them the preset, over that `--set`. Says what was supplied and which back end it is.
    /// `profiler` may be null and must outlive the session.
    static Outcome open(const RenderOptions& options, ProgressStyle progress, CpuProfiler* profiler,
                        std::unique_ptr<RenderSession>& session);

    /// For the first frame; time, terms, technique, camera and seed as on the command line.
    [[nodiscard]] const FrameRequest& request() const { return request_; }
    [[nodiscard]] float ev100() const { return scene_.ev100; }
    [[nodiscard]] Renderer& renderer() { return *renderer_; }
    [[nodiscard]] gl::Context& context() { return context_; }
    /// Destroys the renderer; what is alive in the context after that was leaked.
    int64_t closeRendererAndCountLeaks();

private:
    RenderSession() = default;
    Outcome loadSceneFile(const RenderOptions& options, ProgressStyle progress,
                          CpuProfiler* profiler);
    Outcome startRenderer(const RenderOptions& options, const RenderPlan& plan,
                          CpuProfiler* profiler);
    Outcome applySettings(const RenderOptions& options, const RenderPlan& plan);
    Outcome assign(const std::string& assignment, const std::string& origin);

    Scene scene_;
    gl::Context context_; // outlives the renderer
    std::unique_ptr<Renderer> renderer_;
    FrameRequest request_;
};

} // namespace tyndall
