#include "renderer/composite_pass.h"

#include "core/check.h"
#include "shared/post.h"

namespace tyndall {
namespace {

bool hasContent(const fg::FrameGraph& graph, fg::TextureHandle handle) { return handle && !graph.isAbsent(handle); }

} // namespace

void TermImages::add(TermSet terms, fg::TextureHandle image) {
    CHECK(count < kMaxTermImages, "more term images than a frame holds");
    images[count++] = {terms, image};
}

fg::TextureHandle TermImages::find(Term term) const {
    for (uint32_t i = 0; i < count; ++i)
        if (images[i].terms == bit(term)) return images[i].image;
    return {};
}

void TermImages::replace(Term term, fg::TextureHandle image) {
    for (uint32_t i = 0; i < count; ++i)
        if (images[i].terms == bit(term)) images[i].image = image;
}

DirectImages addCompositePass(fg::FrameGraph& graph, const CompositeInputs& inputs) {
    struct Data { fg::TextureHandle surfaceEmission, surfaceDirect, transmittance, mediumEmission, emission, direct; bool emits; };
    if (!hasContent(graph, inputs.transmittance)) {
        graph.addPass<Data>("composite", [](fg::Builder& builder, Data&) { builder.skip("no medium between the eye and the surfaces"); },
                            [](const Data&, fg::PassContext&) {});
        return {inputs.surfaceEmission, inputs.surfaceDirect};
    }
    const Data& pass = graph.addPass<Data>("composite",
        [&](fg::Builder& builder, Data& data) {
            data.emits = hasContent(graph, inputs.mediumEmission);
            data.surfaceEmission = builder.read(inputs.surfaceEmission);
            data.surfaceDirect = builder.read(inputs.surfaceDirect);
            data.transmittance = builder.read(inputs.transmittance);
            if (data.emits) data.mediumEmission = builder.read(inputs.mediumEmission);
            const fg::TextureDesc size = graph.desc(inputs.surfaceEmission);
            data.emission = builder.create("term.LE", fg::texture2D(fg::Format::RGBA32F, size.width, size.height));
            data.direct = builder.create("term.LSE", fg::texture2D(fg::Format::RGBA32F, size.width, size.height));
        },
        [](const Data& data, fg::PassContext& context) {
            auto command = context.compute("post/composite.comp", {{"EMISSION", data.emits}});
            command.bind("surfaceEmission", data.surfaceEmission).bind("surfaceDirect", data.surfaceDirect)
                .bind("transmittance", data.transmittance).bind("imageLE", data.emission).bind("imageLSE", data.direct);
            if (data.emits) command.bind("mediumEmission", data.mediumEmission);
            command.dispatchOver(data.emission);
        });
    return {pass.emission, pass.direct};
}

fg::TextureHandle addAttenuatePass(fg::FrameGraph& graph, const char* name, fg::TextureHandle radiance, fg::TextureHandle transmittance) {
    struct Data { fg::TextureHandle radiance, transmittance, attenuated; };
    if (!hasContent(graph, transmittance)) return radiance;
    return graph.addPass<Data>(name,
        [&](fg::Builder& builder, Data& data) {
            data.radiance = builder.read(radiance);
            data.transmittance = builder.read(transmittance);
            data.attenuated = builder.create("term.indirectOnSurfaces", graph.desc(radiance));
        },
        [](const Data& data, fg::PassContext& context) {
            context.compute("post/attenuate.comp").bind("radiance", data.radiance).bind("transmittance", data.transmittance)
                .bind("attenuated", data.attenuated).dispatchOver(data.attenuated);
        }).attenuated;
}

fg::TextureHandle addSumPass(fg::FrameGraph& graph, const TermImages& images) {
    struct Data { TermImages images; fg::TextureHandle sum; };
    CHECK(images.count > 0, "a frame needs at least one term");
    return graph.addPass<Data>("sum",
        [&](fg::Builder& builder, Data& data) {
            data.images = images;
            for (uint32_t i = 0; i < images.count; ++i) data.images.images[i].image = builder.read(images.images[i].image);
            const fg::TextureDesc size = graph.desc(images.images[0].image);
            data.sum = builder.create("beauty", fg::texture2D(fg::Format::RGBA32F, size.width, size.height));
        },
        [](const Data& data, fg::PassContext& context) {
            static constexpr const char* kNames[kMaxTermImages] = {"image0", "image1", "image2", "image3", "image4", "image5", "image6", "image7"};
            auto command = context.compute("post/sum.comp", {{"COUNT", int32_t(data.images.count)}});
            for (uint32_t i = 0; i < data.images.count; ++i) command.bind(kNames[i], data.images.images[i].image);
            command.bind("sum", data.sum).dispatchOver(data.sum);
        }).sum;
}

fg::TextureHandle addAccumulatePass(fg::FrameGraph& graph, const char* historyName, fg::TextureHandle image, uint32_t frame) {
    struct Data { fg::TextureHandle image, previous, current; gpu::AccumulateParams params; };
    const fg::TextureDesc size = graph.desc(image);
    const fg::TextureHistory history = graph.historyTexture(historyName, fg::texture2D(fg::Format::RGBA32F, size.width, size.height));
    CHECK(frame >= 1 && (frame == 1 || !history.wasReset), "an average of frames was lost: start again with frame 1");
    return graph.addPass<Data>("accumulate",
        [&](fg::Builder& builder, Data& data) {
            data.image = builder.read(image);
            data.previous = builder.read(history.previous);
            data.current = builder.write(history.current);
            data.params = {1.0f / float(frame), frame, 0, 0};
        },
        [](const Data& data, fg::PassContext& context) {
            context.compute("post/accumulate.comp").bind("image", data.image).bind("previous", data.previous).bind("current", data.current)
                .params(data.params).dispatchOver(data.current);
        }).current;
}

} // namespace tyndall
