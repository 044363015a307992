#include "volumetric_gi/vpl/vpl_show.h"

namespace tyndall::volumetric_gi {

fg::TextureHandle addVplShow(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                             const VplSettings& settings, const VplBuffers& lights,
                             const gpu::VplParams& params, float radius,
                             const VplGathered& gathered, fg::TextureHandle color) {
    if (settings.show == 0 || !lights.lights) return color;
    struct Data {
        ViewResources view;
        VplBuffers lights;
        fg::TextureHandle color, depth, shown;
        fg::TextureHandle transmittance, surfaces, media;
        gpu::VplParams params;
        gpu::VplShowParams show;
    };
    return graph
        .addPass<Data>(
            "gi.vpl.show",
            [&](fg::Builder& builder, Data& data) {
                data.view = inputs.view;
                data.lights = readVpls(builder, lights);
                data.color = builder.read(color);
                data.depth = builder.read(inputs.gbuffer.depth);
                data.shown = builder.create("gi.vpl.shown", graph.desc(color));
                data.params = params;
                const auto readOf = [&](fg::TextureHandle texture) {
                    return texture && !graph.isAbsent(texture) ? builder.read(texture)
                                                               : fg::TextureHandle{};
                };
                data.transmittance = readOf(inputs.transmittance);
                data.surfaces = readOf(gathered.surfaces);
                data.media = readOf(gathered.media);
                data.show = {uint32_t(settings.show),
                             uint32_t(settings.showLight),
                             radius,
                             inputs.whiteNits,
                             data.transmittance ? 1u : 0u,
                             data.surfaces ? 1u : 0u,
                             data.media ? 1u : 0u,
                             0};
            },
            [](const Data& data, fg::PassContext& context) {
                auto command = context.compute("gi/vpl/show.comp");
                bindView(command, data.view);
                // The shader does not read it, but the binding must be valid.
                const auto orColor = [&](fg::TextureHandle texture) {
                    return texture ? texture : data.color;
                };
                bindVpls(command, data.lights, data.params)
                    .params(data.show, "Show")
                    .bind("color", data.color)
                    .bind("transmittance", orColor(data.transmittance))
                    .bind("lostOnSurfaces", orColor(data.surfaces))
                    .bind("lostInMedia", orColor(data.media))
                    .bind("depth", data.depth)
                    .bind("shown", data.shown)
                    .dispatchOver(data.shown);
            })
        .shown;
}

} // namespace tyndall::volumetric_gi
