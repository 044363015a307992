#include "renderer/deferred_lighting_pass.h"

namespace tyndall {
namespace {

bool hasEnvironment(const SurfaceLightInputs& inputs) {
    return inputs.environment && !inputs.environment->black();
}

fg::TextureHandle addEmissionPass(fg::FrameGraph& graph, const SurfaceLightInputs& inputs) {
    struct Data {
        ViewResources view;
        EnvironmentResources environment;
        fg::TextureHandle depth, emissive, emission;
    };
    const bool wanted = (inputs.terms & bit(Term::LE)) != 0;
    const Data& pass = graph.addPass<Data>(
        "lighting.emission",
        [&](fg::Builder& builder, Data& data) {
            data.emission = builder.create(
                "lighting.emission",
                fg::texture2D(fg::Format::RGBA32F, inputs.view.width, inputs.view.height));
            if (!wanted) return builder.skip("the term LE is not rendered");
            if (!hasEnvironment(inputs)) return builder.skip("the environment is black");
            data.view = inputs.view;
            data.environment = inputs.environment->resources();
            data.depth = builder.read(inputs.gbuffer.depth);
            data.emissive = builder.read(inputs.gbuffer.emissive);
        },
        [](const Data& data, fg::PassContext& context) {
            auto command = context.compute("lighting/emission.comp");
            bindView(command, data.view);
            bindEnvironment(command, data.environment);
            command.bind("gbufferDepth", data.depth)
                .bind("gbufferEmissive", data.emissive)
                .bind("surfaceEmission", data.emission)
                .dispatchOver(data.emission);
        });
    return wanted && !hasEnvironment(inputs) ? inputs.gbuffer.emissive : pass.emission;
}

/// Why there is no direct light on surfaces; null where there is.
const char* whyNoDirectLight(const SurfaceLightInputs& inputs) {
    if ((inputs.terms & bit(Term::LSE)) == 0) return "the term LSE is not rendered";
    if (!inputs.hasSurfaces) return "no surface in the scene";
    if (inputs.lights.lightCount == 0 && !hasEnvironment(inputs)) return "no light in the scene";
    return nullptr;
}

fg::TextureHandle addDirectPass(fg::FrameGraph& graph, const SurfaceLightInputs& inputs) {
    struct Data {
        ViewResources view;
        GBuffer gbuffer;
        LightResources lights;
        MediaResources media;
        EnvironmentResources environment;
        gpu::SurfaceLightParams params;
        int32_t environmentMap;
        fg::TextureHandle direct;
    };
    return graph
        .addPass<Data>(
            "lighting.direct",
            [&](fg::Builder& builder, Data& data) {
                data.direct = builder.create(
                    "lighting.direct",
                    fg::texture2D(fg::Format::RGBA32F, inputs.view.width, inputs.view.height));
                if (const char* reason = whyNoDirectLight(inputs)) return builder.skip(reason);
                data.view = inputs.view;
                data.gbuffer = readGBuffer(builder, inputs.gbuffer);
                data.lights = readLights(builder, inputs.lights);
                if (inputs.media.count > 0) data.media = readMedia(builder, inputs.media);
                data.environmentMap =
                    hasEnvironment(inputs) && inputs.settings.environmentSamples > 0;
                if (data.environmentMap) data.environment = inputs.environment->resources();
                data.params = surfaceLightParams(
                    inputs.settings, (inputs.view.data.flags & gpu::kViewConverge) != 0);
            },
            [](const Data& data, fg::PassContext& context) {
                auto command = context.compute(
                    "lighting/deferred_lighting.comp",
                    {{"MEDIA", data.media.count > 0},
                     {"MEDIA_KINDS", surfaceMediaKinds(data.media)},
                     {"SOFT_SHADOWS", data.lights.softShadows},
                     {"ENVIRONMENT", data.environmentMap}});
                bindView(command, data.view);
                bindLightLists(bindLights(command, data.lights), data.lights);
                if (data.media.count > 0) bindMedia(command, data.media);
                if (data.environmentMap) bindEnvironment(command, data.environment);
                bindGBuffer(command, data.gbuffer)
                    .params(data.params, "Surfaces")
                    .bind("surfaceDirect", data.direct)
                    .dispatchOver(data.direct);
            })
        .direct;
}

} // namespace

SurfaceLight addDeferredLightingPass(fg::FrameGraph& graph, const SurfaceLightInputs& inputs) {
    SurfaceLight light;
    light.emission = addEmissionPass(graph, inputs);
    light.direct = addDirectPass(graph, inputs);
    return light;
}

} // namespace tyndall
