#include "renderer/tonemap_pass.h"

#include <cmath>

namespace tyndall {
namespace {

const SettingDesc kPostSettings[] = {
    TYNDALL_ENUM(PostSettings, curve, "post.toneCurve", "Tone curve", kToneCurveNames,
                 kDefaultToneCurve,
                 "Maps light to the display: linear (clipped), ACES, AgX or Khronos PBR Neutral."),
    TYNDALL_BOOL(PostSettings, dither, "post.dither", "Dither", true,
                 "Adds noise of one 8-bit step to hide banding in smooth gradients."),
    TYNDALL_FLOAT(
        PostSettings, exposureCompensation, "post.exposureCompensation", "Exposure compensation",
        "EV", -20, 20, 0,
        "Brightens (positive) or darkens the displayed image, a factor of two for each EV; linear output does not change."),
};

} // namespace

std::span<const SettingDesc> postSettings() { return kPostSettings; }

float displayWhite(float ev100, const PostSettings& settings) {
    return 1.2f * std::exp2(ev100 - settings.exposureCompensation);
}

gpu::TonemapParams tonemapParams(float ev100, const PostSettings& settings, uint32_t seed) {
    return {1 / displayWhite(ev100, settings), uint32_t(settings.curve), settings.dither ? 1u : 0u,
            seed};
}

Display addTonemapPass(fg::FrameGraph& graph, fg::TextureHandle color, float ev100,
                       const PostSettings& settings, uint32_t seed) {
    struct Data {
        fg::TextureHandle color;
        Display display;
        gpu::TonemapParams params;
    };
    const Data& pass = graph.addPass<Data>(
        "tonemap",
        [&](fg::Builder& builder, Data& data) {
            const fg::TextureDesc size = graph.desc(color);
            data.color = builder.read(color);
            data.display.image = builder.create(
                "display", fg::texture2D(fg::Format::RGBA8, size.width, size.height));
            data.display.invalidPixels =
                builder.create("display.invalidPixels", fg::BufferDesc{2 * sizeof(uint32_t)});
            data.params = tonemapParams(ev100, settings, seed);
            data.display.params = &data.params;
        },
        [](const Data& data, fg::PassContext& context) {
            context.clearBuffer(data.display.invalidPixels, 0);
            context.barrier(fg::Access::StorageWrite);
            context.compute("post/tonemap.comp")
                .bind("image", data.color)
                .bind("display", data.display.image)
                .bind("InvalidPixels", data.display.invalidPixels)
                .params(data.params)
                .dispatchOver(data.display.image);
        });
    Display display = pass.display;
    display.pass = &pass;
    return display;
}

} // namespace tyndall
