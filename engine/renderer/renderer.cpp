#include "renderer/renderer.h"

#include <fmt/format.h>
#include <tuple>

#include "core/log.h"
#include "renderer/inspect_pass.h"
#include "renderer/renderer_impl.h"
#include "renderer/view.h"

namespace tyndall {
namespace {

constexpr int kLargestPicture = 16384; // pixels along an edge: what every GL 4.5 driver takes

MediaSet kindOf(const Medium& medium) {
    switch (medium.kind) {
    case MediumKind::Everywhere:
    case MediumKind::Box:
    case MediumKind::Sphere: return kShapeMedia;
    case MediumKind::Height: return kHeightMedia;
    case MediumKind::Grid: return medium.particles ? kParticleMedia : kGridMedia;
    }
    return 0;
}

SceneTraits traitsOf(const Scene& scene, const GpuScene& surfaces, const LightSystem& lights,
                     bool mediaEnabled) {
    SceneTraits traits;
    traits.surfaces = !surfaces.items().empty();
    traits.lights = !lights.lights().empty() || maximumOf(scene.environment.radiance) > 0 ||
                    scene.environment.image;
    for (const Material& material : scene.materials)
        traits.lights |= maximumOf(material.emissive) > 0;
    if (!mediaEnabled) return traits;
    traits.kinds = 0;
    for (const Medium& medium : scene.media) {
        if (maximumOf(medium.scattering) > 0) traits.kinds |= kindOf(medium);
        traits.media |= maximumOf(medium.extinction()) > 0 || maximumOf(medium.emission) > 0;
        traits.scatteringMedia |= maximumOf(medium.scattering) > 0;
        traits.lights |=
            maximumOf(medium.emission) > 0 || (medium.temperature && medium.temperatureScale > 0);
    }
    return traits;
}

} // namespace

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

/// Uploads what changed and makes this frame's view, lights and lists.
Result<void> Renderer::Impl::updateScene(const FrameRequest& request, const dmat4& worldFromCamera,
                                         const Camera& camera) {
    const SceneVersions& now = scene->versions;
    if (std::tie(now.structure, now.transforms, now.meshes, now.media) !=
        std::tie(seenBounds.structure, seenBounds.transforms, seenBounds.meshes,
                 seenBounds.media)) {
        sceneBounds = scene->worldBounds();
        contentBounds = scene->contentBounds();
        seenBounds = now;
    }
    const dvec3 eye(worldFromCamera[3]);
    renderOrigin = chooseRenderOrigin(eye, sceneBounds, renderOrigin);
    Bounds around = sceneBounds;
    around.include(eye);
    const double radius = std::max(0.5 * glm::length(around.extent()), 100 * camera.znear);
    order.view = makeView({&camera, worldFromCamera, renderOrigin, radius, request.width,
                           request.height, request.frameIndex, request.seed, request.converge});

    surfaces.setAnisotropy(gbufferSettings.anisotropy);
    if (Result<void> done = surfaces.update(*scene, renderOrigin); !done) return done;
    drawer.update();
    if (Result<void> done = media.update(*scene, renderOrigin); !done) return done;
    if (Result<void> done = environment.update(*scene); !done) return done;
    if (Result<void> done = blended.update(surfaces, order.view); !done) return done;
    lights.update({scene, renderOrigin, surfaces.bounds(), &order.view});
    surfaceBounds.clear();
    for (const DrawItem& item : surfaces.items()) surfaceBounds.push_back(item.bounds);
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
    if (impl_->scene != &scene) impl_->seenBounds = {};
    impl_->scene = &scene;
    impl_->sceneBounds = scene.worldBounds();
    impl_->contentBounds = scene.contentBounds();
    impl_->average = {};
    return {};
}

Result<FrameResult> Renderer::renderFrame(const FrameRequest& request) {
    Impl& r = *impl_;
    CHECK(r.scene != nullptr, "setScene() comes before renderFrame()");
    if (request.width < 1 || request.height < 1 || request.width > kLargestPicture ||
        request.height > kLargestPicture)
        return Error{
            fmt::format("a picture of {}x{} pixels cannot be made: each side takes 1 to {}",
                        request.width, request.height, kLargestPicture)};
    const int node = request.cameraNode != kNone ? request.cameraNode : r.scene->activeCamera;
    if (!request.pose && (node == kNone || r.scene->nodes.at(size_t(node)).camera == kNone))
        return Error{"the scene '" + r.scene->name +
                     "' has no camera: add a node with a \"camera\""};
    const dmat4 worldFromCamera =
        request.pose ? request.pose->worldFromCamera : r.scene->worldTransforms().at(size_t(node));
    const Camera& camera = request.pose
                               ? request.pose->camera
                               : r.scene->cameras.at(size_t(r.scene->nodes[size_t(node)].camera));

    r.shaders.pollChanges();
    if (Result<void> updated = r.updateScene(request, worldFromCamera, camera); !updated)
        return updated.error();
    const Result<FramePlan> plan =
        makePlan(r.techniqueSettings.technique.view(), request.terms, r.techniques,
                 traitsOf(*r.scene, r.surfaces, r.lights, r.media.settings().enabled));
    if (!plan) return plan.error();

    r.order.plan = &*plan;
    r.order.scene = r.scene;
    r.order.renderOrigin = r.renderOrigin;
    r.order.ev100 = r.scene->ev100;
    r.order.separateTerms = request.separateTerms;
    r.order.statistics = request.statistics;
    r.order.averagedFrame =
        request.converge ? r.average.next(r.averageKey(request), request.restart) : 0;
    const SceneVersions& v = r.scene->versions;
    r.order.sceneState = {r.surfaces.version(),
                           v.materials,
                           v.lights,
                           r.media.version(),
                           v.environment,
                           uint32_t(r.lights.lights().size()),
                           uint32_t(r.scene->media.size()),
                           {},
                           {},
                           {},
                           {}};
    const auto toRender = [&](const dvec3& p, float(&out)[4]) {
        for (int axis = 0; axis < 3; ++axis) out[axis] = float(p[axis] - r.renderOrigin[axis]);
    };
    toRender(r.sceneBounds.minimum, r.order.sceneState.boundsMinimum);
    toRender(r.sceneBounds.maximum, r.order.sceneState.boundsMaximum);
    toRender(r.contentBounds.minimum, r.order.sceneState.contentMinimum);
    toRender(r.contentBounds.maximum, r.order.sceneState.contentMaximum);

    const bool inspecting = !request.inspect.empty();
    fg::ExecutorOptions options = r.executor.options();
    if (options.keepAll != inspecting) {
        options.keepAll = inspecting;
        r.executor.setOptions(options);
    }
    fg::FrameGraph& graph = r.executor.beginFrame();
    r.images = recordFrame(graph,
                           {r.surfaces, r.lights, r.media, r.blended, r.environment, r.plugins,
                            r.drawer, r.gbufferSettings, r.surfaceLightSettings, r.postSettings},
                           r.order);
    r.inspected = {};
    if (inspecting) {
        const fg::TextureHandle resource = r.executor.findTexture(request.inspect);
        if (resource && !fg::isIntegerFormat(graph.desc(resource).format))
            r.inspected =
                addInspectPass(graph, resource, request.width, request.height, r.inspectSettings);
    }
    for (fg::TextureHandle output :
         {r.images.beauty, r.images.display, r.inspected, r.images.gbuffer.depth,
          r.images.gbuffer.normal, r.images.gbuffer.base, r.images.transmittance})
        if (output && !graph.isAbsent(output)) graph.markOutput(output);
    if (request.separateTerms)
        for (uint32_t i = 0; i < r.images.terms.count; ++i)
            graph.markOutput(r.images.terms.images[i].image);
    for (const StatisticsBuffer& statistics : r.images.statistics)
        graph.markOutput(statistics.values);
    if (Result<void> done = r.executor.execute(); !done) return done.error();

    FrameResult result;
    result.plan = *plan;
    r.order.plan = nullptr;
    if (request.converge) {
        if (r.average.shouldMeasure(r.convergeSettings))
            r.average.measure(r.executor.readImage(r.images.beauty));
        result.accumulatedFrames = r.average.frames();
        result.estimatedError = r.average.estimatedError();
        result.converged = result.estimatedError <= double(r.convergeSettings.relmse) ||
                           result.accumulatedFrames >= uint32_t(r.convergeSettings.maximumFrames);
    }
    return result;
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
