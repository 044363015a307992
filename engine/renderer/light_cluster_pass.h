#pragma once
// Lists of the lights that reach each part of the view (clustered shading: Olsson, Billeter, Assarsson, "Clustered Deferred
// and Forward Shading", 2012).

#include <span>

#include "plugin/frame_resources.h"
#include "renderer/light_settings.h"

namespace tyndall {

/// The buffer `Clusters` for shaders/lighting/clusters.glsl. `balls`: centre (render space) and reach in metres of the lights
/// from number `globalCount` on; those below reach everywhere. Few lights, and parallel views, get no lists: shaders then look
/// at every light. `balls` is read when the graph runs.
fg::BufferHandle addLightClusterPass(fg::FrameGraph& graph, const ViewResources& view,
                                     std::span<const vec4> balls, uint32_t globalCount,
                                     const LightSettings& settings);

} // namespace tyndall
