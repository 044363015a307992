#include "volumetric_gi/lpv/lpv_light.h"

namespace tyndall::volumetric_gi {
namespace {

LatticeLight readLight(fg::Builder& builder, const LatticeLight& light) {
    return {builder.read(light.red), builder.read(light.green), builder.read(light.blue)};
}

template <typename Command> Command& bindLight(Command& command, const LatticeLight& light) {
    return command.bind("redLight", light.red)
        .bind("greenLight", light.green)
        .bind("blueLight", light.blue);
}

} // namespace

LatticeLight addLatticeLight(fg::FrameGraph& graph, const gpu::LpvParams& params,
                             fg::BufferHandle medium, fg::BufferHandle sources,
                             fg::BufferHandle links, fg::BufferHandle flux) {
    struct Data {
        fg::BufferHandle medium, sources, links, flux;
        LatticeLight light;
        gpu::LpvParams params;
    };
    return graph
        .addPass<Data>(
            "gi.lpv.resolve",
            [&](fg::Builder& builder, Data& data) {
                data.medium = builder.read(medium);
                data.sources = builder.read(sources);
                data.links = builder.read(links);
                data.flux = builder.read(flux);
                const fg::TextureDesc desc =
                    fg::texture3D(fg::Format::RGBA32F, params.size.x, params.size.y, params.size.z);
                data.light = {builder.create("gi.lpv.red", desc),
                              builder.create("gi.lpv.green", desc),
                              builder.create("gi.lpv.blue", desc)};
                data.params = params;
            },
            [](const Data& data, fg::PassContext& context) {
                auto command = context.compute("gi/lpv/resolve.comp");
                command.params(data.params)
                    .bind("LpvMedium", data.medium)
                    .bind("LpvSources", data.sources)
                    .bind("LpvLinks", data.links)
                    .bind("LpvFlux", data.flux);
                bindLight(command, data.light).dispatchOver(data.light.red);
            })
        .light;
}

fg::TextureHandle addSurfaceLookup(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                   const gpu::LpvParams& params, fg::BufferHandle links,
                                   const LatticeLight& light) {
    struct Data {
        ViewResources view;
        GBuffer gbuffer;
        LatticeLight light;
        fg::BufferHandle links;
        fg::TextureHandle radiance;
        gpu::LpvParams params;
    };
    return graph
        .addPass<Data>(
            "gi.lpv.surfaces",
            [&](fg::Builder& builder, Data& data) {
                data.view = inputs.view;
                data.gbuffer.depth = builder.read(inputs.gbuffer.depth);
                data.gbuffer.normal = builder.read(inputs.gbuffer.normal);
                data.gbuffer.base = builder.read(inputs.gbuffer.base);
                data.gbuffer.material = builder.read(inputs.gbuffer.material);
                data.light = readLight(builder, light);
                data.links = builder.read(links);
                data.radiance = builder.create(
                    "gi.lpv.surfaceRadiance",
                    fg::texture2D(fg::Format::RGBA32F, inputs.view.width, inputs.view.height));
                data.params = params;
            },
            [](const Data& data, fg::PassContext& context) {
                auto command = context.compute("gi/lpv/surfaces.comp");
                bindView(command, data.view);
                bindLight(command, data.light)
                    .params(data.params)
                    .bind("LpvLinks", data.links)
                    .bind("gbufferDepth", data.gbuffer.depth)
                    .bind("gbufferNormal", data.gbuffer.normal)
                    .bind("gbufferBase", data.gbuffer.base)
                    .bind("gbufferMaterial", data.gbuffer.material)
                    .bind("surfaceRadiance", data.radiance)
                    .dispatchOver(data.radiance);
            })
        .radiance;
}

fg::TextureHandle addMediumLookup(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                  const gpu::LpvParams& params, fg::BufferHandle links,
                                  const LatticeLight& light) {
    struct Data {
        ViewResources view;
        MediaResources media;
        LatticeLight light;
        fg::BufferHandle links;
        fg::TextureHandle depth, inScatter;
        gpu::LpvParams params;
    };
    return graph
        .addPass<Data>(
            "gi.lpv.march",
            [&](fg::Builder& builder, Data& data) {
                if (inputs.media.count == 0) return builder.skip("no medium in the scene");
                data.view = inputs.view;
                data.media = readMedia(builder, inputs.media);
                data.depth = builder.read(inputs.gbuffer.depth);
                data.light = readLight(builder, light);
                data.links = builder.read(links);
                data.inScatter = builder.create(
                    "gi.lpv.inScatter",
                    fg::texture2D(fg::Format::RGBA32F, inputs.view.width, inputs.view.height));
                data.params = params;
            },
            [](const Data& data, fg::PassContext& context) {
                auto command = context.compute("gi/lpv/march.comp",
                                               {{"PHASE_GROUPS", int32_t(data.media.phaseGroups)},
                                                {"MEDIA_KINDS", mediaKinds(data.media, false)}});
                bindView(command, data.view);
                bindMedia(command, data.media);
                bindLight(command, data.light)
                    .params(data.params)
                    .bind("LpvLinks", data.links)
                    .bind("depth", data.depth)
                    .bind("inScatter", data.inScatter)
                    .dispatchOver(data.inScatter);
            })
        .inScatter;
}

} // namespace tyndall::volumetric_gi
