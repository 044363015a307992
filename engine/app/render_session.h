#pragma once
// A scene, a GL context and a renderer with its settings applied: what a picture is rendered with, by programs and by the editor.

#include <memory>
#include <string>

#include "app/job.h"
#include "app/options.h"
#include "app/outcome.h"
#include "app/settings_layers.h"
#include "core/cpu_profiler.h"
#include "gl/context.h"
#include "renderer/renderer.h"
#include "scene/scene.h"

namespace tyndall {

/// Belongs to the thread that opens it, as its GL context does.
class RenderSession {
public:
    /// Reads the scene first, so that a wrong file is refused before anything else is done; then context, renderer and settings.
    /// Says what was supplied and which back end it is. `profiler` may be null and must outlive the session.
    static Outcome open(const RenderOptions& options, JobControl& job, CpuProfiler* profiler,
                        std::unique_ptr<RenderSession>& session);
    /// The same with a scene that was read before, in a context that is current, such as a window's, and outlives the session.
    static Outcome openIn(gl::Context& context, Scene scene, const RenderOptions& options,
                          CpuProfiler* profiler, std::unique_ptr<RenderSession>& session);

    /// For the first frame; size, time, terms, camera and seed as the options say.
    [[nodiscard]] const FrameRequest& request() const { return request_; }
    [[nodiscard]] const RenderOptions& options() const { return options_; }
    [[nodiscard]] const RenderPlan& plan() const { return plan_; }
    /// The renderer sees changes by their version numbers (scene/scene_edit.h).
    [[nodiscard]] Scene& scene() { return scene_; }
    [[nodiscard]] const Scene& scene() const { return scene_; }
    [[nodiscard]] Renderer& renderer() { return *renderer_; }
    [[nodiscard]] gl::Context& context() { return *context_; }
    /// As the scene file alone has them: what a command line need not say again.
    [[nodiscard]] const SettingsSnapshot& settingsOfScene() const { return settingsOfScene_; }
    /// Destroys the renderer; what is alive in the context after that was leaked.
    int64_t closeRendererAndCountLeaks();

private:
    explicit RenderSession(const RenderOptions& options) : options_(options) {}
    Outcome makeRequest();
    Outcome createContext(CpuProfiler* profiler);
    Outcome startRenderer(CpuProfiler* profiler);

    RenderOptions options_;
    RenderPlan plan_;
    Scene scene_;
    gl::Context ownContext_;         // empty in a session of openIn()
    gl::Context* context_ = nullptr; // outlives the renderer
    std::unique_ptr<Renderer> renderer_;
    FrameRequest request_;
    SettingsSnapshot settingsOfScene_;
};

} // namespace tyndall
