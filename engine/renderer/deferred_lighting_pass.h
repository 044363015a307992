#pragma once
// Light that leaves the surfaces of the G-buffer towards the eye: what they emit, and what they reflect of direct light.

#include "framegraph/frame_graph.h"
#include "renderer/environment_map.h"
#include "plugin/frame_resources.h"
#include "renderer/surface_settings.h"
#include "transport/terms.h"

namespace tyndall {

struct SurfaceLightInputs {
    ViewResources view;
    GBuffer gbuffer;
    LightResources lights;
    MediaResources media;                        // count 0: light travels in vacuum
    const EnvironmentMap* environment = nullptr; // null or black: none
    bool hasSurfaces = true;                     // false: nothing to light
    TermSet terms = kAllTerms; // LE and LSE are skipped where they are not in here
    SurfaceLightSettings settings;
};

/// View-sized RGBA32F, nits leaving the surfaces: the media between them and the eye come later.
struct SurfaceLight {
    fg::TextureHandle
        emission; // LE, with the environment behind everything. Absent: LE is not rendered
    fg::TextureHandle
        direct; // LSE. Absent: LSE is not rendered, or there is nothing to light or no light
};

/// Adds the passes `lighting.emission` and `lighting.direct`. Where the environment is black, what the G-buffer holds is the
/// emission already, and the first pass is skipped.
SurfaceLight addDeferredLightingPass(fg::FrameGraph& graph, const SurfaceLightInputs& inputs);

} // namespace tyndall
