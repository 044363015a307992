#pragma once
// Which parts of the scene's surfaces become surfels, and how finely: triangles are cut into patches that the tessellator turns into points.

#include <cstdint>
#include <span>
#include <vector>

#include "core/math.h"
#include "shared/surfels.h"

namespace tyndall::volumetric_gi {

/// Triangles of one object: three positions each, render space.
struct SurfelTriangles {
    std::span<const dvec3> corners;
    uint32_t set = 0; // plugin::SurfaceDrawer's number; the key of chances
};

/// How large surfels are: metres along an edge of the square of their area.
struct SurfelSize {
    dvec3 eye{0};
    double perDistance = 0; // size over the distance from the eye
    double least = 0;       // metres, from where `perDistance` counts on; in a parallel view the size itself
    Bounds media;           // empty: everywhere
    double perMediumDistance = 0; // the size is at least this over the distance from the media
    double scale = 1;             // multiplies the result

    [[nodiscard]] double at(const dvec3& position) const;
};

struct SurfelPlan {
    /// Patches of one object, for one draw.
    struct Set {
        uint32_t set = 0, firstPatch = 0, patches = 0, firstSurfel = 0, surfels = 0;
    };
    std::vector<gpu::SurfelPatch> patches;
    std::vector<Set> sets; // of those that have patches
    uint32_t surfels = 0;
    uint32_t degenerate = 0; // triangles without an area, or with coordinates that are not finite
    double scale = 1;        // of sizes, that `most` has enforced
};

/// Points of a patch of this level: those of OpenGL's tessellator with equal spacing in point mode.
[[nodiscard]] uint32_t surfelsOfLevel(uint32_t level);

/// Makes sets of a plan's patches of one object, which are those from number `first` on: as many as their draws need.
void addSets(SurfelPlan& plan, uint32_t set, uint32_t first);

/// Cuts triangles at their longest edges until each patch needs a level of at most kSurfelMostLevel and sizes in it are alike. A patch smaller than three surfels, the fewest that
/// a patch has, is kept with a chance and has its area over that: the mean over `seed` is its area. Chances follow from the triangle's number, so that a patch stays from frame to
/// frame. At most `most` surfels: all sizes grow by powers of 2^(1/4) until they are so few.
[[nodiscard]] SurfelPlan planSurfels(std::span<const SurfelTriangles> objects, SurfelSize size,
                                     uint32_t most, uint64_t seed);

} // namespace tyndall::volumetric_gi
