#include "volumetric_gi/lpv/lpv_light.h"

#include "plugin/reduced_march.h"

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

constexpr LightMarchNames kMarchNames{"gi.lpv.march", "gi.lpv.upsample",
                                      "", // which marches pixels that no ray fits
                                      "gi.lpv.coarse.inScatter", "gi.lpv.inScatter"};

/// Light that media scatter to the eye.
fg::TextureHandle addMarch(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                           const gpu::LpvLevels& levels, const LatticeLight& light, int pixels,
                           MarchStage stage, fg::TextureHandle before) {
    struct Data {
        LightMarch march;
        LatticeLight light;
        gpu::LpvLevels levels;
    };
    return graph
        .addPass<Data>(
            kMarchNames.of(stage),
            [&](fg::Builder& builder, Data& data) {
                if (inputs.media.count == 0 || !inputs.transmittance)
                    return builder.skip("no medium in view");
                gpu::MarchParams params = inputs.march;
                params.factor = uint32_t(pixels);
                const MarchPass pass = readMarch(builder, stage, inputs.view, inputs.media,
                                                 inputs.gbuffer.depth, params);
                data.march =
                    declareLightMarch(builder, pass, inputs.transmittance, before, kMarchNames);
                data.light = readLight(builder, light);
                data.levels = levels;
            },
            [](const Data& data, fg::PassContext& context) {
                const MarchPass& pass = data.march.pass;
                auto command = context.compute(
                    pass.stage == MarchStage::Spread ? "gi/lpv/upsample.comp" : "gi/lpv/march.comp",
                    {{"PHASE_GROUPS", int32_t(pass.media.phaseGroups)},
                     {"MEDIA_KINDS", mediaKinds(pass.media, false)}});
                bindMedia(command, pass.media);
                bindLight(command, data.light, data.levels);
                bindLightMarch(command, data.march).dispatchOver(data.march.light);
            })
        .march.light;
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
                data.gbuffer = readGBuffer(builder, inputs.gbuffer);
                data.light = readLight(builder, light);
                data.radiance = builder.create(
                    "gi.lpv.surfaceRadiance",
                    fg::texture2D(fg::Format::RGBA32F, inputs.view.width, inputs.view.height));
                data.levels = levels;
            },
            [](const Data& data, fg::PassContext& context) {
                auto command = context.compute("gi/lpv/surfaces.comp");
                bindView(command, data.view);
                bindGBuffer(command, data.gbuffer);
                bindLight(command, data.light, data.levels)
                    .bind("surfaceRadiance", data.radiance)
                    .dispatchOver(data.radiance);
            })
        .radiance;
}

fg::TextureHandle addMediumLookup(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                  const gpu::LpvLevels& levels, const LatticeLight& light,
                                  int pixels) {
    return addMarchStages<fg::TextureHandle>(
        pixels, false, [&](MarchStage stage, fg::TextureHandle before) {
            return addMarch(graph, inputs, levels, light, pixels, stage, before);
        });
}

} // namespace tyndall::volumetric_gi
