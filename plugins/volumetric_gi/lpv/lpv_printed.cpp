#include "volumetric_gi/lpv/lpv_printed.h"

#include <algorithm>

#include "volumetric_gi/lpv/lattice_params.h"

namespace tyndall::volumetric_gi {
namespace {

struct PrintedData {
    fg::BufferHandle medium, sources, links, radiance[2], sum, control, partials;
    gpu::LpvParams params;
    gpu::LpvTransfer transfer;
    ivec3 groups;
    int steps;
};

/// For shaders that include gi/lpv/printed.glsl.
template <typename Command>
Command& bindPrinted(Command& command, const PrintedData& data, fg::BufferHandle radiance) {
    return command.params(data.params)
        .params(data.transfer, "Transfer")
        .bind("LpvMedium", data.medium)
        .bind("LpvLinks", data.links)
        .bind("LpvRadiance", radiance);
}

/// Energy balance of the last step; its result is in radiance[steps % 2].
void recordLedger(const PrintedData& data, fg::PassContext& context) {
    auto measure = context.compute("gi/lpv/printed_measure.comp");
    bindPrinted(measure, data, data.radiance[1 - data.steps % 2])
        .bind("LpvNext", data.radiance[data.steps % 2])
        .bind("LpvPartials", data.partials)
        .dispatch(uint32_t(data.groups.x), uint32_t(data.groups.y), uint32_t(data.groups.z));
    gpu::LpvControl control{};
    control.steps = float(data.steps);
    control.error = -1; // unknown: the scheme does not settle
    context.upload(data.control, 0, &control, sizeof control);
    context.barrier(fg::Access::StorageRead);
    const gpu::LpvMeasureParams params{0, uint32_t(data.groups.x * data.groups.y * data.groups.z),
                                       1, 0};
    context.compute("gi/lpv/conclude.comp", {{"LEDGER", 1}})
        .params(params, "Measure")
        .bind("LpvPartials", data.partials)
        .bind("LpvControls", data.control)
        .dispatch(1);
}

void recordPrinted(const PrintedData& data, fg::PassContext& context) {
    const ivec3 size(data.params.grid.size);
    context.compute("gi/lpv/printed_start.comp")
        .params(data.params)
        .bind("LpvSources", data.sources)
        .bind("LpvNext", data.radiance[0])
        .bind("LpvSum", data.sum)
        .dispatchOver(uint32_t(size.x * size.y * size.z));
    context.barrier(fg::Access::StorageRead);
    for (int step = 0; step < data.steps; ++step) {
        auto command = context.compute("gi/lpv/printed_step.comp");
        bindPrinted(command, data, data.radiance[step % 2])
            .bind("LpvNext", data.radiance[1 - step % 2])
            .bind("LpvSum", data.sum)
            .dispatchOver(uint32_t(size.x), uint32_t(size.y), uint32_t(size.z));
        context.barrier(fg::Access::StorageRead);
    }
    recordLedger(data, context);
}

const PrintedData& addPrintedSteps(fg::FrameGraph& graph, const Lattice& lattice, int steps,
                                   fg::BufferHandle control) {
    return graph.addPass<PrintedData>(
        "gi.lpv.printed",
        [&](fg::Builder& builder, PrintedData& data) {
            data.medium = builder.read(lattice.medium);
            data.sources = builder.read(lattice.sources);
            data.links = builder.read(lattice.links);
            const fg::BufferDesc desc{lattice.level.cells * 3 * sizeof(vec4)};
            data.radiance[0] = builder.create("gi.lpv.radiance", desc);
            data.radiance[1] = builder.create("gi.lpv.radiance.other", desc);
            data.sum = builder.create("gi.lpv.radiance.sum", desc);
            data.control = builder.write(control);
            data.params = lattice.level.params;
            data.transfer = latticeTransfer();
            data.groups = blocksOf(ivec3(data.params.grid.size));
            data.partials = builder.create(
                "gi.lpv.partials",
                fg::BufferDesc{uint64_t(data.groups.x * data.groups.y * data.groups.z) * 7 *
                               sizeof(float)});
            data.steps = steps;
        },
        [](const PrintedData& data, fg::PassContext& context) { recordPrinted(data, context); });
}

} // namespace

LatticeLight addPrintedLight(fg::FrameGraph& graph, const Lattice& lattice,
                             const SharedPlaces& places, int steps, fg::BufferHandle& control) {
    const PrintedData& printed = addPrintedSteps(graph, lattice, std::max(steps, 1), control);
    control = printed.control;
    struct Data {
        PrintedData printed;
        LatticeLight light;
    };
    return graph
        .addPass<Data>(
            "gi.lpv.resolve",
            [&](fg::Builder& builder, Data& data) {
                data.printed = printed;
                data.printed.medium = builder.read(printed.medium);
                data.printed.links = builder.read(printed.links);
                data.printed.sum = builder.read(printed.sum);
                data.light = createLight(builder, places);
            },
            [](const Data& data, fg::PassContext& context) {
                const ivec3 size(data.printed.params.grid.size);
                auto command = context.compute("gi/lpv/printed_resolve.comp");
                bindPrinted(command, data.printed, data.printed.sum)
                    .bind("LpvSides", data.light.sides)
                    .bind("redLight", data.light.red)
                    .bind("greenLight", data.light.green)
                    .bind("blueLight", data.light.blue)
                    .dispatchOver(uint32_t(size.x), uint32_t(size.y), uint32_t(size.z));
            })
        .light;
}

} // namespace tyndall::volumetric_gi
