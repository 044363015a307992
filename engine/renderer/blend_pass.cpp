#include "renderer/blend_pass.h"

#include "renderer/gbuffer_pass.h"
#include "shared/march.h"

namespace tyndall {
namespace {

/// What every draw of blended surfaces needs.
struct BlendCommon {
    const BlendList* list;
    ViewResources view;
    fg::TextureHandle depth;
    MediaResources media;
    gpu::BlendParams params;
    float textureLodBias;
};

struct ShadeData {
    BlendCommon common;
    LightResources lights;
    EnvironmentResources environment;
    int32_t environmentMap;
    gpu::SurfaceLightParams surfaceLight;
    fg::TextureHandle emission, direct, inScatter; // inScatter: only with media
};

struct AttenuateData {
    BlendCommon common;
    fg::TextureHandle transmittance, image;
};

BlendCommon readCommon(fg::Builder& builder, const BlendList& list, const BlendInputs& inputs) {
    BlendCommon common{};
    common.list = &list;
    common.view = inputs.view;
    common.textureLodBias = inputs.textureLodBias;
    common.depth = builder.read(inputs.depth, fg::Access::DepthRead);
    if (inputs.media.count > 0) common.media = readMedia(builder, inputs.media);
    return common;
}

fg::RasterState stateOf(fg::Topology topology) {
    fg::RasterState state;
    state.cull = fg::CullMode::
        None; // the shader drops back faces, since mirrored objects are drawn with the others
    state.blend = fg::BlendMode::Premultiplied;
    state.depth = fg::DepthMode::Test;
    state.compare = fg::CompareMode::Greater;
    state.topology = topology;
    return state;
}

void drawRuns(const BlendCommon& common, fg::RasterCommand& command, fg::PassContext& context) {
    const GpuScene& scene = common.list->scene();
    command.viewport(0, 0, common.view.width, common.view.height);
    bindView(command, common.view);
    if (common.media.count > 0) bindMedia(command, common.media);
    command.bind("Objects", scene.objects())
        .bind("Materials", scene.materials())
        .bind("BlendVertices", common.list->vertices())
        .bind("BlendOrder", common.list->order())
        .params(common.params, "Blend")
        .set("textureLodBias", common.textureLodBias);
    for (const BlendRun& run : common.list->runs()) {
        command.state(stateOf(run.topology))
            .set("isTriangle", run.topology == fg::Topology::Triangles ? 1 : 0);
        bindMaterial(context, scene.textures(run.material));
        command.draw(run.entryCount, 1, run.firstEntry);
    }
}

/// The image to draw on: `image`, or one that nobody reads where the term is not rendered (the shader has all outputs).
fg::TextureHandle target(fg::Builder& builder, fg::TextureHandle image, const char* unusedName,
                         const ViewResources& view) {
    if (image) return builder.write(image, fg::Access::ColorTarget);
    return builder.create(unusedName, fg::texture2D(fg::Format::RGBA32F, view.width, view.height),
                          fg::Access::ColorTarget);
}

void executeShade(const ShadeData& data, fg::PassContext& context) {
    const bool media = data.common.media.count > 0;
    auto command =
        context.raster("lighting/blend.vert", "lighting/blend.frag",
                       {{"MEDIA", media},
                        {"PHASE_GROUPS", media ? int32_t(data.common.media.phaseGroups) : 1},
                        {"ENVIRONMENT", data.environmentMap}});
    const fg::Target depth{data.common.depth, 0, 0}, emission{data.emission, 0, 0},
        direct{data.direct, 0, 0};
    if (media)
        command.colors({emission, direct, fg::Target{data.inScatter, 0, 0}}, &depth);
    else
        command.colors({emission, direct}, &depth);
    bindLightLists(bindLights(command, data.lights), data.lights);
    if (data.environmentMap) bindEnvironment(command, data.environment);
    command.params(data.surfaceLight, "Surfaces");
    drawRuns(data.common, command, context);
}

void executeAttenuate(const AttenuateData& data, fg::PassContext& context) {
    const bool media = data.common.media.count > 0;
    auto command =
        context.raster("lighting/blend.vert", "lighting/blend_attenuate.frag", {{"MEDIA", media}});
    const fg::Target depth{data.common.depth, 0, 0};
    command.colors({fg::Target{data.image, 0, 0}}, &depth);
    if (media) command.bind("transmittance", data.transmittance);
    drawRuns(data.common, command, context);
}

void addShadePass(fg::FrameGraph& graph, const BlendList& list, const BlendInputs& inputs,
                  const char* reason, TermImages& images) {
    const fg::TextureHandle emission = images.find(Term::LE), direct = images.find(Term::LSE),
                            inScatter = images.find(Term::LVE);
    if (!reason && !emission && !direct && !inScatter)
        reason = "no term of direct light is rendered";
    const ShadeData& pass = graph.addPass<ShadeData>(
        "blend",
        [&](fg::Builder& builder, ShadeData& data) {
            if (reason) return builder.skip(reason);
            data.common = readCommon(builder, list, inputs);
            data.lights = readLights(builder, inputs.lights);
            data.environmentMap = inputs.environment && !inputs.environment->black() &&
                                  inputs.settings.environmentSamples > 0;
            if (data.environmentMap) data.environment = inputs.environment->resources();
            data.surfaceLight = surfaceLightParams(
                inputs.settings, (inputs.view.data.flags & gpu::kViewConverge) != 0);
            data.common.params.marchFlags =
                (inScatter ? gpu::kMarchInScatter : 0u) | (emission ? gpu::kMarchEmission : 0u);
            data.common.params.lightCount = inputs.lights.lightCount;
            data.common.params.direct = direct ? 1u : 0u;
            data.emission = target(builder, emission, "blend.unusedEmission", inputs.view);
            data.direct = target(builder, direct, "blend.unusedDirect", inputs.view);
            if (inputs.media.count > 0)
                data.inScatter = target(builder, inScatter, "blend.unusedInScatter", inputs.view);
        },
        [](const ShadeData& data, fg::PassContext& context) { executeShade(data, context); });
    if (reason) return;
    if (emission) images.replace(Term::LE, pass.emission);
    if (direct) images.replace(Term::LSE, pass.direct);
    if (inScatter && inputs.media.count > 0) images.replace(Term::LVE, pass.inScatter);
}

void addAttenuatePass(fg::FrameGraph& graph, const BlendList& list, BlendInputs inputs,
                      TermImageHandle& image) {
    // Media that are only on the lights' ways take nothing from the ray.
    if (!inputs.transmittance || graph.isAbsent(inputs.transmittance)) inputs.media.count = 0;
    const AttenuateData& pass = graph.addPass<AttenuateData>(
        "blend.indirect",
        [&](fg::Builder& builder, AttenuateData& data) {
            data.common = readCommon(builder, list, inputs);
            data.common.params.inMedia = (image.terms & kIndirectInMedia) != 0 ? 1u : 0u;
            if (inputs.media.count > 0) data.transmittance = builder.read(inputs.transmittance);
            data.image = builder.write(image.image, fg::Access::ColorTarget);
        },
        [](const AttenuateData& data, fg::PassContext& context) {
            executeAttenuate(data, context);
        });
    image.image = pass.image;
}

} // namespace

TermImages addBlendPass(fg::FrameGraph& graph, const BlendList& list, const BlendInputs& inputs,
                        const TermImages& images) {
    TermImages result = images;
    const char* reason = !list.any()           ? "no blended surface in the scene"
                         : list.runs().empty() ? "no blended surface in view"
                                               : nullptr;
    addShadePass(graph, list, inputs, reason, result);
    if (reason) return result;
    for (uint32_t i = 0; i < result.count; ++i)
        if ((result.images[i].terms & kDirectTerms) == 0)
            addAttenuatePass(graph, list, inputs, result.images[i]);
    return result;
}

} // namespace tyndall
