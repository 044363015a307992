#include "volumetric_gi/lpv/lpv_light.h"

namespace tyndall::volumetric_gi {
namespace {

LatticeLight readLight(fg::Builder& builder, const LatticeLight& light) {
    return {builder.read(light.red), builder.read(light.green), builder.read(light.blue),
            builder.read(light.sides)};
}

/// For shaders that include gi/lpv/lookup.glsl.
template <typename Command>
Command& bindLight(Command& command, const LatticeLight& light, const gpu::LpvLevels& levels) {
    return command.params(levels, "Levels")
        .bind("LpvLinks", light.sides)
        .bind("redLight", light.red)
        .bind("greenLight", light.green)
        .bind("blueLight", light.blue);
}

LatticeLight writeLight(fg::Builder& builder, const LatticeLight& light) {
    return {builder.write(light.red), builder.write(light.green), builder.write(light.blue),
            builder.write(light.sides)};
}

/// Light that media scatter to the eye: one ray for a square of `pixels` a side or, where there are `rays` of such squares, from them to every pixel.
fg::TextureHandle addMarch(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                           const gpu::LpvLevels& levels, const LatticeLight& light, int pixels,
                           fg::TextureHandle rays) {
    struct Data {
        ViewResources view;
        MediaResources media;
        LatticeLight light;
        fg::TextureHandle depth, transmittance, rays, inScatter;
        gpu::LpvLevels levels;
        gpu::MarchParams params;
    };
    const bool upsampled = bool(rays);
    const int factor = upsampled ? 1 : pixels;
    return graph
        .addPass<Data>(
            upsampled ? "gi.lpv.upsample" : "gi.lpv.march",
            [&](fg::Builder& builder, Data& data) {
                if (inputs.media.count == 0 || !inputs.transmittance)
                    return builder.skip("no medium in view");
                data.view = inputs.view;
                data.media = readMedia(builder, inputs.media);
                data.depth = builder.read(inputs.gbuffer.depth);
                data.light = readLight(builder, light);
                if (upsampled) {
                    data.transmittance = builder.read(inputs.transmittance);
                    data.rays = builder.read(rays);
                }
                data.inScatter = builder.create(
                    factor == 1 ? "gi.lpv.inScatter" : "gi.lpv.coarse.inScatter",
                    fg::texture2D(fg::Format::RGBA32F, (inputs.view.width + factor - 1) / factor,
                                  (inputs.view.height + factor - 1) / factor));
                data.levels = levels;
                data.params = inputs.march;
                data.params.factor = uint32_t(pixels);
            },
            [](const Data& data, fg::PassContext& context) {
                auto command =
                    context.compute(data.rays ? "gi/lpv/upsample.comp" : "gi/lpv/march.comp",
                                    {{"PHASE_GROUPS", int32_t(data.media.phaseGroups)},
                                     {"MEDIA_KINDS", mediaKinds(data.media, false)}});
                bindView(command, data.view);
                bindMedia(command, data.media);
                bindLight(command, data.light, data.levels)
                    .params(data.params)
                    .bind("depth", data.depth)
                    .bind("inScatter", data.inScatter);
                if (data.rays)
                    command.bind("transmittance", data.transmittance)
                        .bind("coarseInScatter", data.rays);
                command.dispatchOver(data.inScatter);
            })
        .inScatter;
}

} // namespace

LatticeLight createLight(fg::Builder& builder, const SharedPlaces& places) {
    const fg::TextureDesc desc =
        fg::texture3D(fg::Format::RGBA32F, places.across.x, places.across.y, places.layers);
    return {builder.create("gi.lpv.red", desc), builder.create("gi.lpv.green", desc),
            builder.create("gi.lpv.blue", desc),
            builder.create("gi.lpv.sides", fg::BufferDesc{places.links * sizeof(uint32_t)})};
}

LatticeLight addLatticeLight(fg::FrameGraph& graph, const Lattice& lattice,
                             const SharedPlaces& places, const LatticeLight& others) {
    struct Data {
        fg::BufferHandle medium, sources, links, flux;
        LatticeLight light;
        gpu::LpvParams params;
    };
    return graph
        .addPass<Data>(
            "gi.lpv.resolve",
            [&](fg::Builder& builder, Data& data) {
                data.medium = builder.read(lattice.medium);
                data.sources = builder.read(lattice.sources);
                data.links = builder.read(lattice.links);
                data.flux = builder.read(lattice.flux);
                data.light =
                    others.red ? writeLight(builder, others) : createLight(builder, places);
                data.params = lattice.level.params;
            },
            [](const Data& data, fg::PassContext& context) {
                context.compute("gi/lpv/resolve.comp")
                    .params(data.params)
                    .bind("LpvMedium", data.medium)
                    .bind("LpvSources", data.sources)
                    .bind("LpvLinks", data.links)
                    .bind("LpvFlux", data.flux)
                    .bind("LpvSides", data.light.sides)
                    .bind("redLight", data.light.red)
                    .bind("greenLight", data.light.green)
                    .bind("blueLight", data.light.blue)
                    .dispatchOver(uint32_t(data.params.grid.size.x),
                                  uint32_t(data.params.grid.size.y),
                                  uint32_t(data.params.grid.size.z));
            })
        .light;
}

fg::TextureHandle addSurfaceLookup(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                   const gpu::LpvLevels& levels, const LatticeLight& light) {
    struct Data {
        ViewResources view;
        GBuffer gbuffer;
        LatticeLight light;
        fg::TextureHandle radiance;
        gpu::LpvLevels levels;
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
                data.radiance = builder.create(
                    "gi.lpv.surfaceRadiance",
                    fg::texture2D(fg::Format::RGBA32F, inputs.view.width, inputs.view.height));
                data.levels = levels;
            },
            [](const Data& data, fg::PassContext& context) {
                auto command = context.compute("gi/lpv/surfaces.comp");
                bindView(command, data.view);
                bindLight(command, data.light, data.levels)
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
                                  const gpu::LpvLevels& levels, const LatticeLight& light,
                                  int pixels) {
    const fg::TextureHandle rays = addMarch(graph, inputs, levels, light, pixels, {});
    return !rays || pixels == 1 ? rays : addMarch(graph, inputs, levels, light, pixels, rays);
}

} // namespace tyndall::volumetric_gi
