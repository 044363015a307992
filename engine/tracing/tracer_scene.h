#pragma once
// A scene prepared for tracing paths, and the light of a path.

#include <array>
#include <memory>

#include "core/result.h"
#include "tracing/camera_rays.h"
#include "tracing/lights.h"
#include "tracing/media_segment.h"
#include "tracing/path_terms.h"
#include "tracing/surface_scene.h"

namespace tyndall::tracing {

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

} // namespace tyndall::tracing
