#pragma once
// A slice of a lattice in the picture, for people who want to see what it does.

#include "volumetric_gi/lpv/lpv_light.h"
#include "volumetric_gi/lpv/lpv_settings.h"

namespace tyndall::volumetric_gi {

/// The picture with a slice drawn into it as settings say; `color` where they show nothing.
[[nodiscard]] fg::TextureHandle addLatticeSlice(fg::FrameGraph& graph,
                                                const plugin::FrameInputs& inputs,
                                                const LpvSettings& settings, const Lattice& lattice,
                                                const LatticeLight& light, fg::TextureHandle color);

} // namespace tyndall::volumetric_gi
