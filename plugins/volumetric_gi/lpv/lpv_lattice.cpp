#include "volumetric_gi/lpv/lpv_lattice.h"

#include <algorithm>

#include "framegraph/hash.h"

namespace tyndall::volumetric_gi {
namespace {

/// One thread a cell.
template <typename Command> void dispatchOverCells(Command& command, const gpu::LpvGrid& grid) {
    command.dispatchOver(uint32_t(grid.size.x), uint32_t(grid.size.y), uint32_t(grid.size.z));
}

/// The coarser lattice for shaders that include gi/lpv/outer.glsl.
struct OuterBuffers {
    gpu::LpvGrid grid;
    fg::BufferHandle links, flux;
};

OuterBuffers readOuter(fg::Builder& builder, const Lattice& outer) {
    OuterBuffers b{outer.level.params.grid, builder.read(outer.links), builder.read(outer.flux)};
    b.grid.place = {0, 0, 0, 0}; // its own links, not the shared ones
    return b;
}

template <typename Command> Command& bindOuter(Command& command, const OuterBuffers& outer) {
    return command.params(outer.grid, "Outer")
        .bind("LpvLinks", outer.links)
        .bind("LpvOuterFlux", outer.flux);
}

} // namespace

fg::BufferHandle addLatticeMedium(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                  const LatticeLevel& level) {
    struct Data {
        MediaResources media;
        fg::BufferHandle medium;
        gpu::LpvParams params;
    };
    return graph
        .addPass<Data>(
            "gi.lpv.medium",
            [&](fg::Builder& builder, Data& data) {
                data.media = inputs.media;
                if (inputs.media.count > 0) data.media = readMedia(builder, inputs.media);
                data.medium =
                    builder.create("gi.lpv.medium", fg::BufferDesc{level.cells * sizeof(vec4) *
                                                                   gpu::kLpvMediumVectors});
                data.params = level.params;
                builder.cacheBy(fg::mixHash(level.key, inputs.scene.media));
            },
            [](const Data& data, fg::PassContext& context) {
                auto command =
                    context.compute("gi/lpv/medium.comp", {{"MEDIA", data.media.count > 0}});
                if (data.media.count > 0) bindMedia(command, data.media);
                command.params(data.params)
                    .bind("LpvMedium", data.medium)
                    .dispatchOver(uint32_t(data.params.grid.size.x),
                                  uint32_t(data.params.grid.size.y),
                                  uint32_t(data.params.grid.size.z));
            })
        .medium;
}

fg::BufferHandle addLatticeLinks(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                                 const LatticeLevel& level) {
    struct Data {
        fg::BufferHandle links;
        const plugin::SurfaceDrawer* surfaces;
        gpu::LpvParams params;
    };
    return graph
        .addPass<Data>(
            "gi.lpv.links",
            [&](fg::Builder& builder, Data& data) {
                data.links =
                    builder.create("gi.lpv.links", fg::BufferDesc{level.cells * sizeof(uint32_t) *
                                                                  gpu::kLpvLinkPlanes});
                data.surfaces = inputs.surfaces;
                data.params = level.params;
                builder.cacheBy(fg::mixHash(level.key, inputs.scene.geometry));
            },
            [](const Data& data, fg::PassContext& context) {
                context.clearBuffer(data.links, 0);
                context.barrier(fg::Access::StorageWrite);
                for (uint32_t i = 0; i < data.surfaces->triangleSetCount(); ++i) {
                    const plugin::SurfaceTriangles set = data.surfaces->triangles(i);
                    if (set.triangleCount == 0) continue;
                    constexpr uint32_t kMostGroups = 32768; // along one axis; GL promises 65,535
                    context.compute("gi/lpv/links.comp")
                        .params(data.params)
                        .params(
                            gpu::LpvTriangles{set.strideFloats, set.triangleCount, set.object, 0},
                            "Triangles")
                        .bind("Vertices", set.vertices)
                        .bind("Indices", set.indices)
                        .bind("Objects", data.surfaces->objects())
                        .bind("Materials", data.surfaces->materials())
                        .bind("baseColorTexture", set.baseColor)
                        .bind("LpvLinks", data.links)
                        .dispatch(std::min(set.triangleCount, kMostGroups),
                                  (set.triangleCount + kMostGroups - 1) / kMostGroups);
                }
            })
        .links;
}

fg::BufferHandle addInflow(fg::FrameGraph& graph, const Lattice& lattice, const Lattice& outer) {
    struct Data {
        OuterBuffers outer;
        fg::BufferHandle links, sources;
        gpu::LpvParams params;
    };
    return graph
        .addPass<Data>(
            "gi.lpv.inflow",
            [&](fg::Builder& builder, Data& data) {
                data.outer = readOuter(builder, outer);
                data.links = builder.read(lattice.links);
                data.sources = builder.write(lattice.sources);
                data.params = lattice.level.params;
            },
            [](const Data& data, fg::PassContext& context) {
                auto command = context.compute("gi/lpv/inflow.comp");
                bindOuter(command, data.outer)
                    .params(data.params)
                    .bind("LpvOwnLinks", data.links)
                    .bind("LpvSources", data.sources);
                dispatchOverCells(command, data.params.grid);
            })
        .sources;
}

fg::BufferHandle addSteps(fg::FrameGraph& graph, const Lattice& lattice, const Lattice* outer,
                          int index, int steps, bool goOn) {
    static constexpr const char* kNames[gpu::kLpvMostLevels][2] = {
        {"gi.lpv.flux", "gi.lpv.flux.other"},
        {"gi.lpv.flux1", "gi.lpv.flux1.other"},
        {"gi.lpv.flux2", "gi.lpv.flux2.other"},
        {"gi.lpv.flux3", "gi.lpv.flux3.other"}};
    const fg::BufferDesc desc{lattice.level.cells * gpu::kLpvFluxPlanes * sizeof(float)};
    const fg::PersistentBuffer here = graph.persistentBuffer(kNames[index][0], desc),
                               there = graph.persistentBuffer(kNames[index][1], desc);
    struct Data {
        fg::BufferHandle medium, sources, links, flux[2];
        OuterBuffers outer;
        gpu::LpvParams params;
        int steps;
        bool restart, hasOuter;
    };
    return graph
        .addPass<Data>(
            "gi.lpv.propagate",
            [&](fg::Builder& builder, Data& data) {
                data.medium = builder.read(lattice.medium);
                data.sources = builder.read(lattice.sources);
                data.links = builder.read(lattice.links);
                data.flux[0] = builder.write(here.handle);
                data.flux[1] = builder.write(there.handle);
                data.hasOuter = outer != nullptr;
                if (outer) data.outer = readOuter(builder, *outer);
                data.params = lattice.level.params;
                data.steps = (steps + 1) / 2 * 2; // ends in the first buffer
                data.restart = here.wasReset || there.wasReset || !goOn;
            },
            [](const Data& data, fg::PassContext& context) {
                if (data.restart && data.hasOuter) {
                    auto command = context.compute("gi/lpv/refine.comp");
                    bindOuter(command, data.outer)
                        .params(data.params)
                        .bind("LpvFlux", data.flux[0]);
                    dispatchOverCells(command, data.params.grid);
                } else if (data.restart) {
                    context.clearBuffer(data.flux[0], 0);
                }
                context.barrier(fg::Access::StorageRead);
                for (int step = 0; step < data.steps; ++step) {
                    auto command = context.compute("gi/lpv/propagate.comp");
                    command.params(data.params)
                        .bind("LpvMedium", data.medium)
                        .bind("LpvSources", data.sources)
                        .bind("LpvLinks", data.links)
                        .bind("LpvFlux", data.flux[step % 2])
                        .bind("LpvSent", data.flux[1 - step % 2]);
                    dispatchOverCells(command, data.params.grid);
                    context.barrier(fg::Access::StorageRead);
                }
            })
        .flux[0];
}

} // namespace tyndall::volumetric_gi
