#include "volumetric_gi/lpv/lpv_lattice.h"

#include <algorithm>

#include "plugin/cache_key.h"
#include "volumetric_gi/lpv/lattice_params.h"

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
                builder.cacheBy(cacheKey(level.key, inputs.scene.media));
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
                builder.cacheBy(cacheKey(level.key, inputs.scene.geometry));
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

namespace {

constexpr int kStepsBetweenLooks = 8; // between looks at the residual; even: light ends in the first buffer

struct StepsData {
    fg::BufferHandle medium, sources, links, flux[2], control, partials, lit;
    OuterBuffers outer;
    gpu::LpvParams params;
    gpu::LpvMeasureParams measure;
    StepsRequest request;
    ivec3 groups;
    bool restart, hasOuter;
    [[nodiscard]] uint64_t argumentsAt() const {
        return uint64_t(request.lattice) * sizeof(gpu::LpvControl);
    }
};

void recordFirstGuess(const StepsData& data, fg::PassContext& context) {
    gpu::LpvControl control{};
    for (int axis = 0; axis < 3; ++axis) control.groups[axis] = uint32_t(data.groups[axis]);
    context.upload(data.control, data.argumentsAt(), &control, sizeof control);
    if (data.hasOuter) {
        auto command = context.compute("gi/lpv/refine.comp");
        bindOuter(command, data.outer).params(data.params).bind("LpvFlux", data.flux[0]);
        dispatchOverCells(command, data.params.grid);
    } else {
        context.clearBuffer(data.flux[0], 0);
    }
    context.barrier(fg::Access::StorageRead);
    context.barrier(fg::Access::Indirect);
}

void recordStep(const StepsData& data, int step, fg::PassContext& context) {
    gpu::LpvParams params = data.params;
    params.grid.place.w = step < 2; // both buffers are written in full before blocks are left out
    context.compute("gi/lpv/propagate.comp")
        .params(params)
        .bind("LpvMedium", data.medium)
        .bind("LpvSources", data.sources)
        .bind("LpvLinks", data.links)
        .bind("LpvFlux", data.flux[step % 2])
        .bind("LpvSent", data.flux[1 - step % 2])
        .bind("LpvLit", data.lit)
        .dispatchIndirect(data.control, data.argumentsAt());
    context.barrier(fg::Access::StorageRead);
}

/// After an even number of steps: the last one's result is in the first buffer.
void recordLook(const StepsData& data, bool ledger, fg::PassContext& context) {
    auto command = context.compute("gi/lpv/measure.comp", {{"LEDGER", ledger}});
    command.params(data.params)
        .bind("LpvMedium", data.medium)
        .bind("LpvSources", data.sources)
        .bind("LpvLinks", data.links)
        .bind("LpvFlux", data.flux[1])
        .bind("LpvSent", data.flux[0])
        .bind("LpvPartials", data.partials);
    if (ledger)
        command.dispatch(uint32_t(data.groups.x), uint32_t(data.groups.y), uint32_t(data.groups.z));
    else
        command.dispatchIndirect(data.control, data.argumentsAt());
    context.barrier(fg::Access::StorageRead);
    context.compute("gi/lpv/conclude.comp", {{"LEDGER", ledger}})
        .params(data.measure, "Measure")
        .bind("LpvPartials", data.partials)
        .bind("LpvControls", data.control)
        .dispatch(1);
    context.barrier(fg::Access::StorageRead);
    context.barrier(fg::Access::Indirect);
}

void recordSteps(const StepsData& data, fg::PassContext& context) {
    context.clearBuffer(data.lit, 0);
    context.barrier(fg::Access::StorageWrite);
    if (data.restart) recordFirstGuess(data, context);
    for (int step = 0; step < data.request.most; ++step) {
        recordStep(data, step, context);
        if ((step + 1) % kStepsBetweenLooks == 0) recordLook(data, false, context);
    }
    if (data.request.ledger) recordLook(data, true, context);
}

} // namespace

Flux addSteps(fg::FrameGraph& graph, const Lattice& lattice, const Lattice* outer,
              const StepsRequest& request, fg::BufferHandle& control) {
    static constexpr const char* kNames[gpu::kLpvMostLevels][2] = {
        {"gi.lpv.flux", "gi.lpv.flux.other"},
        {"gi.lpv.flux1", "gi.lpv.flux1.other"},
        {"gi.lpv.flux2", "gi.lpv.flux2.other"},
        {"gi.lpv.flux3", "gi.lpv.flux3.other"}};
    const auto& names = kNames[request.lattice];
    const fg::BufferDesc desc{lattice.level.cells * gpu::kLpvFluxPlanes * sizeof(float)};
    const fg::PersistentBuffer here = graph.persistentBuffer(names[0], desc),
                               there = graph.persistentBuffer(names[1], desc);
    const StepsData& pass = graph.addPass<StepsData>(
        "gi.lpv.propagate",
        [&](fg::Builder& builder, StepsData& data) {
            data.medium = builder.read(lattice.medium);
            data.sources = builder.read(lattice.sources);
            data.links = builder.read(lattice.links);
            data.flux[0] = builder.write(here.handle);
            data.flux[1] = builder.write(there.handle);
            data.control = builder.write(control);
            data.params = lattice.level.params;
            const ivec3 size(data.params.grid.size);
            data.groups = blocksOf(size);
            data.measure = {uint32_t(request.lattice),
                            uint32_t(data.groups.x * data.groups.y * data.groups.z),
                            float(kStepsBetweenLooks), request.tolerance};
            data.lit = builder.create("gi.lpv.lit",
                                      fg::BufferDesc{data.measure.groups * sizeof(uint32_t)});
            data.partials = builder.create("gi.lpv.partials",
                                           fg::BufferDesc{data.measure.groups * 7 * sizeof(float)});
            data.request = request;
            data.request.most =
                (request.most + kStepsBetweenLooks - 1) / kStepsBetweenLooks * kStepsBetweenLooks;
            data.hasOuter = outer != nullptr;
            if (outer) data.outer = readOuter(builder, *outer);
            data.restart = here.wasReset || there.wasReset || !request.goOn;
        },
        [](const StepsData& data, fg::PassContext& context) { recordSteps(data, context); });
    control = pass.control;
    return {pass.flux[0], pass.flux[1]};
}

} // namespace tyndall::volumetric_gi
