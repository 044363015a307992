#pragma once
// Single frames: the pattern of the places at which rays gather light in fog is averaged away over neighbouring rays.

#include "plugin/frame_resources.h"
#include "shared/march.h"

namespace tyndall {

/// Pictures with a texel for each marched ray, or for each pixel with a MarchParams.factor of 1.
struct MarchedLight {
    fg::TextureHandle depth;         // GBuffer::depth: view-sized
    fg::TextureHandle transmittance; // RGBA32F
    fg::TextureHandle inScatter;     // RGBA32F nits; w: the part from grids, which stays as it is
};

/// The light averaged over 3×3 rays; itself in averaged frames, whose own mean is exact, and without kMarchSmooth.
fg::TextureHandle addMarchSmoothingPass(fg::FrameGraph& graph, const ViewResources& view,
                                        const gpu::MarchParams& params, const MarchedLight& light);

} // namespace tyndall
