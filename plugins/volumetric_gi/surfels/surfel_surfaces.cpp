#include "volumetric_gi/surfels/surfel_surfaces.h"

namespace tyndall::volumetric_gi {
namespace {

struct SplatData {
    ViewResources view;
    GBuffer gbuffer;
    MediaResources media;
    SplatList list;
    TracedBuffers traced;
    fg::TextureHandle levels;
};

/// What there is to attenuate light: closed forms alone, or grids too.
int32_t kindsOf(const MediaResources& media) {
    if (media.count == 0) return 0;
    return int32_t(gpu::kMediaShapes | (media.kinds & gpu::kMediaGrids));
}

fg::TextureHandle addSplats(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                            const SplatRequest& request, const SplatList& list) {
    return graph
        .addPass<SplatData>(
            "gi.surfels.splatSurfaces",
            [&](fg::Builder& builder, SplatData& data) {
                data.view = inputs.view;
                data.gbuffer = readGBuffer(builder, inputs.gbuffer);
                if (inputs.media.count > 0 && request.attenuation)
                    data.media = readMedia(builder, inputs.media);
                data.list = readSplatList(builder, list);
                if (list.params.visibility != 0) data.traced = readTraced(builder, request.traced);
                data.levels = builder.create("gi.surfels.surfaceLevels", splatLevels(list),
                                             fg::Access::ColorTarget);
            },
            [](const SplatData& data, fg::PassContext& context) {
                drawSplats(context, data.list, data.levels, [&] {
                    auto command = context.raster({.vertex = "gi/surfels/splat.vert",
                                                   .fragment = "gi/surfels/splat_surface.frag"},
                                                  {{"MEDIA", data.media.count > 0},
                                                   {"MEDIA_KINDS", kindsOf(data.media)},
                                                   {"RAYS", bool(data.traced.triangles)}});
                    bindGBuffer(bindView(command, data.view), data.gbuffer);
                    if (data.media.count > 0) bindMedia(command, data.media);
                    if (data.traced.triangles) bindTraced(command, data.traced);
                    return command;
                });
            })
        .levels;
}

fg::TextureHandle addCollect(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                             const SplatRequest& request, fg::TextureHandle levels,
                             fg::TextureHandle coarser, const gpu::SurfelCollectParams& params) {
    struct Data {
        ViewResources view;
        GBuffer gbuffer;
        fg::BufferHandle interleave;
        fg::TextureHandle levels, coarser, collected;
        gpu::SurfelCollectParams params;
    };
    return graph
        .addPass<Data>(
            "gi.surfels.collectSurfaces",
            [&](fg::Builder& builder, Data& data) {
                data.view = inputs.view;
                data.gbuffer = readGBuffer(builder, inputs.gbuffer);
                data.interleave = builder.read(request.interleave);
                data.levels = builder.read(levels);
                if (coarser) data.coarser = builder.read(coarser);
                data.params = params;
                data.collected = builder.create(
                    "gi.surfels.onSurfaces",
                    fg::texture2D(fg::Format::RGBA32F, params.size.x, params.size.y));
            },
            [](const Data& data, fg::PassContext& context) {
                auto command = context.compute("gi/surfels/collect_surface.comp");
                bindGBuffer(bindView(command, data.view), data.gbuffer)
                    .params(data.params, "Collect")
                    .bind("Interleave", data.interleave)
                    .bind("levels", data.levels)
                    // The shader does not read it where there is none, but the binding must be valid.
                    .bind("coarser", data.coarser ? data.coarser : data.gbuffer.depth)
                    .bind("collected", data.collected)
                    .dispatchOver(data.collected);
            })
        .collected;
}

} // namespace

fg::TextureHandle addSurfaceSplats(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                   const SplatRequest& request, const SplatList& list) {
    const fg::TextureHandle levels = addSplats(graph, inputs, request, list);
    return addCollectSteps(
        request, [&](const gpu::SurfelCollectParams& params, fg::TextureHandle coarser) {
            return addCollect(graph, inputs, request, levels, coarser, params);
        });
}

} // namespace tyndall::volumetric_gi
