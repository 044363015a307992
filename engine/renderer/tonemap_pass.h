#pragma once
// Exposure and tone curve: the only place where a picture leaves linear nits.

#include "core/settings.h"
#include "core/tone_curve.h"
#include "framegraph/frame_graph.h"
#include "shared/post.h"

namespace tyndall {

struct PostSettings {
    ToneCurve curve;
    bool dither;
    float exposureCompensation; // EV, added to the scene's
};
std::span<const SettingDesc> postSettings();

struct Display {
    fg::TextureHandle image; // RGBA8, sRGB-encoded
    fg::BufferHandle
        invalidPixels; // two counters: non-finite, negative (see shaders/post/tonemap.comp)
    gpu::TonemapParams* params = nullptr; // of the pass, until the next frame begins
    const void* pass = nullptr;           // for Executor::runAgain()
};

/// Nits that are shown white before the tone curve: 1.2 · 2^EV100, less the compensation.
[[nodiscard]] float displayWhite(float ev100, const PostSettings& settings);

/// Exposure and tone curve as the shader takes them.
[[nodiscard]] gpu::TonemapParams tonemapParams(float ev100, const PostSettings& settings,
                                               uint32_t seed);

/// `color` in nits at EV100 `ev100`: 1.2·2^EV100 nits are display white (ISO 2720's saturation-based exposure).
Display addTonemapPass(fg::FrameGraph& graph, fg::TextureHandle color, float ev100,
                       const PostSettings& settings, uint32_t seed);

} // namespace tyndall
