#pragma once
// Look-ups of the lattice's light: at points, on surfaces, and in media along eye rays.

#include "plugin/plugin_api.h"
#include "shared/lpv.h"
#include "volumetric_gi/lpv/lpv_lattice.h"

namespace tyndall::volumetric_gi {

/// RGBA32F 3D, a texel a cell: vector flux and fluence (w) in W/m², of red, green and blue. Lattices lie one behind the other, as do the first
/// planes of their links.
struct LatticeLight {
    fg::TextureHandle red, green, blue;
    fg::BufferHandle sides;
};

/// For the pass that is the first to write light.
[[nodiscard]] LatticeLight createLight(fg::Builder& builder, const SharedPlaces& places);

/// Adds one lattice's light to that of others; null handles if it is the first.
[[nodiscard]] LatticeLight addLatticeLight(fg::FrameGraph& graph, const Lattice& lattice,
                                           const SharedPlaces& places, const LatticeLight& others);

/// View-sized RGBA32F nits that leave surfaces towards the eye.
[[nodiscard]] fg::TextureHandle addSurfaceLookup(fg::FrameGraph& graph,
                                                 const plugin::FrameInputs& inputs,
                                                 const gpu::LpvLevels& levels,
                                                 const LatticeLight& light);

/// View-sized RGBA32F nits that reach the eye from media. Skipped where there are none. One ray is marched for a square of so many pixels a side.
[[nodiscard]] fg::TextureHandle addMediumLookup(fg::FrameGraph& graph,
                                                const plugin::FrameInputs& inputs,
                                                const gpu::LpvLevels& levels,
                                                const LatticeLight& light, int pixels);

} // namespace tyndall::volumetric_gi
