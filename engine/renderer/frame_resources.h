#pragma once
// What the frame's passes hand to each other: handles grouped by meaning, and how a command binds each group.
// Plugins see exactly this.

#include <cstdint>

#include "framegraph/frame_graph.h"
#include "shared/light.h"
#include "shared/medium.h"
#include "shared/view.h"

namespace tyndall {

/// Deferred surfaces, view-sized. Depth is reversed: 0 where no surface is.
struct GBuffer {
    fg::TextureHandle depth;    // Depth32F
    fg::TextureHandle normal;   // RG16Snorm ×2 packed as RGBA16: shading and geometric normal, octahedral
    fg::TextureHandle base;     // RGBA16: base colour, metallic
    fg::TextureHandle material; // RGBA16: roughness, specular, occlusion, flags
    fg::TextureHandle emissive; // RGBA32F: nits
};

/// Lights, their clusters, shadow maps and light-space optical depth.
struct LightResources {
    fg::BufferHandle lights;        // LightData[]
    fg::BufferHandle clusters;      // offsets and counts, then light indices (shaders/lighting/clusters.glsl)
    fg::BufferHandle shadowViews;   // ShadowView[]
    fg::TextureHandle shadowAtlas;  // Depth32F array
    fg::TextureHandle opticalDepth; // light-space optical depth of the grid media; absent without grids
    fg::BufferHandle opticalDepthViews;
    uint32_t lightCount = 0;        // with environment samples
};

struct MediaResources {
    fg::BufferHandle media;   // MediumData[]
    fg::BufferHandle bricks;  // BrickData[]
    fg::StaticTexture atlas;  // R32F 3D: brick samples of density and temperature grids
    uint32_t count = 0;       // media that can be seen or can shade what is seen
};

struct ViewResources {
    gpu::ViewData data;
    int32_t width = 0, height = 0;
};

template <typename Command>
Command& bindView(Command& command, const ViewResources& view) {
    return command.params(view.data, "View");
}

} // namespace tyndall
