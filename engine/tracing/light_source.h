#pragma once
// One of the scene's lights. Lights have no surface that is visible or blocks rays. A ball or a
// rectangle gives light to rays that pass through it, a point or a sun without a disc only to rays that are sampled towards it.

#include "tracing/ray.h"
#include "scene/scene.h"

namespace tyndall::tracing {

/// A direction from a point to a light.
struct LampSample {
    dvec3 direction{0};  // unit, towards the light
    double distance = 0; // metres; infinite for light from infinity
    dvec3 radiance{0};   // nits; of a light without extent: lux on a facing surface
    double density = 0; // per steradian; of a light without extent: 1. 0: no light comes from there
};

/// KHR_lights_punctual: the window that brings the inverse square to 0 at the range; 1 for unbounded lights (range 0).
[[nodiscard]] double rangeWindow(double range, double distance);

/// A ray that a light emits, with the power that it represents.
struct EmittedRay {
    Ray ray;
    dvec3 power{0};       // watts: radiance · cosine / density of the ray; 0: nothing
    double range = 0;     // metres, for rangeWindow()
    bool distant = false; // from infinity
};

class LightSource {
public:
    /// `rayFromNode` maps the light's node to ray space.
    LightSource(const Light& light, const dmat4& rayFromNode);

    [[nodiscard]] bool black() const { return black_; }
    /// No ray hits it: it has no extent.
    [[nodiscard]] bool delta() const { return delta_; }
    [[nodiscard]] bool castsShadows() const { return castsShadows_; }

    [[nodiscard]] LampSample sample(const dvec3& from, const dvec2& u) const;
    /// Where the ray meets the light, if it does: distance, radiance, and the density with which sample() from the ray's
    /// origin would have chosen this direction; density 0: it does not. Always 0 for delta lights.
    [[nodiscard]] LampSample meet(const Ray& ray) const;

    /// Roughly the luminance-weighted illuminance on a facing surface at `from`, shadows and media left out.
    [[nodiscard]] double importance(const dvec3& from) const;
    /// Roughly ∫ importance dt along [0,length] of the ray.
    [[nodiscard]] double importanceAlong(const Ray& ray, double length) const;
    /// Watts, the mean of the channels; of a spot, those of its whole outer cone at full intensity. `area`: m², what light from infinity falls on.
    [[nodiscard]] double power(double area) const;
    /// A ray of a light at a place in space. CHECKs local().
    [[nodiscard]] EmittedRay emit(const dvec2& where, const dvec2& way) const;

    /// At a place in space, from which equiangular sampling can see it; false for light from infinity.
    [[nodiscard]] bool local() const { return type_ != LightType::Directional; }
    [[nodiscard]] const dvec3& centre() const { return centre_; }

private:
    [[nodiscard]] dvec3 fading(const dvec3& travel, double distance) const;
    [[nodiscard]] LampSample sampleBall(const dvec3& from, const dvec2& u) const;
    [[nodiscard]] LampSample sampleRect(const dvec3& from, const dvec2& u) const;
    [[nodiscard]] LampSample sampleSun(const dvec2& u) const;

    LightType type_;
    bool black_ = true, delta_ = true, castsShadows_ = true;
    dvec3 centre_{0};
    dvec3 axis_{0, 0, -1}; // unit, of travel
    dvec3 power_{0};       // candela, lux; rect: nits
    double radius_ = 0, range_ = 0, extent_ = 0;
    double cosineInner_ = 1, cosineOuter_ = 0;
    dvec3 halfX_{0}, halfY_{0}; // rect: from the centre to the middles of two sides
    double area_ = 0;
    double versine_ = 0; // sun: 1 - cos of its half angle
};

} // namespace tyndall::tracing
