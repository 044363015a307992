#pragma once
// Surfaces into the G-buffer.

#include "framegraph/frame_graph.h"
#include "plugin/frame_resources.h"
#include "renderer/gpu_scene.h"
#include "renderer/surface_settings.h"

namespace tyndall {

/// Opaque and alpha-tested surfaces, lines and points of `scene` as the camera sees them. Where nothing is, depth is 0.
/// `scene` must stay unchanged until the graph was executed.
/// `bothSides`: one-sided surfaces are seen from behind, too, as light sees them.
GBuffer addGBufferPass(fg::FrameGraph& graph, const GpuScene& scene, const ViewResources& view,
                       const GBufferSettings& settings, const char* name = "gbuffer",
                       bool bothSides = false);

/// Binds the five textures of a material; the names are those of shaders/gbuffer/surface.glsl.
inline void bindMaterial(fg::PassContext& context, const MaterialTextures& textures) {
    context.bindStaticTexture("baseColorTexture", textures.baseColor);
    context.bindStaticTexture("metallicRoughnessTexture", textures.metallicRoughness);
    context.bindStaticTexture("normalTexture", textures.normal);
    context.bindStaticTexture("occlusionTexture", textures.occlusion);
    context.bindStaticTexture("emissiveTexture", textures.emissive);
}

} // namespace tyndall
