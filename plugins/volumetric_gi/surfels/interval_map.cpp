#include "volumetric_gi/surfels/interval_map.h"

namespace tyndall::volumetric_gi {

SurfelIntervals addSurfelIntervals(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                   const IntervalRequest& request) {
    struct Data {
        ViewResources view;
        MediaResources media;
        fg::TextureHandle depth;
        SurfelIntervals map;
    };
    const Data& pass = graph.addPass<Data>(
        "gi.surfels.intervals",
        [&](fg::Builder& builder, Data& data) {
            data.view = inputs.view;
            data.media = readMedia(builder, inputs.media);
            data.depth = builder.read(inputs.gbuffer.depth);
            SurfelIntervals& map = data.map;
            map.march = inputs.march;
            const int factor = request.factor;
            map.march.factor = uint32_t(factor);
            const int width = (inputs.view.width + factor - 1) / factor,
                      height = (inputs.view.height + factor - 1) / factor;
            const int groups = request.paper ? 1 : int(inputs.media.phaseGroups);
            map.params.intervals = request.count;
            map.params.groups = uint32_t(groups);
            map.params.jitter = request.jitter;
            map.params.mode = request.paper ? gpu::kSurfelEncodingPaper : gpu::kSurfelEncodingCorrected;
            map.params.step = float(request.step);
            map.params.densest = float(request.densest);
            map.params.size = ivec2(width, height);
            map.ways = builder.create("gi.surfels.ways",
                                      fg::texture2D(fg::Format::RGBA32F, width, height));
            map.totals = builder.create(
                "gi.surfels.totals", fg::texture2DArray(fg::Format::RGBA32F, width, height, groups));
            map.places = builder.create(
                "gi.surfels.places", fg::BufferDesc{uint64_t(width) * uint64_t(height) *
                                                    request.count * sizeof(uint16_t)});
            map.shares = builder.create(
                "gi.surfels.shares",
                fg::texture2DArray(fg::Format::RGBA16, width, height, int(request.count) * groups));
        },
        [](const Data& data, fg::PassContext& context) {
            auto command =
                data.map.params.mode == gpu::kSurfelEncodingPaper
                    ? context.compute("gi/surfels/intervals_paper.comp")
                    : context.compute("gi/surfels/intervals.comp",
                                      {{"PHASE_GROUPS", int32_t(data.media.phaseGroups)},
                                       {"MEDIA_KINDS", mediaKinds(data.media, false)}});
            bindMedia(bindView(command, data.view), data.media);
            bindIntervals(command, data.map)
                .bind("shares", data.map.shares)
                .params(data.map.march)
                .bind("depth", data.depth)
                .dispatchOver(data.map.ways);
        });
    return pass.map;
}

SurfelIntervals readIntervals(fg::Builder& builder, const SurfelIntervals& map) {
    SurfelIntervals read = map;
    read.ways = builder.read(map.ways);
    read.totals = builder.read(map.totals);
    read.shares = builder.read(map.shares);
    read.places = builder.read(map.places);
    return read;
}

} // namespace tyndall::volumetric_gi
