#pragma once
// The fast path tracer. Light at a path's vertices is found by up to four techniques, combined by multiple importance sampling (the
// balance heuristic):
//
//   at a surface   next-event estimation, or the direction that the BSDF draws;
//   in a medium    next-event estimation from where free flight collided, or from a point drawn on the segment for that light
//                  (equiangular about lamps, by the media's depth for the rest), or the direction that the phase function draws.
//
// Media are flown through by null collisions under spectral multiple importance sampling (PathWeights). Paths that carry little end by
// chance; the others are raised to a fixed weight, never beyond it.

#include "reference/path_settings.h"

namespace tyndall::reference {

/// One for each thread: it keeps its scratch memory from path to path.
class VolumePathTracer {
public:
    VolumePathTracer(const TracerScene& scene, const PathSettings& settings);

    void trace(const CameraRays::CameraRay& start, Sampler& sampler, TermLight& light);
    [[nodiscard]] const PathCounts& counts() const { return counts_; }

private:
    /// What the vertex that a segment starts from could have done instead of the direction it went.
    struct Origin {
        bool camera = true; // no next-event estimation from there
        bool inMedium = false;
        double directionDensity = 0; // of the direction that it went, per steradian, all channels
        double flightDensity = 1;    // of the vertex' place on its own segment; 1 for surfaces
        dvec3 position{0};
        // For vertices in media: the segment they lie on.
        Ray segment;
        double distance = 0;
        Interval reach;
        double chanceFromSegment = 0; // chance that sampleLightFromSegment was called
        double collisionDensity = 0;
    };
    /// A light sampled from a point of a segment, and how else it might have been found. Densities per steradian.
    struct SegmentSample {
        LightSample sample;
        dvec3 phase{0};
        double met =
            0; // of a collision there that then meets the light, over that of the collision
        double collided = 0; // of next-event estimation from a collision there, likewise
        double drawnAs = 1;  // true density of the direction drawn, over the one in its MIS weight
    };
    void sampleLightFromSurface(const SurfacePoint& point, const Bsdf& bsdf);
    void sampleLightFromCollision(const dvec3& position, const dvec3& before);
    void sampleLightFromSegment(const Ray& ray);
    bool decideToSampleFromSegment(const Ray& ray);
    [[nodiscard]] double placeToSampleFrom(size_t light, const Ray& ray, double u);
    [[nodiscard]] SegmentSample sampleLightFrom(const dvec3& position, const Ray& ray, size_t light,
                                                double u, const dvec2& w);
    void meetLamps(const Ray& ray, double end);
    void meetEnvironment(const Ray& ray);
    void meetGlow(); // of what the last flight met
    void meetEmitter(const SurfacePoint& point);
    /// Of next-event estimation from the origin, in the measure of directionDensity times flightDensity.
    [[nodiscard]] double nextEventDensity(size_t light, double density) const;
    [[nodiscard]] double misWeight(size_t light, double density, double pointsPerMetre = 1) const;
    [[nodiscard]] double distanceDensity(size_t light, const Ray& ray, Interval reach, double t,
                                         double collisionDensity) const;
    [[nodiscard]] dvec3 arriving(const LightSample& sample, const Ray& ray);
    void scatterAtSurface(const SurfacePoint& point, Ray& ray);
    void scatterInMedium(double distance, Ray& ray);
    bool survives();
    void see(Term term, const dvec3& light);

    const TracerScene& scene_;
    PathSettings settings_;
    PathCounts counts_;

    // Of the present path.
    Sampler* sampler_ = nullptr;
    TermLight* light_ = nullptr;
    PathWeights weights_;
    PathHistory history_;
    Origin origin_;
    MediaSegment segment_;
    MediumPoint point_, segmentPoint_;
    std::vector<EmittedLight> emitted_;
    LightChoice fromPoint_, fromSegment_; // of the origin
    LightChoice alongSegment_;            // of the present segment
    LightChoice fromCollision_; // as if there were a collision where a light is sampled from
    double segmentChance_ = 0;  // of sampleLightFromSegment on the present segment
    Interval reach_;
};

} // namespace tyndall::reference
