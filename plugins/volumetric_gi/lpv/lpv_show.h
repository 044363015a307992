#pragma once
// Debug view: a slice of a lattice in the picture.

#include "volumetric_gi/lpv/lpv_light.h"
#include "volumetric_gi/lpv/lpv_settings.h"

namespace tyndall::volumetric_gi {

/// The picture with the slice that the settings select; `color` if they select none.
[[nodiscard]] fg::TextureHandle addLatticeSlice(fg::FrameGraph& graph,
                                                const plugin::FrameInputs& inputs,
                                                const LpvSettings& settings, const Lattice& lattice,
                                                const LatticeLight& light, fg::TextureHandle color);

} // namespace tyndall::volumetric_gi
