#include "volumetric_gi/lpv/lpv_injection.h"

namespace tyndall::volumetric_gi {
namespace {

struct InjectData {
    ViewResources view;
    LightResources lights;
    MediaResources media;
    GBuffer surfaces;
    Injection injection;
    bool scatter, reflect;
};

void recordInject(const InjectData& data, fg::PassContext& context) {
    const bool media = data.media.count > 0;
    auto command =
        context.compute("gi/lpv/inject.comp",
                        {{"MEDIA", media}, {"SCATTER", data.scatter}, {"REFLECT", data.reflect}});
    bindView(command, data.view);
    command.bind("Lights", data.lights.lights);
    if (media) bindMedia(command, data.media);
    bindGBuffer(command, data.surfaces)
        .params(data.injection.params)
        .params(data.injection.inject, "Inject")
        .bind("LpvMedium", data.injection.medium)
        .bind("LpvLinks", data.injection.links)
        .bind("LpvDeposits", data.injection.deposits)
        .dispatchOver(uint32_t(data.view.width), uint32_t(data.view.height));
}

} // namespace

fg::PersistentBuffer keptDeposits(fg::FrameGraph& graph, int index, uint64_t cells) {
    static constexpr const char* kNames[gpu::kLpvMostLevels] = {
        "gi.lpv.deposits", "gi.lpv.deposits1", "gi.lpv.deposits2", "gi.lpv.deposits3"};
    return graph.persistentBuffer(kNames[index],
                                  fg::BufferDesc{cells * gpu::kLpvDepositPlanes * sizeof(int32_t)});
}

fg::BufferHandle addClear(fg::FrameGraph& graph, fg::BufferHandle deposits) {
    struct Data {
        fg::BufferHandle deposits;
    };
    return graph
        .addPass<Data>(
            "gi.lpv.clear",
            [&](fg::Builder& builder, Data& data) {
                data.deposits = builder.write(deposits, fg::Access::TransferWrite);
            },
            [](const Data& data, fg::PassContext& context) {
                context.clearBuffer(data.deposits, 0);
            })
        .deposits;
}

Rsm addRsm(fg::FrameGraph& graph, const plugin::FrameInputs& inputs, const RsmView& from) {
    Rsm rsm;
    rsm.surfaces = inputs.surfaces->addGBuffer(graph, "gi.rsm", from.view, rsm.view);
    rsm.from = from;
    return rsm;
}

fg::BufferHandle addInjection(fg::FrameGraph& graph, const plugin::FrameInputs& inputs,
                              const LpvSettings& settings, const Rsm& rsm,
                              const Injection& injection) {
    return graph
        .addPass<InjectData>(
            "gi.lpv.inject",
            [&](fg::Builder& builder, InjectData& data) {
                data.view = rsm.view;
                data.lights.lights = builder.read(inputs.lights.lights);
                data.media = inputs.media;
                if (inputs.media.count > 0) data.media = readMedia(builder, inputs.media);
                data.surfaces = readGBuffer(builder, rsm.surfaces);
                data.injection = injection;
                data.injection.inject.light = rsm.from.light;
                data.injection.inject.share = rsm.from.share;
                data.injection.inject.texelArea = rsm.from.texelArea;
                data.injection.medium = builder.read(injection.medium);
                data.injection.links = builder.read(injection.links);
                data.injection.deposits = builder.write(injection.deposits);
                data.scatter = settings.scattered && inputs.media.count > 0;
                data.reflect = settings.reflected;
            },
            [](const InjectData& data, fg::PassContext& context) { recordInject(data, context); })
        .injection.deposits;
}

fg::BufferHandle addCollection(fg::FrameGraph& graph, const Injection& injection, uint64_t cells) {
    struct Data {
        Injection injection;
        fg::BufferHandle sources;
        uint32_t cells;
    };
    return graph
        .addPass<Data>(
            "gi.lpv.collect",
            [&](fg::Builder& builder, Data& data) {
                data.injection = injection;
                data.injection.deposits = builder.read(injection.deposits);
                data.sources =
                    builder.create("gi.lpv.sources",
                                   fg::BufferDesc{cells * sizeof(vec4) * gpu::kLpvSourceVectors});
                data.cells = uint32_t(cells);
            },
            [](const Data& data, fg::PassContext& context) {
                context.compute("gi/lpv/collect.comp")
                    .params(data.injection.params)
                    .params(data.injection.inject, "Inject")
                    .bind("LpvDeposits", data.injection.deposits)
                    .bind("LpvSources", data.sources)
                    .dispatchOver(data.cells);
            })
        .sources;
}

} // namespace tyndall::volumetric_gi
