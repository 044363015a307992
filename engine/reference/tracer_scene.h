#pragma once
// A scene made ready for tracing paths, and what a path gives.

#include <array>
#include <memory>

#include "core/result.h"
#include "reference/camera_rays.h"
#include "reference/lights.h"
#include "reference/media_segment.h"
#include "reference/path_terms.h"
#include "reference/surface_scene.h"

namespace tyndall::reference {

/// Light by terms, nits.
struct TermLight {
    std::array<dvec3, kTermCount> terms{};
    void add(Term term, const dvec3& light) { terms[size_t(term)] += light; }
    [[nodiscard]] dvec3 sum() const {
        dvec3 result(0);
        for (const dvec3& term : terms) result += term;
        return result;
    }
};

/// The scene must outlive it.
struct TracerScene {
    std::unique_ptr<SurfaceScene> surfaces;
    std::unique_ptr<MediaField> media;
    std::unique_ptr<Lights> lights; // keeps references to both
    /// Errors: as SurfaceScene::build.
    static Result<TracerScene> build(const Scene& scene, const dvec3& origin, int threads);
    [[nodiscard]] std::vector<std::string> notes() const;
};

struct PathSettings {
    TermSet terms = kAllTerms;
    int maxScatterings = -1;                                    // -1: any number
    TransmittanceMode transmittance = TransmittanceMode::Ratio; // the better one at equal time
    bool aimAtLights = true; // next-event estimation; without it lights without extent stay dark
    bool aimFromSegments = true; // also from points drawn for it along each piece of a path
    /// No path is longer, whatever it carries; reaching it is counted.
    static constexpr int kLongest = 100000;
};

} // namespace tyndall::reference
