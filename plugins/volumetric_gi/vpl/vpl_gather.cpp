#include "volumetric_gi/vpl/vpl_gather.h"

#include <algorithm>
#include <bit>

#include "framegraph/hash.h"

namespace tyndall::volumetric_gi {
namespace {

/// One buffer of CPU data, uploaded where `key` is new. Sizes are rounded up to powers of two, so that few are ever made.
fg::BufferHandle addUpload(fg::FrameGraph& graph, const char* name, const void* data, size_t bytes,
                           uint64_t key) {
    struct Data {
        fg::BufferHandle buffer;
        const void* data;
        size_t bytes;
    };
    return graph
        .addPass<Data>(
            name,
            [&](fg::Builder& builder, Data& pass) {
                pass.buffer = builder.create(
                    name, fg::BufferDesc{std::bit_ceil(std::max<size_t>(bytes, 256))},
                    fg::Access::TransferWrite);
                pass.data = data;
                pass.bytes = bytes;
                builder.cacheBy(key);
            },
            [](const Data& pass, fg::PassContext& context) {
                if (pass.bytes > 0)
                    context.upload(pass.buffer, 0, pass.data, pass.bytes);
                else
                    context.clearBuffer(pass.buffer, 0);
            })
        .buffer;
}

/// Grids are marched in steps even where frames are averaged: cell by cell a ray takes more rounds of loops than llvmpipe grants it.
int32_t steppedKinds(const MediaResources& media, bool towardsLights) {
    return mediaKinds(media, towardsLights) & ~int32_t(gpu::kMediaExactGrids);
}

/// What every pass that gathers reads.
struct GatherData {
    ViewResources view;
    GBuffer gbuffer;
    LightResources sceneLights;
    MediaResources media;
    VplBuffers lights;
    gpu::VplParams params;
    gpu::MarchParams march;
    fg::TextureHandle transmittance, coarse[2], result[2];
};

void declare(fg::Builder& builder, GatherData& data, const plugin::FrameInputs& inputs,
             const VplBuffers& lights, const VplGather& gather, int factor) {
    data.view = inputs.view;
    if (inputs.media.count > 0) { // in view or not: they attenuate what the lights send
        data.media = readMedia(builder, inputs.media);
        data.sceneLights = readLights(builder, inputs.lights);
    }
    data.lights = readVpls(builder, lights);
    data.params = gather.params;
    data.march = inputs.march;
    data.march.factor = uint32_t(factor);
    data.params.mediaInView = inputs.transmittance ? 1u : 0u;
}

void readSurfaces(fg::Builder& builder, GatherData& data, const plugin::FrameInputs& inputs) {
    data.gbuffer.depth = builder.read(inputs.gbuffer.depth);
    data.gbuffer.normal = builder.read(inputs.gbuffer.normal);
    data.gbuffer.base = builder.read(inputs.gbuffer.base);
    data.gbuffer.material = builder.read(inputs.gbuffer.material);
}

fg::TextureDesc picture(const plugin::FrameInputs& inputs, int factor) {
    return fg::texture2D(fg::Format::RGBA32F, (inputs.view.width + factor - 1) / factor,
                         (inputs.view.height + factor - 1) / factor);
}

/// `mode`: kVplClamped and so on, as far as the shader knows it.
fg::ComputeCommand begin(const GatherData& data, fg::PassContext& context, const char* shader,
                         uint32_t mode) {
    const bool media = data.media.count > 0;
    auto command = context.compute(
        shader, {{"MEDIA", media},
                 {"PHASE_GROUPS", media ? int32_t(data.media.phaseGroups) : 1},
                 {"MEDIA_KINDS", media ? steppedKinds(data.media, true) : 0},
                 {"SOFT_SHADOWS",
                  0}, // of lights that compensation gathers: what they light is spread anyway
                 {"COMPENSATION", media ? int32_t(mode) : 0}});
    bindView(command, data.view);
    if (media) {
        bindLights(command, data.sceneLights);
        bindMedia(command, data.media);
    }
    bindVpls(command, data.lights, data.params).params(data.march);
    return command;
}

/// Light is never even all around a surface: that mode is for media alone.
uint32_t surfaceMode(const GatherData& data) {
    return data.params.compensation == gpu::kVplTraced ? gpu::kVplTraced : gpu::kVplClamped;
}

void bindSurfaces(fg::ComputeCommand& command, const GBuffer& gbuffer) {
    command.bind("gbufferDepth", gbuffer.depth)
        .bind("gbufferNormal", gbuffer.normal)
        .bind("gbufferBase", gbuffer.base)
        .bind("gbufferMaterial", gbuffer.material);
}

/// Light that media scatter to the eye: a ray for a square of pixels or, from these `rays`, for every pixel.
fg::TextureHandle addMarch(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                           const VplBuffers& lights, const VplGather& gather,
                           fg::TextureHandle rays) {
    const int factor = rays ? 1 : gather.mediaFactor;
    return graph
        .addPass<GatherData>(
            rays ? "gi.vpl.upsample" : "gi.vpl.march",
            [&](fg::Builder& builder, GatherData& data) {
                if (inputs.media.count == 0 || !inputs.transmittance)
                    return builder.skip("no medium in view");
                declare(builder, data, inputs, lights, gather, gather.mediaFactor);
                data.gbuffer.depth = builder.read(inputs.gbuffer.depth);
                if (rays) {
                    data.transmittance = builder.read(inputs.transmittance);
                    data.coarse[0] = builder.read(rays);
                }
                data.result[0] =
                    builder.create(factor == 1 ? "gi.vpl.inScatter" : "gi.vpl.coarse.inScatter",
                                   picture(inputs, factor));
            },
            [](const GatherData& data, fg::PassContext& context) {
                auto command = begin(data, context,
                                     data.coarse[0] ? "gi/vpl/upsample.comp" : "gi/vpl/march.comp",
                                     data.params.compensation);
                command.bind("depth", data.gbuffer.depth).bind("inScatter", data.result[0]);
                if (data.coarse[0])
                    command.bind("transmittance", data.transmittance)
                        .bind("coarseInScatter", data.coarse[0]);
                command.dispatchOver(data.result[0]);
            })
        .result[0];
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

} // namespace

VplBuffers readVpls(fg::Builder& builder, const VplBuffers& buffers) {
    return {builder.read(buffers.lights), builder.read(buffers.walks),
            builder.read(buffers.maps),   builder.read(buffers.triangles),
            builder.read(buffers.tree),   builder.read(buffers.depths)};
}

VplBuffers addVplUpload(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                        const VplUpload& upload, const gpu::VplParams& params) {
    const auto add = [&](const char* name, const auto& values, uint64_t key) {
        return addUpload(graph, name, values.data(), values.size() * sizeof(values[0]), key);
    };
    VplBuffers buffers;
    buffers.lights = add("gi.vpl.lights", upload.set->lights, upload.lightsKey);
    buffers.walks = add("gi.vpl.walks", upload.set->walks, upload.mapsKey);
    buffers.maps = add("gi.vpl.maps", *upload.maps, upload.mapsKey);
    buffers.triangles = add("gi.vpl.triangles", *upload.triangles, upload.trianglesKey);
    buffers.tree = add("gi.vpl.tree", *upload.tree, upload.trianglesKey);
    // Sizes are rounded up, so that the buffer's alone does not tell maps of one side from those of another.
    const uint64_t depthsKey = fg::mixHash(upload.lightsKey, params.depthSide);
    buffers.depths = addDepthMaps(graph, inputs, buffers.lights, depthsKey, params);
    return buffers;
}

fg::TextureHandle addVplSurfaces(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                 const VplBuffers& lights, const VplGather& gather) {
    const GatherData& squares = graph.addPass<GatherData>(
        "gi.vpl.surfaces",
        [&](fg::Builder& builder, GatherData& data) {
            declare(builder, data, inputs, lights, gather, gather.surfaceFactor);
            readSurfaces(builder, data, inputs);
            const fg::TextureDesc desc = picture(inputs, gather.surfaceFactor);
            data.result[0] = builder.create("gi.vpl.diffuse", desc);
            data.result[1] = builder.create("gi.vpl.specular", desc);
        },
        [](const GatherData& data, fg::PassContext& context) {
            auto command = begin(data, context, "gi/vpl/surfaces.comp", surfaceMode(data));
            bindSurfaces(command, data.gbuffer);
            command.bind("diffuse", data.result[0])
                .bind("specular", data.result[1])
                .dispatchOver(data.result[0]);
        });
    return graph
        .addPass<GatherData>(
            "gi.vpl.upsampleSurfaces",
            [&](fg::Builder& builder, GatherData& data) {
                declare(builder, data, inputs, lights, gather, gather.surfaceFactor);
                readSurfaces(builder, data, inputs);
                for (int i = 0; i < 2; ++i) data.coarse[i] = builder.read(squares.result[i]);
                if (inputs.transmittance) data.transmittance = builder.read(inputs.transmittance);
                data.result[0] = builder.create("gi.vpl.surfaceRadiance", picture(inputs, 1));
            },
            [](const GatherData& data, fg::PassContext& context) {
                auto command =
                    begin(data, context, "gi/vpl/upsample_surfaces.comp", surfaceMode(data));
                bindSurfaces(command, data.gbuffer);
                // Where no medium is in view it is not looked at, but has to be something.
                if (data.media.count > 0)
                    command.bind("transmittance",
                                 data.transmittance ? data.transmittance : data.coarse[0]);
                command.bind("diffuse", data.coarse[0])
                    .bind("specular", data.coarse[1])
                    .bind("surfaceRadiance", data.result[0])
                    .dispatchOver(data.result[0]);
            })
        .result[0];
}

fg::TextureHandle addVplMedia(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                              const VplBuffers& lights, const VplGather& gather) {
    const fg::TextureHandle rays = addMarch(graph, inputs, lights, gather, {});
    return !rays || gather.mediaFactor == 1 ? rays : addMarch(graph, inputs, lights, gather, rays);
}

} // namespace tyndall::volumetric_gi
