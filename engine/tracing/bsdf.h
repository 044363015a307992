#pragma once
// glTF 2.0's metallic-roughness material (appendix B) with KHR_materials_specular:
//
//   dielectric = mix(baseColor/π, V·D, specular·Schlick(0.04))   metal = Schlick(baseColor)·V·D
//
// mixed by `metallic`; D is GGX with α = roughness² (at least 10⁻³), V Smith's separable masking and shadowing over 4 n·l n·v.

#include "tracing/ray.h"

namespace tyndall::tracing {

struct Surface {
    dvec3 baseColor{1};                               // 0..1
    double metallic = 0, roughness = 1, specular = 1; // 0..1
    dvec3 normal{0, 0, 1};                            // unit, shading
    dvec3 geometricNormal{0, 0, 1};                   // unit, on the side that the path came from
};

struct BsdfSample {
    dvec3 direction{0};
    dvec3 weight{0};    // BSDF · cosine / density; 0: the path ends
    double density = 0; // per steradian
};

class Bsdf {
public:
    /// `toEye`: unit, back along the path.
    Bsdf(const Surface& surface, const dvec3& toEye);

    /// BSDF · |n·l|, 1/sr. 0 from behind either normal.
    [[nodiscard]] dvec3 evaluate(const dvec3& toLight) const;
    /// Of sample() choosing this direction, per steradian.
    [[nodiscard]] double density(const dvec3& toLight) const;
    /// `choice` picks the lobe, `u` the direction in it.
    [[nodiscard]] BsdfSample sample(double choice, const dvec2& u) const;

private:
    [[nodiscard]] dvec3 evaluateLocal(const dvec3& toLight) const;
    [[nodiscard]] double densityLocal(const dvec3& toLight) const;

    Frame frame_;
    dvec3 geometricNormal_, toEye_; // toEye_ in the frame
    dvec3 baseColor_;
    double metallic_, alpha_, specular_;
    double chanceOfMicrofacets_;
};

} // namespace tyndall::tracing
