#include "volumetric_gi/vpl/vpl_show.h"

namespace tyndall::volumetric_gi {

fg::TextureHandle addVplShow(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                             const VplSettings& settings, const VplBuffers& lights,
                             const gpu::VplParams& params, float radius, fg::TextureHandle color) {
    if (settings.show == 0 || !lights.lights) return color;
    struct Data {
        ViewResources view;
        VplBuffers lights;
        fg::TextureHandle color, depth, shown;
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
                data.show = {uint32_t(settings.show), uint32_t(settings.showLight), radius,
                             inputs.whiteNits};
            },
            [](const Data& data, fg::PassContext& context) {
                auto command = context.compute("gi/vpl/show.comp");
                bindView(command, data.view);
                bindVpls(command, data.lights, data.params)
                    .params(data.show, "Show")
                    .bind("color", data.color)
                    .bind("depth", data.depth)
                    .bind("shown", data.shown)
                    .dispatchOver(data.shown);
            })
        .shown;
}

} // namespace tyndall::volumetric_gi
