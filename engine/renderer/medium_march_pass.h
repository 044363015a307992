#pragma once
// The media between the eye and the surfaces.

#include "renderer/media_system.h"
#include "shared/march.h"

namespace tyndall {

struct MediumMarchInputs {
    ViewResources view;
    fg::TextureHandle depth; // GBuffer::depth
    LightResources lights;
    bool inScatter = true; // the term LVE is wanted
    bool emission = true;  // the media's part of LE is wanted
};

/// How rays are marched and, where they are fewer than pixels, upsampled: media.march.*. The flags hold no more than kMarchRefine and kMarchSmooth.
[[nodiscard]] gpu::MarchParams marchParams(const MediaSettings& settings);

/// View-sized RGBA32F. Null: not computed, because there is none (reason in the report) or it is not wanted.
struct MediumMarch {
    fg::TextureHandle transmittance; // of the way to the surface; null: 1 everywhere
    fg::TextureHandle inScatter;     // nits: LVE
    fg::TextureHandle emission;      // nits: the media's part of LE
    explicit operator bool() const { return bool(transmittance); }
};

MediumMarch addMediumMarchPass(fg::FrameGraph& graph, const MediaFrame& frame,
                               const MediumMarchInputs& inputs);

} // namespace tyndall
