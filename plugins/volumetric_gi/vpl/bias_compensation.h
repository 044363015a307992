#pragma once
// Compensation paths on the processor: they add the light that clamping removes and that the GPU's own compensation, one step in media, does not add.

#include "tracing/virtual_light_path.h"

namespace tyndall::volumetric_gi {

/// The clamp distances with which the GPU gathers. It compensates by one step in media, to a point that gathers in turn.
/// Metres in the ball of the path's settings; in media a clamp distance reaches no farther than the free path at the receiver.
struct GpuClamps {
    double betweenSurfaces = 0, ofMedia = 0;
    double fromSurfacesToMedia = 0; // if it is less than ofMedia
    double relaxed = 1; // clamp distance over that at the end of the step
};

/// One for each thread.
class BiasCompensation {
public:
    BiasCompensation(const tracing::TracerScene& scene, const tracing::LightEmission& emission,
                     const tracing::VirtualLightPathSettings& settings, const GpuClamps& clamps)
        : path_(scene, emission, settings), clamps_(clamps) {}

    /// Light missing on the GPU that leaves the first surface on an eye ray towards the eye, without the media in between.
    /// The eye ray passes surfaces of partial coverage (BLEND).
    /// Returns that surface, good until the next path; null where there is none.
    const tracing::Surface* traceOnSurface(const tracing::CameraRays::CameraRay& start,
                                           tracing::Sampler& sampler, tracing::TermLight& light);
    /// The same for light that media before that surface scatter to the eye, as it arrives there.
    void traceInMedia(const tracing::CameraRays::CameraRay& start, tracing::Sampler& sampler,
                      tracing::TermLight& light);
    [[nodiscard]] tracing::PathCounts counts() const { return path_.counts(); }

private:
    using Vertex = tracing::VirtualLightPath::Vertex;
    using ClampDistances = tracing::VirtualLightPath::ClampDistances;
    [[nodiscard]] tracing::RayHit opaqueHit(const tracing::CameraRays::CameraRay& start,
                                            tracing::Sampler& sampler) const;
    [[nodiscard]] ClampDistances clampedOnGpu(const Vertex& vertex) const;
    void follow(Vertex& vertex);

    tracing::VirtualLightPath path_;
    GpuClamps clamps_;
    tracing::Surface seen_; // that the eye ray met
};

} // namespace tyndall::volumetric_gi
