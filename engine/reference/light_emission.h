#pragma once
// Light as it leaves its sources: rays drawn in proportion to power, from which walks through the scene start.

#include <vector>

#include "reference/tracer_scene.h"

namespace tyndall::reference {

/// All lights of a scene as sources of rays. Light from infinity starts on a disc that the ball around all surfaces and all media with an
/// end fits behind: what it does in endless fog outside of that ball is left out, but for what the fog takes away before.
class LightEmission {
public:
    /// `scene` must outlive it. `content`: where most of light from infinity is to be aimed; empty: everywhere alike.
    explicit LightEmission(const TracerScene& scene, const Bounds& content = {});

    [[nodiscard]] bool black() const { return !(sums_.back() > 0); }
    /// Watts of all lights, the mean of the channels; bounds where textures, cones or windows dim them.
    [[nodiscard]] double power() const { return sums_.back(); }
    [[nodiscard]] EmittedRay sample(Sampler& sampler) const;

private:
    struct Ball {
        dvec3 centre{0};
        double radius = 0; // metres
        [[nodiscard]] double discArea() const { return kPi * radius * radius; }
        [[nodiscard]] bool inDisc(const dvec3& position, const dvec3& direction) const;
    };
    /// `area`: 1/density of the ray among those of this direction, m².
    [[nodiscard]] Ray fromInfinity(const dvec3& direction, double choice, const dvec2& u,
                                   double& area) const;

    const TracerScene& scene_;
    Ball whole_, content_;          // around everything, and around what most rays are to meet
    std::vector<double> sums_{0.0}; // cumulative power, as Lights counts them
};

} // namespace tyndall::reference
