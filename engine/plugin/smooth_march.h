#pragma once
// Marches in single frames: the pattern of the places at which rays gather light is averaged away over neighbouring rays (shaders/media/smooth.comp).

#include "plugin/frame_resources.h"
#include "shared/march.h"

namespace tyndall {

/// `light` (RGBA32F, one texel for each marched ray, or for each pixel with a `params.factor` of 1) averaged over 3×3 rays; `light` itself in averaged
/// frames, whose own mean is exact, and without kMarchSmooth. `transmittance`: of each ray, the same size. `name`: a literal, of the pass and its picture.
inline fg::TextureHandle addMarchSmoothing(fg::FrameGraph& graph, const char* name,
                                           const ViewResources& view, fg::TextureHandle depth,
                                           const gpu::MarchParams& params,
                                           fg::TextureHandle transmittance,
                                           fg::TextureHandle light) {
    struct Data {
        ViewResources view;
        gpu::MarchParams params;
        fg::TextureHandle depth, transmittance, light, smoothed;
    };
    if ((params.flags & gpu::kMarchSmooth) == 0 || (view.data.flags & gpu::kViewConverge) != 0)
        return light;
    return graph
        .addPass<Data>(
            name,
            [&](fg::Builder& builder, Data& data) {
                const int factor = int(params.factor);
                data = {view,
                        params,
                        builder.read(depth),
                        builder.read(transmittance),
                        builder.read(light),
                        builder.create(name, fg::texture2D(fg::Format::RGBA32F,
                                                           (view.width + factor - 1) / factor,
                                                           (view.height + factor - 1) / factor))};
            },
            [](const Data& data, fg::PassContext& context) {
                auto command = context.compute("media/smooth.comp");
                bindView(command, data.view).params(data.params);
                command.bind("depth", data.depth)
                    .bind("transmittance", data.transmittance)
                    .bind("inScatter", data.light)
                    .bind("smoothed", data.smoothed)
                    .dispatchOver(data.smoothed);
            })
        .smoothed;
}

} // namespace tyndall
