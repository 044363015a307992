#pragma once
// Marches through the media at a reduced resolution: one ray for a square of pixels, upsampled where it fits; pixels that no ray fits
// are marched on their own. The shaders' side: shaders/media/nearest_rays.glsl, spread_rays.glsl and, for techniques, shaders/gi/shared.

#include "plugin/frame_resources.h"
#include "plugin/shader_rounds.h"
#include "shared/march.h"

namespace tyndall {

enum class MarchStage {
    Squares, // a ray for each square; with a factor of 1 for each pixel
    Spread,  // from squares to pixels
    Fill,    // pixels that were left open
};

/// Data of the pass of any stage, for bindMarch().
struct MarchPass {
    MarchStage stage = MarchStage::Squares;
    ViewResources view;
    MediaResources media;
    fg::TextureHandle depth; // GBuffer::depth
    gpu::MarchParams params;
};

/// Declares what every stage reads. `params.factor`: pixels along an edge of a square.
inline MarchPass readMarch(fg::Builder& builder, MarchStage stage, const ViewResources& view,
                           const MediaResources& media, fg::TextureHandle depth,
                           const gpu::MarchParams& params) {
    MarchPass pass{stage, view, media, builder.read(depth), params};
    if (media.count > 0) pass.media = readMedia(builder, media);
    if (stage == MarchStage::Fill) pass.params.flags |= gpu::kMarchFill;
    return pass;
}

/// Calls `dispatch` with the parameters of each turn of a march that gathers the scene's lights: usually one.
template <typename Dispatch>
void marchInTurns(const MarchPass& pass, fg::PassContext& context, const Dispatch& dispatch) {
    const double segments = segmentsOnRay(pass.media, gridWay(pass.media));
    const double aTurn = segmentsATurn(pass.media);
    gpu::MarchParams params = pass.params;
    for (double first = 0; first == 0 || first < segments; first += aTurn) {
        if (first > 0) context.barrier(fg::Access::StorageWrite);
        params.firstSegment = uint32_t(first);
        params.endSegment =
            first + aTurn < segments ? uint32_t(first + aTurn) : gpu::kMarchAllSegments;
        dispatch(params);
    }
}

/// Of what the stage writes: RGBA32F, a texel a ray or a pixel.
inline fg::TextureDesc marchPicture(const MarchPass& pass) {
    const int factor = pass.stage == MarchStage::Squares ? int(pass.params.factor) : 1;
    return fg::texture2D(fg::Format::RGBA32F, (pass.view.width + factor - 1) / factor,
                         (pass.view.height + factor - 1) / factor);
}

/// Binds what every stage's shader uses; passes that march also bind the media.
template <typename Command>
Command& bindMarch(Command& command, const MarchPass& pass, const gpu::MarchParams& params) {
    return bindView(command, pass.view).params(params).bind("depth", pass.depth);
}
template <typename Command> Command& bindMarch(Command& command, const MarchPass& pass) {
    return bindMarch(command, pass, pass.params);
}

/// Adds the stages one after the other. `add(stage, before)` adds one and returns what it writes, of which `before` is the last stage's; nothing (false) if
/// there is nothing to march. `fills`: spreading leaves pixels open to a third stage, in place of marching them itself.
template <typename Images, typename Add>
Images addMarchStages(int factor, bool fills, const Add& add) {
    const Images rays = add(MarchStage::Squares, Images{});
    if (!rays || factor == 1) return rays;
    const Images pixels = add(MarchStage::Spread, rays);
    return fills ? add(MarchStage::Fill, pixels) : pixels;
}

// ---- for techniques, whose result is one picture of light that media scatter to the eye ---------------------------

/// Names (literals) of a technique's passes and of their pictures.
struct LightMarchNames {
    const char *squares, *spread, *fill;
    const char *rays, *pixels;
    [[nodiscard]] const char* of(MarchStage stage) const {
        return stage == MarchStage::Squares ? squares : stage == MarchStage::Spread ? spread : fill;
    }
};

/// For shaders that include gi/shared/march.glsl (Squares, Fill) or gi/shared/upsample.glsl (Spread).
struct LightMarch {
    MarchPass pass;
    fg::TextureHandle transmittance; // Spread alone
    fg::TextureHandle before;        // the last stage's; null in the first
    fg::TextureHandle light;         // RGBA32F nits; w: 0 where a pixel is left open
};

inline LightMarch declareLightMarch(fg::Builder& builder, const MarchPass& pass,
                                    fg::TextureHandle transmittance, fg::TextureHandle before,
                                    const LightMarchNames& names) {
    LightMarch march{pass, {}, {}, {}};
    const bool squares = pass.stage == MarchStage::Squares;
    if (pass.stage == MarchStage::Spread) march.transmittance = builder.read(transmittance);
    if (!squares) march.before = builder.read(before);
    const bool rays = squares && pass.params.factor > 1;
    march.light = builder.create(rays ? names.rays : names.pixels, marchPicture(pass));
    return march;
}

template <typename Command>
Command& bindLightMarch(Command& command, const LightMarch& march, const gpu::MarchParams& params) {
    bindMarch(command, march.pass, params).bind("inScatter", march.light);
    if (march.transmittance) command.bind("transmittance", march.transmittance);
    // In the first stage the shader does not read it, but the binding must be valid.
    return command.bind("before", march.before ? march.before : march.pass.depth);
}
template <typename Command> Command& bindLightMarch(Command& command, const LightMarch& march) {
    return bindLightMarch(command, march, march.pass.params);
}

} // namespace tyndall
