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

struct SumFrame {
    int width = 0, height = 0;
    uint32_t number = 1; // from 1, where what is kept of earlier frames is forgotten
};

struct Sum {
    fg::TextureHandle image;
    /// For each term image ~number of the first frame in which it held a value that is not finite; 0: none did. Null where there
    /// is no term image.
    fg::BufferHandle firstInvalid;
};

/// The sum of all images, in order; black where there is none.
Sum addSumPass(fg::FrameGraph& graph, const TermImages& images, const SumFrame& frame);

/// Mean of `image` over `frame` frames, this one included (frame 1 starts anew), kept under `historyName`.
/// Alpha holds the sum of squared deviations of luminance.
fg::TextureHandle addAccumulatePass(fg::FrameGraph& graph, const char* historyName,
                                    fg::TextureHandle image, uint32_t frame);

} // namespace tyndall
