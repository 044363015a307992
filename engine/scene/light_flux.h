#pragma once
// The flux of lights, in closed form. Whoever weighs lights against each other, or scales by what they send out, takes it from here.
//
// Two places compute the same flux on their own, and must: shaders, which add it up ray by ray, and LightSource::emit() and sample() of
// engine/tracing, which are part of the reference. LightEmission.PowerIsItsClosedForm measures the latter against theory.
//
// `Power` is double or dvec3 (one value a channel). Candela give lumens, lux lumens on an area, nits lumens; radiometric units give watts.

#include "core/math.h"

namespace tyndall {

/// Of a point light, or of a Lambertian ball of this intensity: 4πI.
template <typename Power> [[nodiscard]] Power pointFlux(const Power& intensity) {
    return intensity * 4.0 * kPi;
}

/// Of the same intensity in all directions whose angle with an axis has at least this cosine (-1..1): 2πI·(1 - cosine).
template <typename Power> [[nodiscard]] Power coneFlux(const Power& intensity, double cosine) {
    return intensity * 2.0 * kPi * (1 - cosine);
}

/// Of a spot light, from the cosines of its inner and outer half angles; no more than coneFlux(intensity, cosineOuter). It integrates the
/// fall-off of KHR_lights_punctual, "Inner and Outer Cone Angles": the square of clamp((cosine - outer) / max(0.001, inner - outer), 0, 1).
template <typename Power>
[[nodiscard]] Power spotFlux(const Power& intensity, double cosineInner, double cosineOuter) {
    const double width = glm::max(0.001, cosineInner - cosineOuter);
    // The penumbra may reach beyond the axis where `width` is the extension's least.
    const double most = glm::min((1 - cosineOuter) / width, 1.0);
    const double penumbra = width * most * most * most / 3;
    return intensity * 2.0 * kPi * (penumbra + glm::max(1 - (cosineOuter + width), 0.0));
}

/// Of a Lambertian surface (one side of it) of this area in m²: πLA.
template <typename Power> [[nodiscard]] Power lambertFlux(const Power& radiance, double area) {
    return radiance * kPi * area;
}

/// Of parallel light of this illuminance through an area across it, m²: EA.
template <typename Power> [[nodiscard]] Power parallelFlux(const Power& illuminance, double area) {
    return illuminance * area;
}

/// Areas (m²) of the three faces by which `direction` (unit) enters the box, those across x, y and z, projected along it; 0 for an empty box.
[[nodiscard]] inline dvec3 projectedFaces(const Bounds& box, const dvec3& direction) {
    if (box.empty()) return dvec3(0);
    const dvec3 e = box.extent();
    return glm::abs(direction) * dvec3(e.y * e.z, e.z * e.x, e.x * e.y);
}

/// Area (m²) that the box covers as seen along `direction` (unit).
[[nodiscard]] inline double projectedArea(const Bounds& box, const dvec3& direction) {
    const dvec3 faces = projectedFaces(box, direction);
    return faces.x + faces.y + faces.z;
}

/// Its mean over all directions: a quarter of the box's surface (Cauchy 1832, for convex bodies).
[[nodiscard]] inline double meanProjectedArea(const Bounds& box) {
    return 0.5 * projectedArea(box, dvec3(1));
}

} // namespace tyndall
