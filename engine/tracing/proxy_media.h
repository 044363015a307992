#pragma once
// Media for walks that are kept while media change: stand-ins that small changes do not change. Walks follow the stand-ins; what they carry is then
// told anew from the media as they are (reweigh(); Engelhardt, Novák and Dachsbacher 2010, section 7, after Laine et al. 2007). The mean is that of walks
// through the media themselves; the variance grows with how far the stand-ins are off, over the optical depth.

#include "tracing/light_walk.h"

namespace tyndall::tracing {

struct ProxyMedia {
    MediaField field;
    uint64_t hash = 0; // of everything that walks through it follow from
};

/// For each medium of `scene`, in order, one that is denser than nothing wherever the medium is. Coefficients go to the nearest eighth of an octave, places
/// to the nearest sixteenth of the smallest extent or of eight cells; boxes and balls are larger by as much as that may
/// be off; grids become eight blurred cells along their longest edge, none of them empty. What glows stays as it is.
[[nodiscard]] ProxyMedia makeProxyMedia(const Scene& scene, const dvec3& origin);

/// A walk through one field as it is in the other, medium by medium: ratios of what its vertices carry. `start` is where it started.
void reweigh(const EmittedRay& start, std::vector<WalkVertex>& walk, const MediaField& from,
             const MediaField& to);

} // namespace tyndall::tracing
