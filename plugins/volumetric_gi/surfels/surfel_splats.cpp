#include "volumetric_gi/surfels/surfel_splats.h"

#include <algorithm>
#include <bit>

namespace tyndall::volumetric_gi {
namespace {

constexpr uint32_t kGroup = 256; // surfels of a workgroup that lists them
constexpr float kFarAway = 1e15f; // metres; its square is finite

SurfelLight readSurfels(fg::Builder& builder, const SurfelLight& surfels) {
    return {builder.read(surfels.lit), builder.read(surfels.brightness), surfels.count};
}

struct ListData {
    ViewResources view;
    SurfelLight surfels;
    fg::BufferHandle interleave, counts, levels, list, draws;
    gpu::SurfelSplatParams params;
};

void recordList(const ListData& data, fg::PassContext& context) {
    const uint32_t groups = (data.params.surfelCount + kGroup - 1) / kGroup;
    for (const int32_t stage : {0, 1, 2}) {
        if (stage > 0) context.barrier(fg::Access::StorageRead);
        auto command = context.compute("gi/surfels/list.comp", {{"STAGE", stage}});
        bindView(command, data.view)
            .params(data.params, "Splat")
            .bind("Interleave", data.interleave)
            .bind("LitSurfels", data.surfels.lit)
            .bind("Brightness", data.surfels.brightness)
            .bind("GroupCounts", data.counts)
            .bind("SurfelLevels", data.levels)
            .bind("SplatList", data.list)
            .bind("Draws", data.draws)
            .dispatch(stage == 1 ? 1 : groups);
    }
}

/// Clip coordinates over slopes of the view.
vec2 focalOf(const gpu::ViewData& view) {
    const dmat4 clipFromView = dmat4(view.clipFromRender) * glm::inverse(dmat4(view.viewFromRender));
    return vec2(float(clipFromView[0][0]), float(clipFromView[1][1]));
}

} // namespace

gpu::SurfelSplatParams splatParams(const plugin::FrameInputs& inputs, const SplatRequest& request) {
    gpu::SurfelSplatParams params{};
    const bool everywhere = request.reached.empty();
    params.mediaMinimum = everywhere ? vec4(-kFarAway) : vec4(vec3(request.reached.minimum), 0);
    params.mediaMaximum = everywhere ? vec4(kFarAway) : vec4(vec3(request.reached.maximum), 0);
    for (int i = 0; i < 3; ++i)
        params.anchor[i] = inputs.scene.contentMinimum[i] < kFarAway ? inputs.scene.contentMinimum[i] : 0;
    params.focal = vec4(focalOf(inputs.view.data), 0, 0);
    params.size = request.size;
    const int coarsest = 1 << (request.levels - 1);
    params.textureSize = (params.size + coarsest - 1) / coarsest * coarsest;
    params.levels = request.levels;
    params.surfelCount = request.surfels.count;
    params.threshold = float(request.threshold);
    params.mode = request.paper ? gpu::kSurfelEncodingPaper : gpu::kSurfelEncodingCorrected;
    params.attenuation = request.attenuation;
    params.visibility = request.visibility && request.traced.triangles;
    params.nearest = float(request.nearest);
    params.seed = uint32_t(request.chance);
    params.tail = !request.paper;
    params.factor = uint32_t(request.factor);
    return params;
}

SplatList addSplatList(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                       const SplatRequest& request) {
    const ListData& pass = graph.addPass<ListData>(
        "gi.surfels.list",
        [&](fg::Builder& builder, ListData& data) {
            data.view = inputs.view;
            data.surfels = readSurfels(builder, request.surfels);
            data.interleave = builder.read(request.interleave);
            data.params = splatParams(inputs, request);
            const uint64_t surfels = std::bit_ceil(uint64_t(request.surfels.count)),
                           groups = std::max(surfels / kGroup, uint64_t(1)),
                           number = sizeof(uint32_t);
            data.counts = builder.create("gi.surfels.groupCounts",
                                         fg::BufferDesc{number * groups * request.levels});
            data.levels = builder.create("gi.surfels.levelsOf", fg::BufferDesc{number * surfels});
            data.list =
                builder.create("gi.surfels.list", fg::BufferDesc{number * surfels * request.levels});
            data.draws = builder.create("gi.surfels.draws",
                                        fg::BufferDesc{sizeof(fg::DrawArguments) * request.levels});
        },
        [](const ListData& data, fg::PassContext& context) { recordList(data, context); });
    return {pass.list, pass.draws, request.surfels, request.interleave, pass.params};
}

SplatList readSplatList(fg::Builder& builder, const SplatList& list) {
    SplatList read = list;
    read.list = builder.read(list.list);
    read.draws = builder.read(list.draws, fg::Access::Indirect);
    read.surfels = readSurfels(builder, list.surfels);
    read.interleave = builder.read(list.interleave);
    return read;
}

fg::TextureDesc splatLevels(const SplatList& list) {
    return fg::texture2DArray(fg::Format::RGBA32F, list.params.textureSize.x,
                              list.params.textureSize.y, int(list.params.levels));
}

fg::BufferHandle addSurfelCounts(fg::FrameGraph& graph, const SplatList& list,
                                 fg::TextureHandle levels, const float (&of)[2]) {
    struct Data {
        fg::BufferHandle lit, draws, counts;
        fg::TextureHandle levels;
        gpu::SurfelSplatParams params;
        const float* others;
    };
    return graph
        .addPass<Data>(
            "gi.surfels.count",
            [&](fg::Builder& builder, Data& data) {
                data.lit = builder.read(list.surfels.lit);
                data.draws = builder.read(list.draws);
                data.levels = builder.read(levels);
                data.params = list.params;
                data.others = of;
                data.counts = builder.create("gi.surfels.counts",
                                             fg::BufferDesc{kSurfelCounts * sizeof(float)});
            },
            [](const Data& data, fg::PassContext& context) {
                context.upload(data.counts, (kSurfelCounts - 2) * sizeof(float), data.others,
                               2 * sizeof(float));
                context.compute("gi/surfels/count.comp")
                    .params(data.params, "Splat")
                    .bind("LitSurfels", data.lit)
                    .bind("Draws", data.draws)
                    .bind("levels", data.levels)
                    .bind("Counts", data.counts)
                    .dispatch(1);
            })
        .counts;
}

} // namespace tyndall::volumetric_gi
