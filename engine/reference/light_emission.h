#pragma once
// Light as it leaves its sources: rays drawn in proportion to power, from which walks through the scene start.

#include <vector>

#include "reference/tracer_scene.h"

namespace tyndall::reference {

/// All lights of a scene as sources of rays. Light from infinity starts on a disc that the ball around all surfaces and all media with an
/// end fits behind: what it does in endless fog outside of that ball is left out, but for what the fog takes away before.
class LightEmission {
public:
    /// `scene` must outlive it.
    explicit LightEmission(const TracerScene& scene);

    [[nodiscard]] bool black() const { return !(sums_.back() > 0); }
    /// Watts of all lights, the mean of the channels; bounds where textures, cones or windows dim them.
    [[nodiscard]] double power() const { return sums_.back(); }
    [[nodiscard]] EmittedRay sample(Sampler& sampler) const;

private:
    [[nodiscard]] Ray fromInfinity(const dvec3& direction, const dvec2& u) const;
    [[nodiscard]] double discArea() const { return kPi * radius_ * radius_; }

    const TracerScene& scene_;
    dvec3 centre_{0};
    double radius_ = 0;             // metres, of the ball around everything
    std::vector<double> sums_{0.0}; // cumulative power, as Lights counts them
};

} // namespace tyndall::reference
