#include "renderer/march_smoothing_pass.h"

namespace tyndall {

fg::TextureHandle addMarchSmoothingPass(fg::FrameGraph& graph, const ViewResources& view,
                                        const gpu::MarchParams& params, const MarchedLight& light) {
    struct Data {
        ViewResources view;
        gpu::MarchParams params;
        MarchedLight light;
        fg::TextureHandle smoothed;
    };
    if ((params.flags & gpu::kMarchSmooth) == 0 || (view.data.flags & gpu::kViewConverge) != 0)
        return light.inScatter;
    return graph
        .addPass<Data>(
            "media.smooth",
            [&](fg::Builder& builder, Data& data) {
                const int factor = int(params.factor);
                data.view = view;
                data.params = params;
                data.light = {builder.read(light.depth), builder.read(light.transmittance),
                              builder.read(light.inScatter)};
                data.smoothed = builder.create(
                    factor > 1 ? "media.coarse.smooth" : "term.LVE.smooth",
                    fg::texture2D(fg::Format::RGBA32F, (view.width + factor - 1) / factor,
                                  (view.height + factor - 1) / factor));
            },
            [](const Data& data, fg::PassContext& context) {
                auto command = context.compute("media/smooth.comp");
                bindView(command, data.view).params(data.params);
                command.bind("depth", data.light.depth)
                    .bind("transmittance", data.light.transmittance)
                    .bind("inScatter", data.light.inScatter)
                    .bind("smoothed", data.smoothed)
                    .dispatchOver(data.smoothed);
            })
        .smoothed;
}

} // namespace tyndall
