#pragma once
// Emission of light: rays drawn in proportion to power, with which walks through the scene start.

#include <vector>

#include "tracing/tracer_scene.h"

namespace tyndall::tracing {

/// All lights of a scene as sources of rays. Light from infinity goes through the box around all surfaces and all media with an end. With endless
/// fog the box is as large as the ball around it for all directions; scattering outside of it is left out, extinction is not.
class LightEmission {
public:
    /// `scene` must outlive it. `content`: most rays of light from infinity are sampled towards it; empty: towards everything. `surroundings`: all such rays
    /// are sampled towards it; empty: towards everything.
    explicit LightEmission(const TracerScene& scene, const Bounds& content = {},
                           const Bounds& surroundings = {});

    [[nodiscard]] bool black() const { return !(sums_.back() > 0); }
    /// Watts of all lights, the mean of the channels; upper bounds where textures, cones or windows dim them.
    [[nodiscard]] double power() const { return sums_.back(); }
    [[nodiscard]] EmittedRay sample(Sampler& sampler) const;
    /// What most rays are sampled towards; around all surfaces and media with an end, if nothing smaller was given.
    [[nodiscard]] const Bounds& content() const { return content_; }

private:
    /// `area`: 1/density of the ray among those of this direction, m².
    [[nodiscard]] Ray fromInfinity(const dvec3& direction, double choice, const dvec2& u,
                                   double& area) const;

    const TracerScene& scene_;
    Bounds whole_, near_, content_; // around everything, what rays are sampled towards, and what most rays are
    bool reachesBeyond_ = false;    // is `whole_` much larger than `near_`?
    std::vector<Bounds>
        boxes_; // that rays from infinity are sampled towards: content first, all last
    std::vector<double> sums_{0.0}; // cumulative power, as Lights counts them
};

} // namespace tyndall::tracing
