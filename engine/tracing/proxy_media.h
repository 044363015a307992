#pragma once
// Proxy media, for walks that are kept while media change: small changes of the media do not change them. Walks go through the proxies; their power is then
// computed again for the actual media (reweigh(); Engelhardt, Novák and Dachsbacher 2010, section 7, after Laine et al. 2007). The mean is that of walks
// through the actual media; the variance grows with the difference between the two, over the optical depth.

#include "tracing/light_walk.h"

namespace tyndall::tracing {

struct ProxyMedia {
    MediaField field;
    uint64_t hash = 0; // of everything that walks through it depend on
};

/// For each medium of `scene`, in order, one that is denser than nothing wherever the medium is. Coefficients go to the nearest eighth of an octave, places
/// to the nearest sixteenth of the smallest extent or of eight cells; boxes and balls are larger by that
/// error; grids become eight blurred cells along their longest edge, none of them empty. Glowing media stay as they are.
[[nodiscard]] ProxyMedia makeProxyMedia(const Scene& scene, const dvec3& origin);

/// Gives a walk through one field the power that it has in the other, medium by medium: ratios for its vertices. `start`: where it started.
void reweigh(const EmittedRay& start, std::vector<WalkVertex>& walk, const MediaField& from,
             const MediaField& to);

} // namespace tyndall::tracing
