#pragma once
// What the lattice's light does in the picture: light at points, on surfaces, and in media along eye rays.

#include "plugin/plugin_api.h"
#include "shared/lpv.h"

namespace tyndall::volumetric_gi {

/// RGBA32F 3D, a texel a cell: vector flux and fluence (w) in W/m², of red, green and blue.
struct LatticeLight {
    fg::TextureHandle red, green, blue;
};

[[nodiscard]] LatticeLight addLatticeLight(fg::FrameGraph& graph, const gpu::LpvParams& params,
                                           fg::BufferHandle medium, fg::BufferHandle sources,
                                           fg::BufferHandle links, fg::BufferHandle flux);

/// View-sized RGBA32F nits that leave surfaces towards the eye.
[[nodiscard]] fg::TextureHandle addSurfaceLookup(fg::FrameGraph& graph,
                                                 const plugin::FrameInputs& inputs,
                                                 const gpu::LpvParams& params,
                                                 fg::BufferHandle links, const LatticeLight& light);

/// View-sized RGBA32F nits that reach the eye from media. Skipped where there are none.
[[nodiscard]] fg::TextureHandle addMediumLookup(fg::FrameGraph& graph,
                                                const plugin::FrameInputs& inputs,
                                                const gpu::LpvParams& params,
                                                fg::BufferHandle links, const LatticeLight& light);

} // namespace tyndall::volumetric_gi
