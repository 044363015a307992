#pragma once
// Random walks from the lights, whose vertices are virtual point lights (Keller 1997; in media Engelhardt, Novák and Dachsbacher 2010,
// section 4.1): light arrives at a vertex and is scattered on from there.

#include <vector>

#include "tracing/light_emission.h"

namespace tyndall::tracing {

/// A vertex of a walk.
struct WalkVertex {
    dvec3 position{0};
    dvec3 travel{0}; // unit, of the light that arrives
    dvec3 power{0};  // watts: on a surface what arrives, in a medium what is scattered
    const MediumSource* medium = nullptr; // whose phase function scatters; null: a surface
    SurfacePoint point;                   // of a surface
    int scatterings = 1;                  // of the light, with the one here

    /// Watts per steradian that leave towards `direction` (unit), without cosines at the receiver. On a surface with the cosine here.
    [[nodiscard]] dvec3 intensity(const dvec3& direction) const;
};

struct WalkSettings {
    int longest = 10000; // vertices; walks that reach it are counted
    // From the third vertex on a walk continues with the probability of its power over its initial power, within these limits.
    double leastSurvival = 0.05, mostSurvival = 0.95;
};

/// Makes walks, one for each sampler. Keeps scratch memory: one for each thread. Outside of the ball around the emission's content, half of the
/// scattered directions are sampled towards it. Otherwise the rare walk that returns from a landscape would carry the power of square kilometres.
class LightWalker {
public:
    LightWalker(const TracerScene& scene, const LightEmission& emission,
                const WalkSettings& settings)
        : scene_(scene), emission_(emission), settings_(settings),
          centre_(emission.content().centre()),
          radius_(emission.content().empty() ? 0 : 0.5 * glm::length(emission.content().extent())),
          segment_(*scene.media) {}

    /// The vertices of one walk, in order; replaces the contents of `walk`.
    void trace(Sampler& sampler, std::vector<WalkVertex>& walk);
    /// Of the walk traced last.
    [[nodiscard]] const EmittedRay& start() const { return start_; }
    [[nodiscard]] uint64_t cutOff() const { return cutOff_; }
    [[nodiscard]] uint64_t rays() const { return rays_; }

private:
    /// Directions from a point to the ball around the content: a cone.
    struct ContentCone {
        dvec3 axis{0, 0, 1}; // unit
        double versine = 0;  // 1 - cosine of half its angle; 0: none, the point is in the ball
        [[nodiscard]] dvec3 sample(const dvec2& u) const;
        /// Density of directions drawn by `own` or, with probability kOnToContent, from the cone: per steradian.
        [[nodiscard]] double density(const dvec3& direction, double own) const;
    };
    [[nodiscard]] ContentCone contentConeFrom(const dvec3& position) const;
    /// A walk between two vertices.
    struct Progress {
        Ray ray;
        PathWeights weights;
        double started =
            0; // initial power, with the weights of directions towards the content
    };
    bool begin(Sampler& sampler, Progress& progress);
    /// Follows the ray to the next vertex and draws the ray that leaves it; false: the walk ends, with or without the vertex.
    bool addVertex(Sampler& sampler, Progress& progress, std::vector<WalkVertex>& walk);
    void enterMedium(double distance, double choice, Progress& progress, WalkVertex& vertex) const;
    void scatterInMedium(const WalkVertex& vertex, const dvec2& u, Sampler& sampler,
                         Progress& progress) const;
    bool scatterOnSurface(const WalkVertex& vertex, double choice, const dvec2& u, Sampler& sampler,
                          Progress& progress) const;
    /// Russian roulette, from the third vertex on.
    bool survives(size_t vertices, Sampler& sampler, Progress& progress) const;
    const TracerScene& scene_;
    const LightEmission& emission_;
    WalkSettings settings_;
    dvec3 centre_; // of the ball around the content
    double radius_;
    EmittedRay start_;
    MediaSegment segment_;
    MediumPoint mediumPoint_;
    std::vector<EmittedLight> emitted_;
    uint64_t cutOff_ = 0, rays_ = 0;
};

} // namespace tyndall::tracing
