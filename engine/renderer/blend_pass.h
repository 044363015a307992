#pragma once
// Blended surfaces over the images of the terms, each at its depth in the media.

#include "framegraph/frame_graph.h"
#include "renderer/blend_list.h"
#include "renderer/environment_map.h"
#include "plugin/frame_resources.h"
#include "renderer/surface_settings.h"
#include "renderer/term_images.h"

namespace tyndall {

struct BlendInputs {
    ViewResources view;
    fg::TextureHandle depth;         // of the G-buffer
    fg::TextureHandle transmittance; // of the media before it; null or absent without media
    LightResources lights;
    MediaResources media;
    const EnvironmentMap* environment = nullptr;
    SurfaceLightSettings settings;
    float textureLodBias = 0; // GBufferSettings::textureLodBias
};

/// The images of `images` with the blended surfaces in them: with coverage α, C becomes (1-α)·C + α·(what the media before the
/// surface send + transmittance · what the surface sends). Images of indirect light are attenuated: blended surfaces receive none.
/// Skipped, with the images as they are, where nothing blends. `list` must stay unchanged until the graph was executed.
TermImages addBlendPass(fg::FrameGraph& graph, const BlendList& list, const BlendInputs& inputs,
                        const TermImages& images);

} // namespace tyndall
