#include "volumetric_gi/lpv/lpv_show.h"

#include <algorithm>

namespace tyndall::volumetric_gi {

fg::TextureHandle addLatticeSlice(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                  const LpvSettings& settings, const Lattice& lattice,
                                  const LatticeLight& light, fg::TextureHandle color) {
    if (settings.show == 0 || !lattice.flux) return color;
    struct Data {
        ViewResources view;
        Lattice lattice;
        LatticeLight light;
        fg::TextureHandle color, depth, shown;
        gpu::LpvShowParams show;
    };
    return graph
        .addPass<Data>(
            "gi.lpv.show",
            [&](fg::Builder& builder, Data& data) {
                data.view = inputs.view;
                data.lattice.level = lattice.level;
                data.lattice.medium = builder.read(lattice.medium);
                data.lattice.links = builder.read(lattice.links);
                data.lattice.sources = builder.read(lattice.sources);
                data.lattice.flux = builder.read(lattice.flux);
                data.lattice.fluxBefore = builder.read(lattice.fluxBefore);
                data.light.red = builder.read(light.red);
                data.light.green = builder.read(light.green);
                data.light.blue = builder.read(light.blue);
                data.color = builder.read(color);
                data.depth = builder.read(inputs.gbuffer.depth);
                data.shown = builder.create("gi.lpv.shown", graph.desc(color));
                const int layers = lattice.level.params.grid.size[settings.showAxis];
                data.show = {uint32_t(settings.show), settings.showAxis,
                             std::min(int(settings.showAt * float(layers)), layers - 1),
                             inputs.whiteNits};
            },
            [](const Data& data, fg::PassContext& context) {
                auto command = context.compute("gi/lpv/show.comp");
                bindView(command, data.view)
                    .params(data.lattice.level.params)
                    .params(data.show, "Show")
                    .bind("LpvMedium", data.lattice.medium)
                    .bind("LpvLinks", data.lattice.links)
                    .bind("LpvSources", data.lattice.sources)
                    .bind("LpvFlux", data.lattice.fluxBefore)
                    .bind("LpvSent", data.lattice.flux)
                    .bind("redLight", data.light.red)
                    .bind("greenLight", data.light.green)
                    .bind("blueLight", data.light.blue)
                    .bind("color", data.color)
                    .bind("depth", data.depth)
                    .bind("shown", data.shown)
                    .dispatchOver(data.shown);
            })
        .shown;
}

} // namespace tyndall::volumetric_gi
