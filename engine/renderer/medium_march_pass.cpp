#include "renderer/medium_march_pass.h"

#include "plugin/reduced_march.h"
#include "renderer/march_smoothing_pass.h"

namespace tyndall {
namespace {

struct MarchData {
    MarchPass march;
    LightResources lights;
    MediumMarch before, result; // before: of rays for squares, when upsampling
};

gpu::MarchParams makeParams(const MediumMarchInputs& inputs, const MediaSettings& settings,
                            bool inScatter, bool emission) {
    gpu::MarchParams params = marchParams(settings);
    params.lightCount = inputs.lights.lightCount;
    params.flags |= (inScatter ? gpu::kMarchInScatter : 0u) | (emission ? gpu::kMarchEmission : 0u);
    return params;
}

MediumMarch readImages(fg::Builder& builder, const MediumMarch& images) {
    MediumMarch read{builder.read(images.transmittance), {}, {}};
    if (images.inScatter) read.inScatter = builder.read(images.inScatter);
    if (images.emission) read.emission = builder.read(images.emission);
    return read;
}

MediumMarch createImages(fg::Builder& builder, const MarchPass& march) {
    const bool rays = march.stage == MarchStage::Squares && march.params.factor > 1;
    const fg::TextureDesc desc = marchPicture(march);
    const uint32_t flags = march.params.flags;
    MediumMarch images;
    images.transmittance =
        builder.create(rays ? "media.coarse.transmittance" : "media.transmittance", desc);
    if (flags & gpu::kMarchInScatter)
        images.inScatter = builder.create(rays ? "media.coarse.inScatter" : "term.LVE", desc);
    if (flags & gpu::kMarchEmission)
        images.emission = builder.create(rays ? "media.coarse.emission" : "media.emission", desc);
    return images;
}

constexpr uint32_t kFewLights = 16; // up to so many, a list for each tile costs more than it saves

void record(const MarchData& data, fg::PassContext& context) {
    const MediaResources& media = data.march.media;
    const bool upsample = data.march.stage == MarchStage::Spread;
    const bool inScatter = bool(data.result.inScatter), emission = bool(data.result.emission);
    const bool lists = inScatter && !upsample && data.lights.sceneLightCount > kFewLights;
    // Upsampling marches few pixels: it is not specialised on shadows.
    const bool soft = inScatter && (data.lights.softShadows || lists || upsample);
    marchInTurns(data.march, context, [&](const gpu::MarchParams& params) {
        auto command = context.compute(upsample ? "media/upsample.comp" : "media/march.comp",
                                       {{"PHASE_GROUPS", int32_t(media.phaseGroups)},
                                        {"IN_SCATTER", lists ? 2 : int32_t(inScatter)},
                                        {"EMISSION", emission},
                                        {"MEDIA_KINDS", mediaKinds(media, inScatter)},
                                        {"SOFT_SHADOWS", soft}});
        if (inScatter) bindLights(command, data.lights);
        bindMedia(command, media);
        bindMarch(command, data.march, params).bind("transmittance", data.result.transmittance);
        if (inScatter) command.bind("inScatter", data.result.inScatter);
        if (emission) command.bind("emission", data.result.emission);
        if (data.before) {
            command.bind("coarseTransmittance", data.before.transmittance);
            if (inScatter) command.bind("coarseInScatter", data.before.inScatter);
            if (emission) command.bind("coarseEmission", data.before.emission);
        }
        command.dispatchOver(data.result.transmittance);
    });
}

/// `skip`: why there is nothing to march; null: there is.
MediumMarch addStage(fg::FrameGraph& graph, const MediaFrame& frame,
                     const MediumMarchInputs& inputs, const gpu::MarchParams& params,
                     const char* skip, MarchStage stage, const MediumMarch& before) {
    return graph
        .addPass<MarchData>(
            stage == MarchStage::Spread ? "media.upsample" : "media.march",
            [&](fg::Builder& builder, MarchData& data) {
                if (skip) return builder.skip(skip);
                data.march =
                    readMarch(builder, stage, inputs.view, frame.resources, inputs.depth, params);
                if (params.flags & gpu::kMarchInScatter)
                    data.lights = readLights(builder, inputs.lights);
                if (before) data.before = readImages(builder, before);
                data.result = createImages(builder, data.march);
            },
            [](const MarchData& data, fg::PassContext& context) { record(data, context); })
        .result;
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

} // namespace

gpu::MarchParams marchParams(const MediaSettings& settings) {
    gpu::MarchParams params{};
    params.endSegment = gpu::kMarchAllSegments;
    params.flags =
        (settings.refine ? gpu::kMarchRefine : 0u) | (settings.smooth ? gpu::kMarchSmooth : 0u);
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
    const MediumMarch march = addMarchStages<MediumMarch>(
        int(params.factor), false, [&](MarchStage stage, const MediumMarch& before) {
            MediumMarch images = addStage(graph, frame, inputs, params, skip, stage, before);
            // Grids have detail of their own, and no pattern.
            const bool fog = (frame.resources.kinds & gpu::kMediaShapes) != 0;
            if (!skip && inScatter && fog && stage == MarchStage::Squares)
                images.inScatter =
                    addMarchSmoothingPass(graph, inputs.view, params,
                                          {inputs.depth, images.transmittance, images.inScatter});
            return images;
        });
    if (!skip) return march;
    return frame.marchSkipReason ? MediumMarch{} : addTransmittancePass(graph, frame, inputs);
}

} // namespace tyndall
