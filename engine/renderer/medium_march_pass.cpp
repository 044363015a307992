#include "renderer/medium_march_pass.h"

namespace tyndall {
namespace {

struct MarchData {
    ViewResources view;
    LightResources lights;
    MediaResources media;
    fg::TextureHandle depth;
    MediumMarch coarse, result; // `coarse` is read when upsampling
    gpu::MarchParams params;
};

gpu::MarchParams makeParams(const MediumMarchInputs& inputs, const MediaSettings& settings,
                            bool inScatter, bool emission) {
    gpu::MarchParams params = marchParams(settings);
    params.lightCount = inputs.lights.lightCount;
    params.flags |= (inScatter ? gpu::kMarchInScatter : 0u) | (emission ? gpu::kMarchEmission : 0u);
    return params;
}

void declare(fg::Builder& builder, MarchData& data, const MediaFrame& frame,
             const MediumMarchInputs& inputs, const gpu::MarchParams& params) {
    data.view = inputs.view;
    if (params.flags & gpu::kMarchInScatter) data.lights = readLights(builder, inputs.lights);
    data.media = readMedia(builder, frame.resources);
    data.depth = builder.read(inputs.depth);
    data.params = params;
}

MediumMarch createImages(fg::Builder& builder, const char* const (&names)[3], int width, int height,
                         uint32_t flags) {
    const fg::TextureDesc desc = fg::texture2D(fg::Format::RGBA32F, width, height);
    MediumMarch images;
    images.transmittance = builder.create(names[0], desc);
    if (flags & gpu::kMarchInScatter) images.inScatter = builder.create(names[1], desc);
    if (flags & gpu::kMarchEmission) images.emission = builder.create(names[2], desc);
    return images;
}

constexpr uint32_t kFewLights = 16; // up to so many, a list for each tile costs more than it saves

void record(const MarchData& data, fg::PassContext& context, bool upsample) {
    const bool inScatter = bool(data.result.inScatter), emission = bool(data.result.emission);
    const bool lists = inScatter && !upsample && data.lights.sceneLightCount > kFewLights;
    // Upsampling marches few pixels: it is not specialised on shadows.
    const bool soft = inScatter && (data.lights.softShadows || lists || upsample);
    auto command = context.compute(upsample ? "media/upsample.comp" : "media/march.comp",
                                   {{"PHASE_GROUPS", int32_t(data.media.phaseGroups)},
                                    {"IN_SCATTER", lists ? 2 : int32_t(inScatter)},
                                    {"EMISSION", emission},
                                    {"MEDIA_KINDS", mediaKinds(data.media, inScatter)},
                                    {"SOFT_SHADOWS", soft}});
    bindView(command, data.view);
    if (inScatter) bindLights(command, data.lights);
    bindMedia(command, data.media);
    command.params(data.params)
        .bind("depth", data.depth)
        .bind("transmittance", data.result.transmittance);
    if (inScatter) command.bind("inScatter", data.result.inScatter);
    if (emission) command.bind("emission", data.result.emission);
    if (data.coarse.transmittance) {
        command.bind("coarseTransmittance", data.coarse.transmittance);
        if (inScatter) command.bind("coarseInScatter", data.coarse.inScatter);
        if (emission) command.bind("coarseEmission", data.coarse.emission);
    }
    command.dispatchOver(data.result.transmittance);
}

MediumMarch addTransmittancePass(fg::FrameGraph& graph, const MediaFrame& frame,
                                 const MediumMarchInputs& inputs) {
    struct Data {
        ViewResources view;
        MediaResources media;
        fg::TextureHandle depth, transmittance;
    };
    const Data& pass = graph.addPass<Data>(
        "media.transmittance",
        [&](fg::Builder& builder, Data& data) {
            data.view = inputs.view;
            data.media = readMedia(builder, frame.resources);
            data.depth = builder.read(inputs.depth);
            data.transmittance = builder.create(
                "media.transmittance",
                fg::texture2D(fg::Format::RGBA32F, inputs.view.width, inputs.view.height));
        },
        [](const Data& data, fg::PassContext& context) {
            auto command = context.compute("media/transmittance.comp");
            bindView(command, data.view);
            bindMedia(command, data.media);
            command.bind("depth", data.depth)
                .bind("transmittance", data.transmittance)
                .dispatchOver(data.transmittance);
        });
    return {pass.transmittance, {}, {}};
}

MediumMarch addUpsamplePass(fg::FrameGraph& graph, const MediaFrame& frame,
                            const MediumMarchInputs& inputs, const MediumMarch& coarse,
                            const gpu::MarchParams& params) {
    return graph
        .addPass<MarchData>(
            "media.upsample",
            [&](fg::Builder& builder, MarchData& data) {
                declare(builder, data, frame, inputs, params);
                data.coarse.transmittance = builder.read(coarse.transmittance);
                if (coarse.inScatter) data.coarse.inScatter = builder.read(coarse.inScatter);
                if (coarse.emission) data.coarse.emission = builder.read(coarse.emission);
                data.result =
                    createImages(builder, {"media.transmittance", "term.LVE", "media.emission"},
                                 inputs.view.width, inputs.view.height, params.flags);
            },
            [](const MarchData& data, fg::PassContext& context) { record(data, context, true); })
        .result;
}

} // namespace

gpu::MarchParams marchParams(const MediaSettings& settings) {
    gpu::MarchParams params{};
    params.flags = settings.refine ? gpu::kMarchRefine : 0u;
    params.factor = 1u << uint32_t(settings.resolution);
    params.depthTolerance = settings.depthTolerance;
    params.transmittanceTolerance = settings.transmittanceTolerance;
    params.refineWeight = settings.refineWeight;
    return params;
}

MediumMarch addMediumMarchPass(fg::FrameGraph& graph, const MediaFrame& frame,
                               const MediumMarchInputs& inputs) {
    const bool inScatter = inputs.inScatter && frame.scatters && inputs.lights.lightCount > 0;
    const bool emission = inputs.emission && frame.emits;
    const char* skip = frame.marchSkipReason;
    // Without light to gather, transmittance alone needs no march.
    if (!skip && !inScatter && !emission)
        skip = !inputs.inScatter && !inputs.emission ? "no term is wanted that media add light to"
               : frame.scatters
                   ? "media add no light: LVE is not wanted or there is no light in the scene"
                   : "no medium in view scatters or emits";
    const gpu::MarchParams params = makeParams(inputs, *frame.settings, inScatter, emission);
    const int factor = int(params.factor);
    const MediumMarch march =
        graph
            .addPass<MarchData>(
                "media.march",
                [&](fg::Builder& builder, MarchData& data) {
                    if (skip) return builder.skip(skip);
                    declare(builder, data, frame, inputs, params);
                    const int width = (inputs.view.width + factor - 1) / factor,
                              height = (inputs.view.height + factor - 1) / factor;
                    data.result =
                        factor == 1
                            ? createImages(builder,
                                           {"media.transmittance", "term.LVE", "media.emission"},
                                           width, height, params.flags)
                            : createImages(builder,
                                           {"media.coarse.transmittance", "media.coarse.inScatter",
                                            "media.coarse.emission"},
                                           width, height, params.flags);
                },
                [](const MarchData& data, fg::PassContext& context) {
                    record(data, context, false);
                })
            .result;
    if (frame.marchSkipReason) return {};
    if (skip) return addTransmittancePass(graph, frame, inputs);
    return factor == 1 ? march : addUpsamplePass(graph, frame, inputs, march, params);
}

} // namespace tyndall
