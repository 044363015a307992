#include "volumetric_gi/vpl/vpl_gather.h"

#include <algorithm>
#include <bit>

#include "plugin/cache_key.h"
#include "plugin/cached_upload.h"
#include "plugin/reduced_march.h"

namespace tyndall::volumetric_gi {
namespace {

/// Grids are marched in steps even in averaged frames: cell by cell a ray takes more rounds of loops than llvmpipe allows.
int32_t steppedKinds(const MediaResources& media, bool towardsLights) {
    return mediaKinds(media, towardsLights) & ~int32_t(gpu::kMediaExactGrids);
}

/// Resources that every gathering pass reads.
struct GatherData {
    MarchPass march;
    GBuffer gbuffer; // of surfaces
    LightResources sceneLights;
    VplBuffers lights;
    gpu::VplParams params;
    fg::TextureHandle transmittance, before,
        result; // of surfaces; before: coarse, or with pixels left open
};

void declare(fg::Builder& builder, GatherData& data, const plugin::FrameInputs& inputs,
             const VplBuffers& lights, const VplGather& gather, MarchStage stage, int factor) {
    gpu::MarchParams params = inputs.march;
    params.factor = uint32_t(factor);
    // All media, in view or not: they attenuate the lights.
    data.march = readMarch(builder, stage, inputs.view, inputs.media, inputs.gbuffer.depth, params);
    if (inputs.media.count > 0) data.sceneLights = readLights(builder, inputs.lights);
    data.lights = readVpls(builder, lights);
    data.params = gather.params;
    data.params.mediaInView = inputs.transmittance ? 1u : 0u;
}

/// `mode`: kVplClamped and so on, as far as the shader knows it.
fg::ComputeCommand begin(const GatherData& data, fg::PassContext& context, const char* shader,
                         uint32_t mode) {
    const MediaResources& of = data.march.media;
    const bool media = of.count > 0;
    auto command = context.compute(
        shader, {{"MEDIA", media},
                 {"PHASE_GROUPS", media ? int32_t(of.phaseGroups) : 1},
                 {"MEDIA_KINDS", media ? steppedKinds(of, true) : 0},
                 {"SOFT_SHADOWS",
                  0}, // of lights that compensation gathers: their light is spread by the step anyway
                 {"COMPENSATION", media ? int32_t(mode) : 0}});
    if (media) {
        bindLights(command, data.sceneLights);
        bindMedia(command, of);
    }
    bindVpls(command, data.lights, data.params);
    return command;
}

/// The closed form assumes even light, which a surface never has: media alone.
uint32_t surfaceMode(const GatherData& data) {
    return data.params.compensation == gpu::kVplTraced ? gpu::kVplTraced : gpu::kVplClamped;
}

/// Bindings of all surface shaders.
fg::ComputeCommand& bindSurfaces(fg::ComputeCommand& command, const GatherData& data) {
    bindView(command, data.march.view).params(data.march.params);
    return bindGBuffer(command, data.gbuffer);
}

constexpr LightMarchNames kMarchNames{"gi.vpl.march", "gi.vpl.upsample", "gi.vpl.refine",
                                      "gi.vpl.inScatter", "gi.vpl.inScatter"};

/// The points of a ray in turns.
void gatherInTurns(GatherData data, const LightMarch& march, uint32_t pointsATurn,
                   fg::PassContext& context) {
    gpu::VplParams& params = data.params;
    for (params.firstPoint = 0; params.firstPoint < params.samples; params.firstPoint += pointsATurn) {
        if (params.firstPoint > 0) context.barrier(fg::Access::StorageWrite);
        const bool last = params.samples - params.firstPoint <= pointsATurn;
        params.endPoint = last ? gpu::kVplAllPoints : params.firstPoint + pointsATurn;
        auto command = begin(data, context, "gi/vpl/march.comp", params.compensation);
        command.bind("VplPathLight", data.lights.pathsInMedia);
        bindLightMarch(command, march).dispatchOver(march.light);
    }
}

/// Light that media scatter to the eye.
fg::TextureHandle addMarch(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                           const VplBuffers& lights, const VplGather& gather, MarchStage stage,
                           fg::TextureHandle before) {
    struct Data {
        GatherData gather;
        LightMarch march;
        uint32_t pointsATurn = 1;
    };
    return graph
        .addPass<Data>(
            kMarchNames.of(stage),
            [&](fg::Builder& builder, Data& data) {
                if (inputs.media.count == 0 || !inputs.transmittance)
                    return builder.skip("no medium in view");
                declare(builder, data.gather, inputs, lights, gather, stage, gather.mediaFactor);
                if (stage != MarchStage::Spread)
                    data.gather.lights.pathsInMedia = builder.read(lights.pathsInMedia);
                data.pointsATurn = gather.pointsATurn;
                data.march = declareLightMarch(builder, data.gather.march, inputs.transmittance,
                                               before, kMarchNames);
            },
            [](const Data& data, fg::PassContext& context) {
                if (data.gather.march.stage != MarchStage::Spread)
                    return gatherInTurns(data.gather, data.march, data.pointsATurn, context);
                auto command = context.compute("gi/vpl/upsample.comp");
                bindLightMarch(command, data.march).dispatchOver(data.march.light);
            })
        .march.light;
}

/// Maps of the grids' optical depth around each light.
fg::BufferHandle addDepthMaps(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                              fg::BufferHandle lights, uint64_t key, const gpu::VplParams& params) {
    struct Data {
        MediaResources media;
        fg::BufferHandle lights, depths;
        gpu::VplParams params;
    };
    const size_t texels = size_t(params.lightCount) * params.depthSide * params.depthSide;
    return graph
        .addPass<Data>(
            "gi.vpl.depths",
            [&](fg::Builder& builder, Data& data) {
                data.params = params;
                if (texels > 0) {
                    data.media = readMedia(builder, inputs.media);
                    data.lights = builder.read(lights);
                }
                const size_t bytes = std::max<size_t>(texels * gpu::kVplDepthSteps * 8, 256);
                data.depths = builder.create("gi.vpl.depths", fg::BufferDesc{std::bit_ceil(bytes)},
                                             texels > 0 ? fg::Access::StorageWrite
                                                        : fg::Access::TransferWrite);
                builder.cacheBy(key);
            },
            [](const Data& data, fg::PassContext& context) {
                if (data.params.depthSide == 0 || data.params.lightCount == 0)
                    return context.clearBuffer(data.depths, 0);
                const int32_t kinds = steppedKinds(data.media, false);
                auto command = context.compute("gi/vpl/depth_maps.comp", {{"MEDIA_KINDS", kinds}});
                bindMedia(command, data.media);
                command.params(data.params, "Vpl")
                    .bind("VplLights", data.lights)
                    .bind("VplDepths", data.depths)
                    .dispatchOver(data.params.depthSide * data.params.depthSide,
                                  data.params.lightCount);
            })
        .depths;
}

/// Visibility maps from points of surfaces.
fg::BufferHandle addSplattedMaps(fg::FrameGraph& graph, const VplBuffers& buffers,
                                 fg::BufferHandle places, fg::BufferHandle points,
                                 const gpu::VplPointParams& pointParams,
                                 const gpu::VplParams& params, uint64_t key) {
    struct Data {
        fg::BufferHandle places, triangles, points, maps;
        gpu::VplPointParams pointParams;
        gpu::VplParams params;
    };
    return graph
        .addPass<Data>(
            "gi.vpl.maps",
            [&](fg::Builder& builder, Data& data) {
                data.places = builder.read(places);
                data.triangles = builder.read(buffers.traced.triangles);
                data.points = builder.read(points);
                data.pointParams = pointParams;
                data.params = params;
                const size_t words =
                    size_t(params.lightCount) * (size_t(params.mapSide) * params.mapSide + 1);
                data.maps = builder.create(
                    "gi.vpl.maps", fg::BufferDesc{std::bit_ceil(std::max<size_t>(4 * words, 256))});
                builder.cacheBy(key);
            },
            [](const Data& data, fg::PassContext& context) {
                constexpr uint32_t kRow =
                    1024; // groups: many lights need more than one row may have
                auto command = context.compute("gi/vpl/splat_maps.comp");
                command.params(data.params, "Vpl")
                    .params(data.pointParams, "Points")
                    .bind("VplPlaces", data.places)
                    .bind("TracedTriangles", data.triangles)
                    .bind("VplPoints", data.points)
                    .bind("VplMaps", data.maps)
                    .dispatch(std::min(data.params.lightCount, kRow),
                              (data.params.lightCount + kRow - 1) / kRow);
            })
        .maps;
}

} // namespace

VplBuffers readVpls(fg::Builder& builder, const VplBuffers& buffers) {
    return {builder.read(buffers.lights),
            builder.read(buffers.walks),
            builder.read(buffers.maps),
            readTraced(builder, buffers.traced),
            builder.read(buffers.depths),
            {},
            {}};
}

VplBuffers addVplUpload(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                        const VplUpload& upload, const gpu::VplParams& params) {
    const auto add = [&](const char* name, const auto& values, uint64_t key) {
        return addCachedUpload(graph, name, values, key);
    };
    VplBuffers buffers;
    buffers.lights = add("gi.vpl.lights", upload.set->lights, upload.lightsKey);
    buffers.walks = add("gi.vpl.walks", upload.set->walks, upload.mapsKey);
    buffers.traced = upload.traced;
    buffers.pathsOnSurfaces = add("gi.vpl.nearSurfaces", *upload.pathsOnSurfaces, upload.pathsKey);
    buffers.pathsInMedia = add("gi.vpl.nearMedia", *upload.pathsInMedia, upload.pathsKey);
    if (upload.points->points.empty()) {
        buffers.maps = add("gi.vpl.maps", *upload.maps, upload.mapsKey);
    } else {
        // Positions are apart from powers, which change with moving media while maps stay.
        const fg::BufferHandle places = add("gi.vpl.places", upload.set->places, upload.mapsKey),
                               points = add("gi.vpl.points", upload.points->points, upload.mapsKey);
        buffers.maps = addSplattedMaps(graph, buffers, places, points, upload.points->params,
                                       params, upload.mapsKey);
    }
    // Buffer sizes are rounded up, so the size alone does not separate maps of different sides.
    const uint64_t depthsKey = cacheKey(upload.lightsKey, params.depthSide);
    buffers.depths = addDepthMaps(graph, inputs, buffers.lights, depthsKey, params);
    return buffers;
}

fg::TextureHandle addVplSurfaces(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                 const VplBuffers& lights, const VplGather& gather) {
    const auto gathering = [&](const char* name, MarchStage stage, fg::TextureHandle before) {
        return graph
            .addPass<GatherData>(
                name,
                [&](fg::Builder& builder, GatherData& data) {
                    declare(builder, data, inputs, lights, gather, stage, gather.surfaceFactor);
                    data.gbuffer = readGBuffer(builder, inputs.gbuffer);
                    fg::TextureDesc desc = marchPicture(data.march);
                    if (stage == MarchStage::Squares)
                        desc.width *= 3; // the parts of SurfaceLight
                    else
                        data.before = builder.read(before);
                    data.result = builder.create("gi.vpl.surfaceLight", desc);
                },
                [](const GatherData& data, fg::PassContext& context) {
                    auto command = begin(data, context, "gi/vpl/surfaces.comp", surfaceMode(data));
                    bindSurfaces(command, data)
                        .bind("gathered", data.before ? data.before : data.gbuffer.depth)
                        .bind("surfaceLight", data.result)
                        .dispatchOver(data.result);
                })
            .result;
    };
    const fg::TextureHandle squares = gathering("gi.vpl.surfaces", MarchStage::Squares, {});
    const fg::TextureHandle pixels =
        graph
            .addPass<GatherData>(
                "gi.vpl.upsampleSurfaces",
                [&](fg::Builder& builder, GatherData& data) {
                    declare(builder, data, inputs, lights, gather, MarchStage::Spread,
                            gather.surfaceFactor);
                    data.gbuffer = readGBuffer(builder, inputs.gbuffer);
                    data.before = builder.read(squares);
                    data.lights.pathsOnSurfaces = builder.read(lights.pathsOnSurfaces);
                    if (inputs.transmittance)
                        data.transmittance = builder.read(inputs.transmittance);
                    data.result =
                        builder.create("gi.vpl.surfaceRadiance", marchPicture(data.march));
                },
                [](const GatherData& data, fg::PassContext& context) {
                    auto command = context.compute("gi/vpl/upsample_surfaces.comp");
                    bindSurfaces(command, data)
                        .params(data.params, "Vpl")
                        .bind("squares", data.before)
                        .bind("VplPathLight", data.lights.pathsOnSurfaces)
                        .bind("surfaceRadiance", data.result)
                        .bind("transmittance",
                              data.transmittance ? data.transmittance : data.before)
                        .dispatchOver(data.result);
                })
            .result;
    return gather.surfaceFactor == 1 ? pixels
                                     : gathering("gi.vpl.refineSurfaces", MarchStage::Fill, pixels);
}

fg::TextureHandle addVplMedia(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                              const VplBuffers& lights, const VplGather& gather) {
    const bool fills = (inputs.march.flags & gpu::kMarchRefine) != 0;
    return addMarchStages<fg::TextureHandle>(
        gather.mediaFactor, fills, [&](MarchStage stage, fg::TextureHandle before) {
            return addMarch(graph, inputs, lights, gather, stage, before);
        });
}

} // namespace tyndall::volumetric_gi
