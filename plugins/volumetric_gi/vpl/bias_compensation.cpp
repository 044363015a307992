#include "volumetric_gi/vpl/bias_compensation.h"

#include <algorithm>

namespace tyndall::volumetric_gi {
namespace {

/// Relative offset behind a surface that an eye ray passes.
constexpr double kPassed = 1e-6;

} // namespace

/// For light that a path's first vertex receives.
BiasCompensation::ClampDistances BiasCompensation::clampedOnGpu(const Vertex& vertex) const {
    const double scale = path_.scaleAt(vertex.position);
    if (vertex.onSurface()) return {scale * clamps_.betweenSurfaces, scale * clamps_.ofMedia};
    const double within =
        std::min(scale * clamps_.ofMedia, 1 / tracing::maximumOf(path_.mediumPoint().extinction));
    return {std::min(scale * clamps_.fromSurfacesToMedia, within), within};
}

/// Of the surface where an eye ray ends.
tracing::RayHit BiasCompensation::opaqueHit(const tracing::CameraRays::CameraRay& start,
                                            tracing::Sampler& sampler) const {
    const tracing::SurfaceScene& surfaces = *path_.scene().surfaces;
    tracing::RayHit hit;
    double nearest = start.nearest;
    do {
        hit = surfaces.intersect(start.ray, nearest, kInfinity, tracing::RayKind::Camera,
                                 sampler.bits());
        nearest = hit.distance * (1 + kPassed);
    } while (hit.found() &&
             surfaces.instances()[hit.instance].material->alphaMode == AlphaMode::Blend);
    return hit;
}

/// Continues from a path's first vertex to light that the GPU has not gathered.
void BiasCompensation::follow(Vertex& vertex) {
    const ClampDistances clamped = clampedOnGpu(vertex);
    if (!path_.nearVertex(vertex, clamped)) return;
    if (!vertex.onSurface()) {
        // The GPU has gathered direct light there, and virtual lights down to the relaxed distance.
        const double relaxed = clamped.ofMedia / clamps_.relaxed;
        const double ofSurfaces = path_.scaleAt(vertex.position) * clamps_.fromSurfacesToMedia;
        if (!path_.nearVertex(vertex, {std::min(ofSurfaces, relaxed), relaxed}) ||
            !path_.survives())
            return;
    }
    path_.traceWalk();
    do {
        path_.gatherLights(vertex);
        if (!path_.survives()) return;
        path_.gatherWalk(vertex);
    } while (path_.nearVertex(vertex, path_.clampedAt(vertex.position)));
}

const tracing::Surface*
BiasCompensation::traceOnSurface(const tracing::CameraRays::CameraRay& start,
                                 tracing::Sampler& sampler, tracing::TermLight& light) {
    path_.begin(sampler, light);
    path_.chooseHero();
    const tracing::RayHit hit = opaqueHit(start, sampler);
    if (!hit.found()) return nullptr;
    Vertex vertex;
    path_.enterSurface(start.ray, hit, vertex);
    if (vertex.point.unlit) return nullptr;
    seen_ = vertex.point.surface;
    path_.addScattering(tracing::Scattering::Surface);
    follow(vertex);
    return &seen_;
}

void BiasCompensation::traceInMedia(const tracing::CameraRays::CameraRay& start,
                                    tracing::Sampler& sampler, tracing::TermLight& light) {
    path_.begin(sampler, light);
    path_.chooseHero();
    Vertex vertex;
    if (path_.nextVertexInMedia(start.ray, opaqueHit(start, sampler).distance, vertex))
        follow(vertex);
}

} // namespace tyndall::volumetric_gi
