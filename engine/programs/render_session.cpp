#include "programs/render_session.h"

#include <fmt/format.h>

#include "core/log.h"
#include "plugin/builtin_plugins.h"
#include "programs/interrupt.h"
#include "programs/load_scene.h"

namespace tyndall {
namespace {

constexpr std::string_view kTechniqueKey =
    "gi.technique="; // a name, not a number: it goes into the request

/// The lens of that node's camera at another place.
CameraPose posedCamera(const Scene& scene, int node, const PoseOption& pose) {
    CameraPose result;
    result.camera = scene.cameras.at(size_t(scene.nodes.at(size_t(node)).camera));
    if (pose.yfov) result.camera.yfov = *pose.yfov;
    result.worldFromCamera = glm::mat4_cast(pose.rotation);
    result.worldFromCamera[3] = dvec4(pose.position, 1);
    return result;
}

} // namespace

Outcome RenderSession::loadSceneFile(const RenderOptions& options, ProgressStyle style,
                                     CpuProfiler* profiler) {
    const CpuZone zone(profiler, "scene.load");
    return loadSceneForCommand(options.scene, style, scene_);
}

Outcome RenderSession::startRenderer(const RenderOptions& options, const RenderPlan& plan,
                                     CpuProfiler* profiler) {
    {
        const CpuZone zone(profiler, "context.create");
        gl::ContextOptions contextOptions;
        contextOptions.backend = plan.backend;
        contextOptions.device = options.device;
        Result<gl::Context> context = gl::Context::create(contextOptions);
        if (!context.ok()) return failed(context.message());
        context_ = std::move(*context);
        log::info(context_.choice());
    }
    const CpuZone zone(profiler, "renderer.create");
    RendererOptions rendererOptions;
    rendererOptions.builtinPlugins = plugin::builtinPlugins();
    rendererOptions.pluginFiles = plan.plugins;
    Result<std::unique_ptr<Renderer>> renderer = Renderer::create(context_, rendererOptions);
    // With a plugin of the user's choice the likely culprit is that file.
    if (!renderer.ok())
        return plan.plugins.empty() ? failed(renderer.message()) : wrongInput(renderer.message());
    renderer_ = std::move(*renderer);
    return {};
}

Outcome RenderSession::assign(const std::string& assignment, const std::string& origin) {
    if (assignment.starts_with(kTechniqueKey)) {
        request_.gi = assignment.substr(kTechniqueKey.size());
        return {};
    }
    const Result<void> done = renderer_->settings().assign(assignment);
    return done.ok() ? Outcome{} : wrongInput(origin + done.message());
}

Outcome RenderSession::applySettings(const RenderOptions& options, const RenderPlan& plan) {
    for (const std::string& assignment : scene_.settings)
        if (Outcome done = assign(assignment, fmt::format("'{}': /settings: ", options.scene));
            !done.ok())
            return done;
    if (plan.quality) renderer_->settings().applyPreset(*plan.quality);
    for (const std::string& assignment : options.assignments)
        if (Outcome done = assign(assignment, "--set: "); !done.ok()) return done;
    if (!options.gi.empty()) request_.gi = options.gi;
    // What cannot be rendered in any scene is said before one is uploaded.
    const Result<FramePlan> framePlan =
        makePlan(request_.gi, request_.terms, renderer_->techniques(), {true, true, true, true});
    return framePlan.ok() ? Outcome{}
                          : wrongInput("--gi " + request_.gi + ": " + framePlan.message());
}

Outcome RenderSession::open(const RenderOptions& options, ProgressStyle progress,
                            CpuProfiler* profiler, std::unique_ptr<RenderSession>& session) {
    const Result<RenderPlan> plan = understand(options);
    if (!plan.ok()) return wrongInput(plan.message());
    std::unique_ptr<RenderSession> opened(new RenderSession);
    if (Outcome done = opened->loadSceneFile(options, progress, profiler); !done.ok()) return done;

    FrameRequest& request = opened->request_;
    request.width = plan->width;
    request.height = plan->height;
    request.terms = plan->terms;
    request.time = options.time;
    request.seed = options.seed;
    if (!options.camera.empty()) {
        const Result<int> node = findCamera(opened->scene_, options.camera);
        if (!node.ok()) return wrongInput(node.message());
        request.cameraNode = *node;
    } else if (opened->scene_.activeCamera == kNone) {
        return wrongInput(fmt::format(
            "'{}' has no camera: add a node with a \"camera\" and name it under \"camera\"",
            options.scene));
    }
    if (plan->pose) {
        const int node =
            request.cameraNode != kNone ? request.cameraNode : opened->scene_.activeCamera;
        request.pose = posedCamera(opened->scene_, node, *plan->pose);
    }
    if (Outcome done = opened->startRenderer(options, *plan, profiler); !done.ok()) return done;
    if (Outcome done = opened->applySettings(options, *plan); !done.ok()) return done;
    const CpuZone zone(profiler, "renderer.setScene");
    if (const Result<void> set = opened->renderer_->setScene(opened->scene_); !set.ok())
        return wrongInput(set.message());
    session = std::move(opened);
    return {};
}

int64_t RenderSession::closeRendererAndCountLeaks() {
    renderer_.reset();
    return context_.liveObjects().total();
}

} // namespace tyndall
