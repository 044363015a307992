#include "app/render_session.h"

#include <fmt/format.h>

#include "app/load_scene.h"
#include "core/log.h"
#include "plugin/builtin_plugins.h"

namespace tyndall {
namespace {

/// The lens of that node's camera at another place.
CameraPose posedCamera(const Scene& scene, int node, const PoseOption& pose) {
    CameraPose result;
    result.camera = scene.cameras.at(size_t(scene.nodes.at(size_t(node)).camera));
    if (pose.yfov) result.camera.yfov = *pose.yfov;
    result.worldFromCamera = glm::mat4_cast(pose.rotation);
    result.worldFromCamera[3] = dvec4(pose.position, 1);
    return result;
}

Outcome interrupted() { return failed("interrupted before the first frame; nothing was written"); }

} // namespace

Outcome RenderSession::makeRequest() {
    request_.width = plan_.width;
    request_.height = plan_.height;
    request_.terms = plan_.terms;
    request_.time = options_.time;
    request_.seed = uint32_t(options_.seed);
    if (!options_.camera.empty()) {
        const Result<int> node = findCamera(scene_, options_.camera);
        if (!node.ok()) return wrongInput(node.message());
        request_.cameraNode = *node;
    } else if (scene_.activeCamera == kNone) {
        return wrongInput(fmt::format(
            "'{}' has no camera: add a node with a \"camera\" and name it under \"camera\"",
            options_.scene));
    }
    if (!plan_.pose) return {};
    const int node = request_.cameraNode != kNone ? request_.cameraNode : scene_.activeCamera;
    request_.pose = posedCamera(scene_, node, *plan_.pose);
    return {};
}

Outcome RenderSession::createContext(CpuProfiler* profiler) {
    const CpuZone zone(profiler, "context.create");
    gl::ContextOptions contextOptions;
    contextOptions.backend = plan_.backend;
    contextOptions.device = options_.device;
    Result<gl::Context> context = gl::Context::create(contextOptions);
    if (!context.ok()) return failed(context.message());
    ownContext_ = std::move(*context);
    context_ = &ownContext_;
    log::info(ownContext_.choice());
    return {};
}

Outcome RenderSession::startRenderer(CpuProfiler* profiler) {
    {
        const CpuZone zone(profiler, "renderer.create");
        RendererOptions rendererOptions;
        rendererOptions.builtinPlugins = plugin::builtinPlugins();
        rendererOptions.pluginFiles = plan_.plugins;
        Result<std::unique_ptr<Renderer>> renderer = Renderer::create(*context_, rendererOptions);
        // With a plugin of the user's choice the likely culprit is that file.
        if (!renderer.ok())
            return plan_.plugins.empty() ? failed(renderer.message())
                                         : wrongInput(renderer.message());
        renderer_ = std::move(*renderer);
    }
    const SettingsLayers layers{options_.scene, scene_.settings, plan_.quality,
                                options_.assignments, options_.gi};
    if (Outcome applied = applySettings(*renderer_, layers, scene_, plan_.terms, &settingsOfScene_);
        !applied.ok())
        return applied;
    const CpuZone zone(profiler, "renderer.setScene");
    const Result<void> set = renderer_->setScene(scene_);
    return set.ok() ? Outcome{} : wrongInput(set.message());
}

Outcome RenderSession::open(const RenderOptions& options, JobControl& job, CpuProfiler* profiler,
                            std::unique_ptr<RenderSession>& session) {
    Result<RenderPlan> plan = understand(options);
    if (!plan.ok()) return wrongInput(plan.message());
    std::unique_ptr<RenderSession> opened(new RenderSession(options));
    opened->plan_ = std::move(*plan);
    {
        const CpuZone zone(profiler, "scene.load");
        if (Outcome loaded = loadScene(options, job, opened->scene_); !loaded.ok()) return loaded;
    }
    if (Outcome done = opened->makeRequest(); !done.ok()) return done;
    JobPhase phase(job, "starting the renderer");
    if (Outcome done = opened->createContext(profiler); !done.ok()) return done;
    if (job.cancelled()) return interrupted();
    if (Outcome done = opened->startRenderer(profiler); !done.ok()) return done;
    if (job.cancelled()) return interrupted();
    session = std::move(opened);
    return {};
}

Outcome RenderSession::openIn(gl::Context& context, Scene scene, const RenderOptions& options,
                              CpuProfiler* profiler, std::unique_ptr<RenderSession>& session) {
    Result<RenderPlan> plan = understand(options);
    if (!plan.ok()) return wrongInput(plan.message());
    std::unique_ptr<RenderSession> opened(new RenderSession(options));
    opened->plan_ = std::move(*plan);
    opened->scene_ = std::move(scene);
    opened->context_ = &context;
    if (Outcome done = opened->makeRequest(); !done.ok()) return done;
    if (Outcome done = opened->startRenderer(profiler); !done.ok()) return done;
    session = std::move(opened);
    return {};
}

int64_t RenderSession::closeRendererAndCountLeaks() {
    renderer_.reset();
    return context_->liveObjects().total();
}

} // namespace tyndall
