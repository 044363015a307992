#pragma once
// The propagation scheme as the paper prints it (equation 3), to be compared with.

#include "volumetric_gi/lpv/lpv_light.h"

namespace tyndall::volumetric_gi {

/// So many steps from nothing, and their light for look-ups. Powers of the last step go into the first LpvControl of `control`, of which the next
/// version is left there; what is lost is its imbalance.
[[nodiscard]] LatticeLight addPrintedLight(fg::FrameGraph& graph, const Lattice& lattice,
                                           const SharedPlaces& places, int steps,
                                           fg::BufferHandle& control);

} // namespace tyndall::volumetric_gi
