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
                                 const VplBuffers& lights, const gpu::VplParams& params) {
    struct Data {
        ViewResources view;
        GBuffer gbuffer;
        MediaResources media;
        VplBuffers lights;
        fg::TextureHandle radiance;
        gpu::VplParams params;
    };
    return graph
        .addPass<Data>(
            "gi.vpl.surfaces",
            [&](fg::Builder& builder, Data& data) {
                data.view = inputs.view;
                data.gbuffer.depth = builder.read(inputs.gbuffer.depth);
                data.gbuffer.normal = builder.read(inputs.gbuffer.normal);
                data.gbuffer.base = builder.read(inputs.gbuffer.base);
                data.gbuffer.material = builder.read(inputs.gbuffer.material);
                if (inputs.media.count > 0) data.media = readMedia(builder, inputs.media);
                data.lights = read(builder, lights);
                data.radiance = builder.create(
                    "gi.vpl.surfaceRadiance",
                    fg::texture2D(fg::Format::RGBA32F, inputs.view.width, inputs.view.height));
                data.params = params;
            },
            [](const Data& data, fg::PassContext& context) {
                const bool media = data.media.count > 0;
                auto command = context.compute(
                    "gi/vpl/surfaces.comp",
                    {{"MEDIA", media}, {"MEDIA_KINDS", media ? mediaKinds(data.media, false) : 0}});
                bindView(command, data.view);
                if (media) bindMedia(command, data.media);
                bindVpls(command, data.lights, data.params)
                    .bind("gbufferDepth", data.gbuffer.depth)
                    .bind("gbufferNormal", data.gbuffer.normal)
                    .bind("gbufferBase", data.gbuffer.base)
                    .bind("gbufferMaterial", data.gbuffer.material)
                    .bind("surfaceRadiance", data.radiance)
                    .dispatchOver(data.radiance);
            })
        .radiance;
}

fg::TextureHandle addVplMedia(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                              const VplBuffers& lights, const gpu::VplParams& params) {
    struct Data {
        ViewResources view;
        LightResources sceneLights;
        MediaResources media;
        VplBuffers lights;
        fg::TextureHandle depth, inScatter;
        gpu::VplParams params;
        gpu::MarchParams march;
    };
    return graph
        .addPass<Data>(
            "gi.vpl.march",
            [&](fg::Builder& builder, Data& data) {
                if (inputs.media.count == 0 || !inputs.transmittance)
                    return builder.skip("no medium in view");
                data.view = inputs.view;
                data.sceneLights = readLights(builder, inputs.lights);
                data.media = readMedia(builder, inputs.media);
                data.lights = read(builder, lights);
                data.depth = builder.read(inputs.gbuffer.depth);
                data.inScatter = builder.create(
                    "gi.vpl.inScatter",
                    fg::texture2D(fg::Format::RGBA32F, inputs.view.width, inputs.view.height));
                data.params = params;
                data.march = inputs.march;
                data.march.factor = 1;
            },
            [](const Data& data, fg::PassContext& context) {
                auto command = context.compute(
                    "gi/vpl/march.comp",
                    {{"PHASE_GROUPS", int32_t(data.media.phaseGroups)},
                     {"MEDIA_KINDS", mediaKinds(data.media, true)},
                     {"SOFT_SHADOWS", data.sceneLights.softShadows},
                     {"COMPENSATION",
                      int32_t(data.params.compensation == gpu::kVplTraced ? 2 : 0)}});
                bindView(command, data.view);
                bindLights(command, data.sceneLights);
                bindMedia(command, data.media);
                bindVpls(command, data.lights, data.params)
                    .params(data.march)
                    .bind("depth", data.depth)
                    .bind("inScatter", data.inScatter)
                    .dispatchOver(data.inScatter);
            })
        .inScatter;
}

} // namespace tyndall::volumetric_gi
