#pragma once
// From light on surfaces and in media to the images of the terms, and to their sum.

#include "framegraph/frame_graph.h"
#include "renderer/frame_resources.h"
#include "renderer/term_images.h"

namespace tyndall {

/// T·emission (+ the media's own) as LE and T·direct as LSE: view-sized RGBA32F. Skipped in vacuum, where the surfaces' images
/// are the terms already: then `surfaceEmission` and `surfaceDirect` are returned as they are.
struct CompositeInputs {
    fg::TextureHandle surfaceEmission, surfaceDirect; // leaving surfaces towards the eye
    fg::TextureHandle transmittance, mediumEmission;  // absent or null without media
};
struct DirectImages {
    fg::TextureHandle emission, direct;
};
DirectImages addCompositePass(fg::FrameGraph& graph, const CompositeInputs& inputs);

/// `radiance` as seen through the media; itself in vacuum. `name` is the pass's.
fg::TextureHandle addAttenuatePass(fg::FrameGraph& graph, const char* name, fg::TextureHandle radiance, fg::TextureHandle transmittance);

/// The sum of all images, in order. CHECKs that there is at least one.
fg::TextureHandle addSumPass(fg::FrameGraph& graph, const TermImages& images);

/// Mean of `image` over `frame` frames, this one included (frame 1 starts anew), kept under `historyName`.
/// Alpha holds the sum of squared deviations of luminance.
fg::TextureHandle addAccumulatePass(fg::FrameGraph& graph, const char* historyName, fg::TextureHandle image, uint32_t frame);

} // namespace tyndall
