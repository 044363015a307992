#pragma once
// From light on surfaces and in media to the images of the terms, and to their sum.

#include "framegraph/frame_graph.h"
#include "plugin/frame_resources.h"
#include "renderer/term_images.h"

namespace tyndall {

/// One term's image: `radiance` leaving surfaces, attenuated by the media between them and the eye, plus what the media add.
/// `transmittance` and `added` may be absent. In vacuum the pass is skipped and `radiance` returned as it is.
/// `passName` and `imageName` must outlive the frame.
fg::TextureHandle addCompositePass(fg::FrameGraph& graph, const char* passName,
                                   const char* imageName, fg::TextureHandle radiance,
                                   fg::TextureHandle transmittance, fg::TextureHandle added = {});

/// The sum of all images, in order; black where there is none.
fg::TextureHandle addSumPass(fg::FrameGraph& graph, const TermImages& images, int width,
                             int height);

/// Mean of `image` over `frame` frames, this one included (frame 1 starts anew), kept under `historyName`.
/// Alpha holds the sum of squared deviations of luminance.
fg::TextureHandle addAccumulatePass(fg::FrameGraph& graph, const char* historyName,
                                    fg::TextureHandle image, uint32_t frame);

} // namespace tyndall
