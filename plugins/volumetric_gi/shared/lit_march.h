#pragma once
// A march along eye rays through media that gathers the scene's lights with their shadows: all that a technique without a data structure of its own needs.

#include "plugin/plugin_api.h"
#include "plugin/reduced_march.h"

namespace tyndall::volumetric_gi {

/// Literals.
struct LitMarchNames {
    const char* pass;   // "gi.octaves.march"
    const char* image;  // "gi.octaves.inScatter"
    const char* shader; // "gi/octaves/march.comp": includes gi/shared/march.glsl and media/march.glsl
};

/// Adds one ray for each pixel. View-sized RGBA32F nits that reach the eye. `technique`: the shader's uniform block `Technique`. Skipped where there is no
/// medium or no light, and for `reason`, where that is not null.
template <typename Params>
fg::TextureHandle addLitMarch(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                              const LitMarchNames& names, const Params& technique,
                              const char* reason = nullptr) {
    struct Data {
        LightMarch march;
        LightResources lights;
        Params technique;
        const char* shader;
    };
    return graph
        .addPass<Data>(
            names.pass,
            [&](fg::Builder& builder, Data& data) {
                if (inputs.media.count == 0) return builder.skip("no medium in the scene");
                if (reason) return builder.skip(reason);
                if (inputs.lights.lightCount == 0) return builder.skip("no light in the scene");
                gpu::MarchParams params = inputs.march;
                params.factor = 1;
                params.lightCount = inputs.lights.lightCount;
                const MarchPass pass = readMarch(builder, MarchStage::Squares, inputs.view,
                                                 inputs.media, inputs.gbuffer.depth, params);
                data.march =
                    declareLightMarch(builder, pass, {}, {}, {names.pass, names.pass, names.pass,
                                                               names.image, names.image});
                data.lights = readLights(builder, inputs.lights);
                data.technique = technique;
                data.shader = names.shader;
            },
            [](const Data& data, fg::PassContext& context) {
                const MediaResources& media = data.march.pass.media;
                marchInTurns(data.march.pass, context, [&](const gpu::MarchParams& params) {
                    auto command =
                        context.compute(data.shader, {{"PHASE_GROUPS", int32_t(media.phaseGroups)},
                                                      {"MEDIA_KINDS", mediaKinds(media, true)},
                                                      {"SOFT_SHADOWS", data.lights.softShadows}});
                    bindMedia(bindLights(command, data.lights), media);
                    command.params(data.technique, "Technique");
                    bindLightMarch(command, data.march, params).dispatchOver(data.march.light);
                });
            })
        .march.light;
}

} // namespace tyndall::volumetric_gi
