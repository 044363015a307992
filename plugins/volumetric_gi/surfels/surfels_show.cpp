#include "volumetric_gi/surfels/surfels_show.h"

#include <algorithm>

#include "volumetric_gi/shared/scene_bounds.h"

namespace tyndall::volumetric_gi {
namespace {

gpu::SurfelShowParams showParams(const plugin::FrameInputs& inputs, uint32_t what) {
    const Bounds content = boundsOf(inputs.scene.contentMinimum, inputs.scene.contentMaximum);
    double middle = 1, radius = 1;
    if (!content.empty()) {
        middle = glm::distance(content.centre(), dvec3(inputs.view.data.cameraPosition));
        radius = 0.5 * glm::length(content.extent());
    }
    return {what, inputs.whiteNits, float(std::max(middle - radius, 0.0)), float(middle + radius)};
}

fg::TextureHandle addDisks(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                           const SurfelLight& surfels, const gpu::SurfelShowParams& params,
                           fg::TextureHandle color) {
    struct Data {
        ViewResources view;
        fg::BufferHandle lit;
        fg::TextureHandle color, depth, shown;
        gpu::SurfelShowParams params;
        uint32_t count;
    };
    return graph
        .addPass<Data>(
            "gi.surfels.show",
            [&](fg::Builder& builder, Data& data) {
                data.view = inputs.view;
                data.lit = builder.read(surfels.lit);
                data.color = builder.read(color, fg::Access::TransferRead);
                data.depth = builder.read(inputs.gbuffer.depth);
                data.shown = builder.create("gi.surfels.shown", graph.desc(color),
                                            fg::Access::ColorTarget);
                data.params = params;
                data.count = surfels.count;
            },
            [](const Data& data, fg::PassContext& context) {
                context.copyTexture(data.color, data.shown);
                auto command = context.raster("gi/surfels/disk.vert", "gi/surfels/disk.frag");
                bindView(command, data.view)
                    .params(data.params, "Show")
                    .bind("LitSurfels", data.lit)
                    .bind("depth", data.depth)
                    .colors({fg::Target{data.shown, 0, 0}})
                    .draw(6 * data.count);
            })
        .shown;
}

fg::TextureHandle addPanels(fg::FrameGraph& graph, const SurfelsOfFrame& made,
                            const gpu::SurfelShowParams& params, fg::TextureHandle color) {
    struct Data {
        fg::BufferHandle interleave;
        SurfelIntervals map;
        fg::TextureHandle levels, shown;
        gpu::SurfelShowParams params;
    };
    return graph
        .addPass<Data>(
            "gi.surfels.show",
            [&](fg::Builder& builder, Data& data) {
                data.interleave = builder.read(made.interleave);
                data.map = readIntervals(builder, made.map);
                data.levels = builder.read(made.levels);
                data.shown = builder.create("gi.surfels.shown", graph.desc(color));
                data.params = params;
            },
            [](const Data& data, fg::PassContext& context) {
                context.compute("gi/surfels/show.comp")
                    .params(data.map.params, "IntervalMap")
                    .bind("ways", data.map.ways)
                    .bind("IntervalPlaces", data.map.places)
                    .params(data.params, "Show")
                    .bind("Interleave", data.interleave)
                    .bind("levels", data.levels)
                    .bind("shown", data.shown)
                    .dispatchOver(data.shown);
            })
        .shown;
}

} // namespace

fg::TextureHandle addSurfelsShow(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                 const SurfelsOfFrame& made, uint32_t what,
                                 fg::TextureHandle color) {
    const gpu::SurfelShowParams params = showParams(inputs, what);
    if (what == gpu::kSurfelShowDisks && made.surfels.lit)
        return addDisks(graph, inputs, made.surfels, params, color);
    if (what != 0 && what != gpu::kSurfelShowDisks && made.levels)
        return addPanels(graph, made, params, color);
    return color;
}

} // namespace tyndall::volumetric_gi
