#include "volumetric_gi/vpl/vpl_gather.h"

#include <algorithm>
#include <bit>

namespace tyndall::volumetric_gi {
namespace {

VplBuffers read(fg::Builder& builder, const VplBuffers& buffers) {
    return {builder.read(buffers.lights), builder.read(buffers.walks), builder.read(buffers.maps),
            builder.read(buffers.planes)};
}

template <typename Command>
Command& bindVpls(Command& command, const VplBuffers& buffers, const gpu::VplParams& params) {
    return command.params(params, "Vpl")
        .bind("VplLights", buffers.lights)
        .bind("VplWalks", buffers.walks)
        .bind("VplMaps", buffers.maps)
        .bind("VplPlanes", buffers.planes);
}

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
    if (inputs.media.count > 0) {
        data.media = readMedia(builder, inputs.media);
        data.sceneLights = readLights(builder, inputs.lights);
    }
    data.lights = read(builder, lights);
    data.params = gather.params;
    data.march = inputs.march;
    data.march.factor = uint32_t(factor);
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

fg::ComputeCommand begin(const GatherData& data, fg::PassContext& context, const char* shader) {
    const bool media = data.media.count > 0;
    auto command = context.compute(
        shader,
        {{"MEDIA", media},
         {"PHASE_GROUPS", media ? int32_t(data.media.phaseGroups) : 1},
         {"MEDIA_KINDS", media ? mediaKinds(data.media, true) : 0},
         {"SOFT_SHADOWS",
          0}, // of lights that compensation gathers: what they light is spread anyway
         {"COMPENSATION", int32_t(media && data.params.compensation == gpu::kVplTraced ? 2 : 0)}});
    bindView(command, data.view);
    if (media) {
        bindLights(command, data.sceneLights);
        bindMedia(command, data.media);
    }
    bindVpls(command, data.lights, data.params).params(data.march);
    return command;
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
                                     data.coarse[0] ? "gi/vpl/upsample.comp" : "gi/vpl/march.comp");
                command.bind("depth", data.gbuffer.depth).bind("inScatter", data.result[0]);
                if (data.coarse[0])
                    command.bind("transmittance", data.transmittance)
                        .bind("coarseInScatter", data.coarse[0]);
                command.dispatchOver(data.result[0]);
            })
        .result[0];
}

} // namespace

VplBuffers addVplUpload(fg::FrameGraph& graph, const VplUpload& upload) {
    const auto bytes = [](const auto& values) { return values.size() * sizeof(values[0]); };
    const VplSet& set = *upload.set;
    return {
        addUpload(graph, "gi.vpl.lights", set.lights.data(), bytes(set.lights), upload.lightsKey),
        addUpload(graph, "gi.vpl.walks", set.walks.data(), bytes(set.walks), upload.lightsKey),
        addUpload(graph, "gi.vpl.maps", upload.maps->data(), bytes(*upload.maps), upload.lightsKey),
        addUpload(graph, "gi.vpl.planes", upload.planes->data(), bytes(*upload.planes),
                  upload.planesKey)};
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
            auto command = begin(data, context, "gi/vpl/surfaces.comp");
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
                data.result[0] = builder.create("gi.vpl.surfaceRadiance", picture(inputs, 1));
            },
            [](const GatherData& data, fg::PassContext& context) {
                auto command = begin(data, context, "gi/vpl/upsample_surfaces.comp");
                bindSurfaces(command, data.gbuffer);
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
