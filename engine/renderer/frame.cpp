#include "renderer/frame.h"

#include <array>
#include <string>

#include "renderer/optical_depth_pass.h"

namespace tyndall {
namespace {

TermSet directTerms(const FrameOrder& order) { return order.plan->termsOf(kDirectPasses); }

SurfaceLight addSurfaceLight(fg::FrameGraph& graph, const FrameParts& parts,
                             const FrameOrder& order, const GBuffer& gbuffer,
                             const LightResources& lights, const MediaResources& media) {
    SurfaceLightInputs inputs;
    inputs.view = order.view;
    inputs.gbuffer = gbuffer;
    inputs.lights = lights;
    inputs.media = media;
    inputs.environment = &parts.environment;
    inputs.hasSurfaces = !parts.surfaces.items().empty();
    inputs.terms = directTerms(order);
    inputs.settings = parts.surfaceLightSettings;
    return addDeferredLightingPass(graph, inputs);
}

MediumMarch addMarch(fg::FrameGraph& graph, const FrameOrder& order, const MediaFrame& media,
                     fg::TextureHandle depth, const LightResources& lights) {
    MediumMarchInputs inputs;
    inputs.view = order.view;
    inputs.depth = depth;
    inputs.lights = lights;
    inputs.inScatter = directTerms(order) & bit(Term::LVE);
    inputs.emission = directTerms(order) & bit(Term::LE);
    return addMediumMarchPass(graph, media, inputs);
}

bool holds(const fg::FrameGraph& graph, fg::TextureHandle image) {
    return image && !graph.isAbsent(image);
}

/// The engine's own terms, as they reach the eye.
TermImages addDirectTerms(fg::FrameGraph& graph, const SurfaceLight& surfaces,
                          const MediumMarch& march) {
    TermImages images;
    if (holds(graph, surfaces.emission))
        images.add(bit(Term::LE),
                   addCompositePass(graph, "composite.LE", "term.LE", surfaces.emission,
                                    march.transmittance, march.emission));
    if (holds(graph, surfaces.direct))
        images.add(bit(Term::LSE), addCompositePass(graph, "composite.LSE", "term.LSE",
                                                    surfaces.direct, march.transmittance));
    if (holds(graph, march.inScatter)) images.add(bit(Term::LVE), march.inScatter);
    return images;
}

void keepStatistics(const plugin::FrameOutputs& outputs, FrameImages& frame) {
    if (!outputs.statistics) return;
    StatisticsBuffer statistics{outputs.statistics, {}};
    for (uint32_t k = 0; k < outputs.statisticCount; ++k)
        statistics.elements.emplace_back(outputs.statistic[k].name, outputs.statistic[k].element);
    frame.statistics.push_back(std::move(statistics));
}

/// What the plan gives a technique; no terms where it is not needed.
plugin::FrameInputs inputsFor(const FrameOrder& order, int technique, plugin::FrameInputs inputs) {
    inputs.terms = order.plan->termsOf(technique);
    inputs.kinds = order.plan->mediaOf(technique);
    inputs.march.media = inputs.kinds;
    return inputs;
}

/// Each technique computes the terms that the plan gives it.
void addTechniques(fg::FrameGraph& graph, const FrameParts& parts, const FrameOrder& order,
                   const plugin::FrameInputs& all, FrameImages& frame) {
    const auto techniques = parts.plugins.techniques();
    for (size_t i = 0; i < techniques.size(); ++i) {
        const plugin::FrameInputs inputs = inputsFor(order, int(i), all);
        if (inputs.terms == 0) continue;
        const plugin::FrameOutputs outputs = techniques[i].technique->addPasses(graph, inputs);
        if (holds(graph, outputs.onSurfaces))
            frame.terms.add(inputs.terms & kIndirectOnSurfaces,
                            addCompositePass(graph, "composite.indirect", "term.indirectOnSurfaces",
                                             outputs.onSurfaces, frame.transmittance),
                            int(i));
        if (holds(graph, outputs.inMedia))
            frame.terms.add(inputs.terms & ~kIndirectOnSurfaces, outputs.inMedia, int(i));
        keepStatistics(outputs, frame);
    }
}

/// Techniques show what they work with; plugins change the finished picture.
fg::TextureHandle addPostEffects(fg::FrameGraph& graph, const FrameParts& parts,
                                 const FrameOrder& order, const plugin::FrameInputs& inputs,
                                 fg::TextureHandle color) {
    const auto techniques = parts.plugins.techniques();
    for (size_t i = 0; i < techniques.size(); ++i) {
        const plugin::FrameInputs own = inputsFor(order, int(i), inputs);
        if (own.terms != 0) color = techniques[i].technique->addDebugView(graph, own, color);
    }
    for (size_t i = 0; i < parts.plugins.count(); ++i)
        color = parts.plugins.plugin(i).addPostPasses(graph, inputs, color);
    return color;
}

/// "average.term0" and so on: as long as the program lives.
const char* averageName(uint32_t image) {
    static const auto kNames = [] {
        std::array<std::string, kMaxTermImages> names;
        for (size_t i = 0; i < names.size(); ++i) names[i] = "average.term" + std::to_string(i);
        return names;
    }();
    return kNames[image].c_str();
}

/// Means over the frames so far of the sum and, where they are wanted, of each term.
void addAverages(fg::FrameGraph& graph, const FrameOrder& order, FrameImages& images) {
    images.beauty = addAccumulatePass(graph, "average.beauty", images.beauty, order.averagedFrame);
    if (!order.separateTerms) return;
    for (uint32_t i = 0; i < images.terms.count; ++i)
        images.terms.images[i].image = addAccumulatePass(
            graph, averageName(i), images.terms.images[i].image, order.averagedFrame);
}

} // namespace

FrameImages recordFrame(fg::FrameGraph& graph, const FrameParts& parts, const FrameOrder& order) {
    FrameImages images;

    // What the eye sees, and what lights it.
    images.gbuffer = addGBufferPass(graph, parts.surfaces, order.view, parts.gbufferSettings);
    MediaFrame media = parts.media.beginFrame(
        graph, {&order.view, order.surfaceBounds, parts.lights.lights(), false});
    addOpticalDepthPass(graph, parts.media, media);
    const bool lit = (order.plan->rendered & ~bit(Term::LE)) != 0;
    const LightResources lights = parts.lights.addPasses(graph, parts.surfaces, order.view, lit);

    // Direct light on surfaces and in media.
    const SurfaceLight surfaces =
        addSurfaceLight(graph, parts, order, images.gbuffer, lights, media.resources);
    const MediumMarch march = addMarch(graph, order, media, images.gbuffer.depth, lights);
    images.transmittance = march.transmittance;
    images.terms = addDirectTerms(graph, surfaces, march);

    // Indirect light, as far as techniques compute it.
    plugin::SceneState state = order.sceneState;
    // Only now is it known which media this frame has.
    state.media = media.resources.count > 0 ? parts.media.version() : 0;
    const plugin::FrameInputs inputs{order.view,
                               images.gbuffer,
                               lights,
                               media.resources,
                               march.transmittance,
                               marchParams(*media.settings),
                               state,
                               parts.lights.lights().data(),
                               &parts.drawer,
                               order.scene,
                               {order.renderOrigin.x, order.renderOrigin.y, order.renderOrigin.z},
                               0,
                               0,
                               order.statistics,
                               displayWhite(order.ev100, parts.postSettings),
                               !media.settings->enabled};
    addTechniques(graph, parts, order, inputs, images);

    // Transparent surfaces, then the sum of all terms.
    images.terms = addBlendPass(graph, parts.blended,
                                {order.view, images.gbuffer.depth, march.transmittance, lights,
                                 media.resources, &parts.environment, parts.surfaceLightSettings},
                                images.terms);
    const uint32_t frame = order.averagedFrame > 0 ? order.averagedFrame : order.frameIndex + 1;
    const Sum sum = addSumPass(graph, images.terms, {order.view.width, order.view.height, frame});
    images.beauty = sum.image;
    images.firstInvalid = sum.firstInvalid;
    if (order.averagedFrame > 0) addAverages(graph, order, images);

    // A picture for people.
    const fg::TextureHandle light = images.beauty;
    images.beauty = addPostEffects(graph, parts, order, inputs, light);
    images.beautyMayDependOnExposure = images.beauty != light;
    images.display =
        addTonemapPass(graph, images.beauty, order.ev100, parts.postSettings, order.view.data.seed);
    return images;
}

} // namespace tyndall
