#include "volumetric_gi/surfels/surfel_media.h"

namespace tyndall::volumetric_gi {
namespace {

struct SplatData {
    ViewResources view;
    MediaResources media;
    SurfelIntervals map;
    SplatList list;
    TracedBuffers traced;
    fg::TextureHandle levels;
    uint32_t phaseGroups;
    int32_t rays, kinds;
};

/// What filters one level after the other.
struct CollectData {
    ViewResources view;
    SurfelIntervals map;
    fg::BufferHandle interleave;
    fg::TextureHandle depth, levels, coarser, collected;
    gpu::SurfelCollectParams params;
};

fg::TextureHandle addCollect(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                             const SplatRequest& request, const SurfelIntervals& map, fg::TextureHandle levels,
                             fg::TextureHandle coarser, const gpu::SurfelCollectParams& params) {
    return graph
        .addPass<CollectData>(
            "gi.surfels.collect",
            [&](fg::Builder& builder, CollectData& data) {
                data.view = inputs.view;
                data.map = readIntervals(builder, map);
                data.interleave = builder.read(request.interleave);
                data.depth = builder.read(inputs.gbuffer.depth);
                data.levels = builder.read(levels);
                if (coarser) data.coarser = builder.read(coarser);
                data.params = params;
                data.collected = builder.create(
                    "gi.surfels.collected",
                    fg::texture2D(fg::Format::RGBA32F, params.size.x, params.size.y));
            },
            [](const CollectData& data, fg::PassContext& context) {
                auto command = context.compute("gi/surfels/collect.comp");
                bindIntervals(bindView(command, data.view), data.map)
                    .params(data.map.march)
                    .params(data.params, "Collect")
                    .bind("Interleave", data.interleave)
                    .bind("depth", data.depth)
                    .bind("levels", data.levels)
                    // The shader does not read it where there is none, but the binding must be valid.
                    .bind("coarser", data.coarser ? data.coarser : data.map.ways)
                    .bind("collected", data.collected)
                    .dispatchOver(data.collected);
            })
        .collected;
}

fg::TextureHandle addUpsample(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                              const SurfelIntervals& map, fg::TextureHandle rays) {
    struct Data {
        ViewResources view;
        fg::TextureHandle depth, transmittance, before, light;
        gpu::MarchParams params;
    };
    return graph
        .addPass<Data>(
            "gi.surfels.upsample",
            [&](fg::Builder& builder, Data& data) {
                data.view = inputs.view;
                data.depth = builder.read(inputs.gbuffer.depth);
                data.transmittance = builder.read(inputs.transmittance);
                data.before = builder.read(rays);
                data.params = map.march;
                data.params.flags &= ~gpu::kMarchRefine; // there is no ray of a pixel's own
                data.light = builder.create(
                    "gi.surfels.inScatter",
                    fg::texture2D(fg::Format::RGBA32F, inputs.view.width, inputs.view.height));
            },
            [](const Data& data, fg::PassContext& context) {
                auto command = context.compute("gi/surfels/upsample.comp");
                bindView(command, data.view)
                    .params(data.params)
                    .bind("depth", data.depth)
                    .bind("transmittance", data.transmittance)
                    .bind("before", data.before)
                    .bind("inScatter", data.light)
                    .dispatchOver(data.light);
            })
        .light;
}

} // namespace

fg::TextureHandle addMediaSplats(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                 const SplatRequest& request, const SurfelIntervals& map,
                                 const SplatList& list) {
    return graph
        .addPass<SplatData>(
            "gi.surfels.splat",
            [&](fg::Builder& builder, SplatData& data) {
                data.view = inputs.view;
                data.media = readMedia(builder, inputs.media);
                data.map = readIntervals(builder, map);
                data.list = readSplatList(builder, list);
                data.rays = int32_t(request.rays);
                const bool grids = (inputs.media.kinds & gpu::kMediaGrids) != 0;
                data.kinds = int32_t(gpu::kMediaShapes |
                                     (grids && !request.paper ? gpu::kMediaGrids : 0u));
                data.phaseGroups = request.paper ? 1 : inputs.media.phaseGroups;
                const bool sees = list.params.visibility != 0;
                // Nothing to ask: closed forms are had without rays.
                if (!sees && (!grids || !request.attenuation)) data.rays = 0;
                if (data.rays != 0) data.traced = readTraced(builder, request.traced);
                if (!sees) data.traced.params.treeSize = 0;
                data.levels = builder.create("gi.surfels.levels", splatLevels(list),
                                             fg::Access::ColorTarget);
            },
            [](const SplatData& data, fg::PassContext& context) {
                drawSplats(context, data.list, data.levels, [&] {
                    auto command = context.raster(
                        {.vertex = "gi/surfels/splat.vert", .fragment = "gi/surfels/splat.frag"},
                        {{"PHASE_GROUPS", int32_t(data.phaseGroups)},
                         {"MEDIA_KINDS", data.kinds},
                         {"RAYS", data.rays},
                         {"PAPER", data.list.params.mode == gpu::kSurfelEncodingPaper}});
                    bindMedia(bindView(command, data.view), data.media);
                    if (data.rays != 0) bindTraced(command, data.traced);
                    bindIntervals(command, data.map)
                        .params(data.map.march)
                        .bind("shares", data.map.shares);
                    return command;
                });
            })
        .levels;
}

fg::TextureHandle addMediaCollect(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                  const SplatRequest& request, const SurfelIntervals& map,
                                  fg::TextureHandle levels) {
    const fg::TextureHandle rays = addCollectSteps(
        request, [&](const gpu::SurfelCollectParams& params, fg::TextureHandle coarser) {
            return addCollect(graph, inputs, request, map, levels, coarser, params);
        });
    return request.factor == 1 ? rays : addUpsample(graph, inputs, map, rays);
}

} // namespace tyndall::volumetric_gi
