#pragma once
// The propagation scheme as the paper prints it (equation 3), for comparison.

#include "volumetric_gi/lpv/lpv_light.h"

namespace tyndall::volumetric_gi {

/// `steps` steps from nothing, and their light for look-ups. The energy balance of the last step goes into the first LpvControl of `control`, of which the next
/// version is left there; its imbalance is the power that the scheme loses.
[[nodiscard]] LatticeLight addPrintedLight(fg::FrameGraph& graph, const Lattice& lattice,
                                           const SharedPlaces& places, int steps,
                                           fg::BufferHandle& control);

} // namespace tyndall::volumetric_gi
