#include "volumetric_gi/surfels/surfel_splats.h"

#include <algorithm>
#include <bit>


namespace tyndall::volumetric_gi {
namespace {

constexpr uint32_t kGroup = 256; // surfels of a workgroup that lists them
constexpr float kFarAway = 1e15f; // metres; its square is finite

struct SplatData {
    ViewResources view;
    MediaResources media;
    SurfelIntervals map;
    SurfelLight surfels;
    TracedBuffers traced;
    fg::BufferHandle interleave, list, draws;
    fg::TextureHandle levels;
    gpu::SurfelSplatParams params;
    uint32_t phaseGroups;
    int32_t rays, kinds;
};

SurfelLight readSurfels(fg::Builder& builder, const SurfelLight& surfels) {
    return {builder.read(surfels.lit), builder.read(surfels.brightness), surfels.count};
}

/// Clip coordinates over slopes of the view.
vec2 focalOf(const gpu::ViewData& view) {
    const dmat4 clipFromView = dmat4(view.clipFromRender) * glm::inverse(dmat4(view.viewFromRender));
    return vec2(float(clipFromView[0][0]), float(clipFromView[1][1]));
}

gpu::SurfelSplatParams splatParams(const plugin::FrameInputs& inputs, const SplatRequest& request) {
    gpu::SurfelSplatParams params{};
    const bool everywhere = request.media.empty();
    params.mediaMinimum = everywhere ? vec4(-kFarAway) : vec4(vec3(request.media.minimum), 0);
    params.mediaMaximum = everywhere ? vec4(kFarAway) : vec4(vec3(request.media.maximum), 0);
    params.focal = vec4(focalOf(inputs.view.data), 0, 0);
    params.size = request.map.params.size;
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
    params.factor = request.map.march.factor;
    return params;
}

void drawLevel(const SplatData& data, uint32_t level, fg::PassContext& context) {
    gpu::SurfelSplatParams params = data.params;
    params.level = level;
    auto command = context.raster(
        {.vertex = "gi/surfels/splat.vert", .fragment = "gi/surfels/splat.frag"},
        {{"PHASE_GROUPS", int32_t(data.phaseGroups)},
         {"MEDIA_KINDS", data.kinds},
         {"RAYS", data.rays},
         {"PAPER", data.params.mode == gpu::kSurfelEncodingPaper}});
    fg::RasterState state;
    state.blend = fg::BlendMode::Add;
    bindMedia(bindView(command, data.view), data.media);
    bindIntervals(command, data.map);
    if (data.rays != 0) bindTraced(command, data.traced);
    command.params(params, "Splat")
        .bind("Interleave", data.interleave)
        .bind("LitSurfels", data.surfels.lit)
        .bind("Brightness", data.surfels.brightness)
        .bind("SplatList", data.list)
        .colors({fg::Target{data.levels, int32_t(level), 0}})
        .state(state)
        .drawIndirect(data.draws, level * sizeof(fg::DrawArguments));
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

/// Which surfels are splatted on which level.
const ListData& addList(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                        const SplatRequest& request) {
    return graph.addPass<ListData>(
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
}

/// What filters one level after the other.
struct CollectData {
    ViewResources view;
    SurfelIntervals map;
    fg::BufferHandle interleave;
    fg::TextureHandle depth, levels, coarser, collected;
    gpu::SurfelCollectParams params;
};

fg::TextureHandle addCollect(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                             const SplatRequest& request, fg::TextureHandle levels,
                             fg::TextureHandle coarser, const gpu::SurfelCollectParams& params) {
    return graph
        .addPass<CollectData>(
            "gi.surfels.collect",
            [&](fg::Builder& builder, CollectData& data) {
                data.view = inputs.view;
                data.map = readIntervals(builder, request.map);
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
                              const SplatRequest& request, fg::TextureHandle rays) {
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
                data.params = request.map.march;
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

SurfelSplats addSurfelSplats(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                             const SplatRequest& request) {
    const ListData& listed = addList(graph, inputs, request);
    const fg::TextureHandle levels = graph
        .addPass<SplatData>(
            "gi.surfels.splat",
            [&](fg::Builder& builder, SplatData& data) {
                data.view = inputs.view;
                data.media = readMedia(builder, inputs.media);
                data.map = readIntervals(builder, request.map);
                data.surfels = readSurfels(builder, request.surfels);
                data.list = builder.read(listed.list);
                data.draws = builder.read(listed.draws, fg::Access::Indirect);
                data.interleave = builder.read(request.interleave);
                data.params = splatParams(inputs, request);
                data.rays = int32_t(request.rays);
                const bool grids = (inputs.media.kinds & gpu::kMediaGrids) != 0;
                data.kinds = int32_t(gpu::kMediaShapes |
                                     (grids && !request.paper ? gpu::kMediaGrids : 0u));
                data.phaseGroups = request.paper ? 1 : inputs.media.phaseGroups;
                // Nothing to ask: closed forms are had without rays.
                if (data.params.visibility == 0 && (!grids || !request.attenuation)) data.rays = 0;
                if (data.rays != 0) data.traced = readTraced(builder, request.traced);
                if (data.params.visibility == 0) data.traced.params.treeSize = 0;
                data.levels =
                    builder.create("gi.surfels.levels",
                                   fg::texture2DArray(fg::Format::RGBA32F, data.params.textureSize.x,
                                                      data.params.textureSize.y, int(request.levels)),
                                   fg::Access::ColorTarget);
            },
            [](const SplatData& data, fg::PassContext& context) {
                constexpr float kDark[4] = {};
                context.clearTexture(data.levels, kDark);
                for (uint32_t level = 0; level < data.params.levels; ++level)
                    drawLevel(data, level, context);
            })
        .levels;
    return {levels, listed.draws};
}

fg::BufferHandle addSurfelCounts(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                 const SplatRequest& request, const SurfelSplats& splats,
                                 const float (&of)[2]) {
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
                data.lit = builder.read(request.surfels.lit);
                data.draws = builder.read(splats.draws);
                data.levels = builder.read(splats.levels);
                data.params = splatParams(inputs, request);
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

fg::TextureHandle addSurfelCollect(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                   const SplatRequest& request, fg::TextureHandle levels) {
    const bool blur = request.blur;
    fg::TextureHandle sum;
    for (uint32_t level = request.levels; level-- > 0;) {
        gpu::SurfelCollectParams params{};
        params.size = request.map.params.size;
        params.plain = request.paper;
        params.level = int32_t(level);
        params.spacing = blur ? 1 << level : 0;
        params.hasCoarser = sum ? 1 : 0;
        params.hasOwn = 1;
        params.last = level == 0 && !blur;
        sum = addCollect(graph, inputs, request, levels, sum, params);
    }
    if (blur) {
        // The finest level: points of intervals differ from ray to ray.
        gpu::SurfelCollectParams params{};
        params.size = request.map.params.size;
        params.plain = request.paper;
        params.spacing = 1;
        params.hasCoarser = params.last = 1;
        sum = addCollect(graph, inputs, request, levels, sum, params);
    }
    return request.map.march.factor == 1 ? sum : addUpsample(graph, inputs, request, sum);
}

} // namespace tyndall::volumetric_gi
