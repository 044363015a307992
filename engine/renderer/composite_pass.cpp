#include "renderer/composite_pass.h"

#include <array>

#include "core/check.h"
#include "shared/post.h"

namespace tyndall {
namespace {

bool hasContent(const fg::FrameGraph& graph, fg::TextureHandle handle) {
    return handle && !graph.isAbsent(handle);
}

} // namespace

void TermImages::add(TermSet terms, fg::TextureHandle image, int owner) {
    CHECK(count < kMaxTermImages, "more term images than a frame holds");
    images[count++] = {terms, image, owner};
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

fg::TextureHandle addCompositePass(fg::FrameGraph& graph, const char* passName,
                                   const char* imageName, fg::TextureHandle radiance,
                                   fg::TextureHandle transmittance, fg::TextureHandle added) {
    struct Data {
        fg::TextureHandle radiance, transmittance, added, seen;
    };
    const bool throughMedia = hasContent(graph, transmittance);
    const Data& pass = graph.addPass<Data>(
        passName,
        [&](fg::Builder& builder, Data& data) {
            if (!throughMedia) return builder.skip("no medium between the eye and the surfaces");
            data.radiance = builder.read(radiance);
            data.transmittance = builder.read(transmittance);
            if (hasContent(graph, added)) data.added = builder.read(added);
            const fg::TextureDesc size = graph.desc(radiance);
            data.seen = builder.create(imageName,
                                       fg::texture2D(fg::Format::RGBA32F, size.width, size.height));
        },
        [](const Data& data, fg::PassContext& context) {
            auto command = context.compute("post/attenuate.comp", {{"ADD", data.added ? 1 : 0}});
            command.bind("radiance", data.radiance)
                .bind("transmittance", data.transmittance)
                .bind("seen", data.seen);
            if (data.added) command.bind("added", data.added);
            command.dispatchOver(data.seen);
        });
    return throughMedia ? pass.seen : radiance;
}

namespace {

/// Of up to so many images at once: texture units are few.
constexpr uint32_t kSummedAtOnce = 8;

struct SumData {
    std::array<fg::TextureHandle, kSummedAtOnce> images;
    uint32_t count = 0;
    fg::TextureHandle sum;
    fg::BufferHandle firstInvalid;
    bool startsAnew = false;
    gpu::SumParams params;

    /// What this pass made, after what was there before.
    [[nodiscard]] Sum result(const Sum& before) const {
        return {sum, count > 0 ? firstInvalid : before.firstInvalid};
    }
};

void executeSum(const SumData& data, fg::PassContext& context) {
    if (data.count == 0) {
        static constexpr float kBlack[4] = {0, 0, 0, 1};
        return context.clearTexture(data.sum, kBlack);
    }
    static constexpr const char* kNames[kSummedAtOnce] = {"image0", "image1", "image2", "image3",
                                                          "image4", "image5", "image6", "image7"};
    if (data.startsAnew) {
        context.clearBuffer(data.firstInvalid, 0);
        context.barrier(fg::Access::StorageWrite);
    }
    auto command = context.compute("post/sum.comp", {{"COUNT", int32_t(data.count)}});
    for (uint32_t i = 0; i < data.count; ++i) command.bind(kNames[i], data.images[i]);
    command.bind("sum", data.sum)
        .bind("FirstInvalid", data.firstInvalid)
        .params(data.params)
        .dispatchOver(data.sum);
}

} // namespace

Sum addSumPass(fg::FrameGraph& graph, const TermImages& images, const SumFrame& frame) {
    const fg::PersistentBuffer kept = graph.persistentBuffer(
        "picture.firstInvalid", fg::BufferDesc{kMaxTermImages * sizeof(uint32_t)});
    Sum result;
    uint32_t next = 0;
    do {
        result =
            graph
                .addPass<SumData>(
                    "sum",
                    [&](fg::Builder& builder, SumData& data) {
                        const bool first = !result.image;
                        data.params = {next, first ? 0u : 1u, frame.number, 0};
                        data.startsAnew = first && (frame.number == 1 || kept.wasReset);
                        if (!first) data.images[data.count++] = builder.read(result.image);
                        while (next < images.count && data.count < kSummedAtOnce)
                            data.images[data.count++] = builder.read(images.images[next++].image);
                        data.sum = builder.create(
                            "beauty", fg::texture2D(fg::Format::RGBA32F, frame.width, frame.height),
                            data.count > 0 ? fg::Access::StorageWrite : fg::Access::TransferWrite);
                        if (data.count == 0) return;
                        const fg::BufferHandle before =
                            result.firstInvalid ? result.firstInvalid : kept.handle;
                        builder.read(before);
                        data.firstInvalid = builder.write(before);
                    },
                    [](const SumData& data, fg::PassContext& context) {
                        executeSum(data, context);
                    })
                .result(result);
    } while (next < images.count);
    return result;
}

fg::TextureHandle addAccumulatePass(fg::FrameGraph& graph, const char* historyName,
                                    fg::TextureHandle image, uint32_t frame) {
    struct Data {
        fg::TextureHandle image, previous, current;
        gpu::AccumulateParams params;
    };
    const fg::TextureDesc size = graph.desc(image);
    const fg::TextureHistory history = graph.historyTexture(
        historyName, fg::texture2D(fg::Format::RGBA32F, size.width, size.height));
    CHECK(frame >= 1 && (frame == 1 || !history.wasReset),
          "an average of frames was lost: start again with frame 1");
    return graph
        .addPass<Data>(
            "accumulate",
            [&](fg::Builder& builder, Data& data) {
                data.image = builder.read(image);
                data.previous = builder.read(history.previous);
                data.current = builder.write(history.current);
                data.params = {1.0f / float(frame), frame, 0, 0};
            },
            [](const Data& data, fg::PassContext& context) {
                context.compute("post/accumulate.comp")
                    .bind("image", data.image)
                    .bind("previous", data.previous)
                    .bind("current", data.current)
                    .params(data.params)
                    .dispatchOver(data.current);
            })
        .current;
}

} // namespace tyndall
