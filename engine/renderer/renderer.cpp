#include "renderer/renderer.h"

#include <fmt/format.h>
#include <tuple>

#include "core/log.h"
#include "renderer/inspect_pass.h"
#include "renderer/media_placement.h"
#include "renderer/renderer_impl.h"
#include "renderer/view.h"

namespace tyndall {
namespace {

constexpr int kLargestPicture = 16384; // pixels along an edge: what every GL 4.5 driver takes

} // namespace

/// The cone around all that the camera sees.
Viewer viewerAt(const CameraPose& pose, double aspect) {
    const dvec3 back(pose.worldFromCamera[2]);
    const double halfDiagonal = std::tan(0.5 * pose.camera.yfov) * std::hypot(1, aspect);
    return {dvec3(pose.worldFromCamera[3]), -glm::normalize(back),
            pose.camera.type == CameraType::Orthographic ? 0.5 * kPi : std::atan(halfDiagonal)};
}

void Renderer::Impl::registerSettings() {
    settings.add({tyndall::gbufferSettings(), &gbufferSettings});
    settings.add({tyndall::surfaceLightSettings(), &surfaceLightSettings});
    settings.addPreset(surfacePresets());
    lights.registerSettings(settings);
    media.registerSettings(settings);
    settings.add({tyndall::postSettings(), &postSettings});
    settings.add({tyndall::convergeSettings(), &convergeSettings});
    settings.add({tyndall::inspectSettings(), &inspectSettings});
    settings.add({tyndall::techniqueSettings(), &techniqueSettings});
}

void Renderer::Impl::updateReach(const Viewer& viewer) {
    const SceneVersions& now = scene->versions;
    const auto parts = [](const SceneVersions& v) {
        return std::tie(v.structure, v.transforms, v.meshes, v.materials, v.media, v.lights, v.environment);
    };
    const bool mediaOff = !media.settings().enabled;
    if (!knowsScene || parts(now) != parts(seenScene) || mediaOff != seenMediaOff) {
        clusters = findClusters(*scene, mediaOff);
        traits = sceneTraits(*scene, !mediaOff);
        seenScene = now;
        knowsScene = true;
        seenMediaOff = mediaOff;
    }
    reach = reachOf(clusters, viewer);
}

/// Uploads what changed and makes this frame's view, lights and lists.
Result<void> Renderer::Impl::updateScene(const FrameRequest& request, const CameraPose& pose) {
    const dvec3 eye(pose.worldFromCamera[3]);
    updateReach(viewerAt(pose, double(request.width) / double(request.height)));
    renderOrigin = chooseRenderOrigin(eye, reach.surroundings, renderOrigin);
    Bounds around = reach.surroundings;
    around.include(reach.seen);
    around.include(eye);
    const double radius = std::max(0.5 * glm::length(around.extent()), 100 * pose.camera.znear);
    order.view = makeView({&pose.camera, pose.worldFromCamera, renderOrigin, radius, request.width,
                           request.height, request.frameIndex, request.seed, request.converge});

    surfaces.setAnisotropy(gbufferSettings.anisotropy);
    if (Result<void> done = surfaces.update(*scene, renderOrigin); !done) return done;
    drawer.update();
    if (Result<void> done = media.update(*scene, renderOrigin); !done) return done;
    if (Result<void> done = environment.update(*scene); !done) return done;
    if (Result<void> done = blended.update(surfaces, order.view); !done) return done;
    surfaceBounds.clear();
    for (const DrawItem& item : surfaces.items()) surfaceBounds.push_back(item.bounds);
    const auto toRender = [&](const Bounds& world) {
        return Bounds{world.minimum - renderOrigin, world.maximum - renderOrigin};
    };
    lights.update({scene, renderOrigin, surfaceBounds, toRender(reach.surroundings),
                   toRender(reach.withLamps), &order.view, !media.settings().enabled});
    order.surfaceBounds = surfaceBounds;
    return {};
}

/// Everything that the picture depends on but the frame's number: when it changes, averaging starts again.
std::string Renderer::Impl::averageKey(const FrameRequest& request) const {
    const SceneVersions& v = scene->versions;
    std::string key =
        fmt::format("{} {} {} {} {} {} {} {} {} | {}x{} {} {} {} {} | ", v.structure, v.transforms,
                    v.meshes, v.materials, v.textures, v.lights, v.media, v.cameras, v.environment,
                    request.width, request.height, request.cameraNode, request.terms, request.seed,
                    request.time, request.separateTerms);
    const mat4& m = order.view.data.viewFromRender;
    for (int c = 0; c < 4; ++c) key += fmt::format("{} {} {} {} ", m[c].x, m[c].y, m[c].z, m[c].w);
    key += fmt::format("{} {} | {}", request.pose ? request.pose->camera.yfov : 0,
                       request.pose ? request.pose->camera.ymag : 0, shaders.generation());
    for (const std::string& setting : settings.differences())
        if (setting.rfind("inspect.", 0) != 0 && setting.rfind("post.", 0) != 0)
            key += " " + setting;
    return key;
}

Renderer::Renderer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Renderer::~Renderer() = default;

Result<std::unique_ptr<Renderer>> Renderer::create(gl::Context& context,
                                                   const RendererOptions& options) {
    CHECK(context.isCurrent(), "the renderer needs its context to be current");
    auto impl = std::make_unique<Impl>(context, options);
    impl->registerSettings();
    impl->plugins.addBuiltins(options.builtinPlugins);
    for (const std::filesystem::path& file : options.pluginFiles)
        if (Result<void> loaded = impl->plugins.load(file); !loaded) return loaded.error();
    for (const std::string& failure : impl->plugins.setup(impl->host, impl->settings))
        log::warning(failure);
    for (const plugin::RegisteredTechnique& technique : impl->plugins.techniques())
        impl->techniques.push_back(technique.description);
    return std::unique_ptr<Renderer>(new Renderer(std::move(impl)));
}

SettingsRegistry& Renderer::settings() { return impl_->settings; }
std::span<const Technique> Renderer::techniques() const { return impl_->techniques; }

Result<void> Renderer::setScene(const Scene& scene) {
    impl_->knowsScene = false;
    impl_->scene = &scene;
    impl_->average = {};
    return {};
}

/// The request's own pose, or that of the camera node that it or the scene names.
Result<CameraPose> Renderer::Impl::choosePose(const FrameRequest& request) const {
    if (request.pose) return *request.pose;
    const int node = request.cameraNode != kNone ? request.cameraNode : scene->activeCamera;
    if (node == kNone || scene->nodes.at(size_t(node)).camera == kNone)
        return Error{"the scene '" + scene->name + "' has no camera: add a node with a \"camera\""};
    return CameraPose{scene->cameras.at(size_t(scene->nodes[size_t(node)].camera)),
                      scene->worldTransforms().at(size_t(node))};
}

/// What techniques may compare to know that something of theirs is stale.
plugin::SceneState Renderer::Impl::describeScene() const {
    const SceneVersions& v = scene->versions;
    plugin::SceneState state{surfaces.version(),
                               v.materials,
                               v.lights,
                               media.version(),
                               v.environment,
                               uint32_t(lights.lights().size()),
                               uint32_t(scene->media.size()),
                               {},
                               {},
                               {},
                               {}};
    const auto toRender = [&](const dvec3& p, float(&out)[4]) {
        for (int axis = 0; axis < 3; ++axis) out[axis] = float(p[axis] - renderOrigin[axis]);
    };
    toRender(reach.surroundings.minimum, state.boundsMinimum);
    toRender(reach.surroundings.maximum, state.boundsMaximum);
    toRender(reach.content.minimum, state.contentMinimum);
    toRender(reach.content.maximum, state.contentMaximum);
    return state;
}

/// `plan` must live until the frame has been recorded.
void Renderer::Impl::fillOrder(const FrameRequest& request, const FramePlan& plan) {
    order.plan = &plan;
    order.scene = scene;
    order.renderOrigin = renderOrigin;
    order.ev100 = scene->ev100;
    order.separateTerms = request.separateTerms;
    order.statistics = request.statistics;
    order.frameIndex = request.frameIndex;
    order.averagedFrame = request.converge ? average.next(averageKey(request), request.restart) : 0;
    order.sceneState = describeScene();
}

/// Records the frame's passes, and the inspector's where it wants one.
fg::FrameGraph& Renderer::Impl::record(const FrameRequest& request) {
    const bool inspecting = !request.inspect.empty();
    fg::ExecutorOptions options = executor.options();
    if (options.keepAll != inspecting) {
        options.keepAll = inspecting;
        executor.setOptions(options);
    }
    fg::FrameGraph& graph = executor.beginFrame();
    images = recordFrame(graph,
                         {surfaces, lights, media, blended, environment, plugins, drawer,
                          gbufferSettings, surfaceLightSettings, postSettings},
                         order);
    inspected = {};
    if (!inspecting) return graph;
    const fg::TextureHandle resource = executor.findTexture(request.inspect);
    if (resource && !fg::isIntegerFormat(graph.desc(resource).format))
        inspected = addInspectPass(graph, resource, request.width, request.height, inspectSettings);
    return graph;
}

/// All that may be read back after the frame.
void Renderer::Impl::markOutputs(fg::FrameGraph& graph, const FrameRequest& request) const {
    for (fg::TextureHandle output :
         {images.beauty, images.display.image, inspected, images.gbuffer.depth,
          images.gbuffer.normal, images.gbuffer.base, images.transmittance})
        if (output && !graph.isAbsent(output)) graph.markOutput(output);
    graph.markOutput(images.display.invalidPixels); // the pass that counts them may run again
    if (request.separateTerms)
        for (uint32_t i = 0; i < images.terms.count; ++i)
            graph.markOutput(images.terms.images[i].image);
    if (images.firstInvalid) graph.markOutput(images.firstInvalid);
    for (const StatisticsBuffer& statistics : images.statistics)
        graph.markOutput(statistics.values);
}

void Renderer::Impl::measureAverage(FrameResult& result) {
    if (average.shouldMeasure(convergeSettings)) average.measure(executor.readImage(images.beauty));
    result.accumulatedFrames = average.frames();
    result.estimatedError = average.estimatedError();
    result.converged = result.estimatedError <= double(convergeSettings.relmse) ||
                       result.accumulatedFrames >= uint32_t(convergeSettings.maximumFrames);
}

Result<FrameResult> Renderer::renderFrame(const FrameRequest& request) {
    try {
        return impl_->renderFrame(request);
    } catch (const gl::NoRoom& lack) {
        impl_->order.plan = nullptr; // it was that call's
        return Error{fmt::format(
            "a picture of {}x{} pixels cannot be made here: {}; a smaller --size or a lower --quality needs less",
            request.width, request.height, lack.what())};
    }
}

Result<FrameResult> Renderer::Impl::renderFrame(const FrameRequest& request) {
    Impl& r = *this;
    CHECK(r.scene != nullptr, "setScene() comes before renderFrame()");
    r.hasPicture = false;
    if (request.width < 1 || request.height < 1 || request.width > kLargestPicture ||
        request.height > kLargestPicture)
        return Error{
            fmt::format("a picture of {}x{} pixels cannot be made: each side takes 1 to {}",
                        request.width, request.height, kLargestPicture)};
    const Result<CameraPose> pose = r.choosePose(request);
    if (!pose) return pose.error();

    r.shaders.pollChanges();
    if (Result<void> updated = r.updateScene(request, *pose); !updated) return updated.error();
    const Result<FramePlan> plan =
        makePlan(r.techniqueSettings.technique.view(), request.terms, r.techniques, r.traits);
    if (!plan) return plan.error();
    r.fillOrder(request, *plan);
    r.markOutputs(r.record(request), request);
    const Result<void> done = r.executor.execute();
    r.order.plan = nullptr;
    if (!done) return done.error();
    r.hasPicture = true;

    FrameResult result;
    result.plan = *plan;
    if (request.converge) r.measureAverage(result);
    return result;
}

Result<bool> Renderer::toneMapAgain() {
    Impl& r = *impl_;
    if (!r.hasPicture || r.images.beautyMayDependOnExposure) return false;
    r.order.ev100 = r.scene->ev100;
    *r.images.display.params =
        tonemapParams(r.order.ev100, r.postSettings, r.order.view.data.seed);
    if (const Result<void> done = r.executor.runAgain(r.images.display.pass); !done.ok())
        return done.error();
    return true;
}

const fg::FrameReport& Renderer::report() const { return impl_->executor.report(); }
void Renderer::waitForTimings() { impl_->executor.waitForTimings(); }
const fg::CompiledGraph& Renderer::graph() const { return impl_->executor.compiled(); }

std::vector<std::string> Renderer::notes() const {
    std::vector<std::string> all = impl_->lights.notes();
    all.insert(all.end(), impl_->media.notes().begin(), impl_->media.notes().end());
    return all;
}

bool Renderer::reloadShaders() { return impl_->shaders.pollChanges() > 0; }

} // namespace tyndall
