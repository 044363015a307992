#pragma once
// The transmittance interval map of the eye rays.

#include "plugin/plugin_api.h"
#include "plugin/reduced_march.h"
#include "shared/surfels.h"

namespace tyndall::volumetric_gi {

/// For shaders that include gi/surfels/interval_map.glsl. Null handles: there is no medium in view.
struct SurfelIntervals {
    fg::TextureHandle ways;      // RGBA32F a ray: start and length of the way through media, metres; opacity
    fg::TextureHandle totals;    // RGBA32F array, a layer a phase function: light that the ray scatters, of light from all around
    fg::TextureHandle shares;    // RGBA16 array, layers by interval and phase function: shares of the total
    fg::BufferHandle places;     // of each ray's intervals, 16 bits each
    gpu::SurfelMapParams params{};
    gpu::MarchParams march{}; // which pixel a ray is of
};

struct IntervalRequest {
    int factor = 1;      // pixels along an edge of the square that a ray stands for
    uint32_t count = 16; // intervals of a ray
    bool jitter = true;
    // As printed:
    bool paper = false;
    double step = 0;    // of the march, metres
    double densest = 0; // largest scattering coefficient of all media, per metre
};

/// Adds the pass `gi.surfels.intervals`.
[[nodiscard]] SurfelIntervals addSurfelIntervals(fg::FrameGraph& graph,
                                                 const plugin::FrameInputs& inputs,
                                                 const IntervalRequest& request);

/// Declares that a pass reads the map; the result is what bindIntervals() takes.
[[nodiscard]] SurfelIntervals readIntervals(fg::Builder& builder, const SurfelIntervals& map);

template <typename Command> Command& bindIntervals(Command& command, const SurfelIntervals& map) {
    return command.params(map.params, "IntervalMap")
        .bind("ways", map.ways)
        .bind("totals", map.totals)
        .bind("IntervalPlaces", map.places);
}

} // namespace tyndall::volumetric_gi
