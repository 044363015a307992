#include "tracing/bsdf.h"

#include <algorithm>
#include <cmath>

namespace tyndall::tracing {
namespace {

constexpr double kSmallestAlpha = 1e-3; // as in the renderer: see docs/scene-format.md on roughness
constexpr double kNormalReflectance = 0.04;

double schlick(double cosine) {
    const double m = std::clamp(1 - cosine, 0.0, 1.0);
    return m * m * m * m * m;
}

/// Of microfacet normals, per steradian, about the z axis.
double distribution(double alpha, const dvec3& h) {
    if (!(h.z > 0)) return 0;
    const double across = h.x * h.x + h.y * h.y, along = alpha * h.z;
    const double d = along * along + across;
    return alpha * alpha / (kPi * d * d);
}

/// Smith's G₁ of a direction at this cosine.
double masking(double alpha, double cosine) {
    return 2 * cosine / (cosine + std::sqrt(alpha * alpha + (1 - alpha * alpha) * cosine * cosine));
}

/// A microfacet normal among those visible from `v` (Heitz 2018): density G₁(v)·D(h)·(v·h)/v.z.
dvec3 sampleVisible(double alpha, const dvec3& v, const dvec2& u) {
    const dvec3 stretched = glm::normalize(dvec3(alpha * v.x, alpha * v.y, v.z));
    const double squared = stretched.x * stretched.x + stretched.y * stretched.y;
    const dvec3 side =
        squared > 0 ? dvec3(-stretched.y, stretched.x, 0) / std::sqrt(squared) : dvec3(1, 0, 0);
    const dvec3 up = glm::cross(stretched, side);
    const double radius = std::sqrt(u.x), angle = 2 * kPi * u.y;
    const double a = radius * std::cos(angle), s = 0.5 * (1 + stretched.z);
    const double b = (1 - s) * std::sqrt(std::max(0.0, 1 - a * a)) + s * radius * std::sin(angle);
    const dvec3 h = a * side + b * up + std::sqrt(std::max(0.0, 1 - a * a - b * b)) * stretched;
    return glm::normalize(dvec3(alpha * h.x, alpha * h.y, std::max(1e-9, h.z)));
}

} // namespace

Bsdf::Bsdf(const Surface& surface, const dvec3& toEye)
    : frame_(surface.normal), geometricNormal_(surface.geometricNormal),
      toEye_(frame_.toLocal(toEye)), baseColor_(surface.baseColor), metallic_(surface.metallic),
      alpha_(std::max(surface.roughness * surface.roughness, kSmallestAlpha)),
      specular_(surface.specular) {
    // In proportion to the brightness of the two parts towards the eye; every lobe keeps some samples.
    const double weight = schlick(std::abs(toEye_.z));
    const double coat = specular_ * (kNormalReflectance + (1 - kNormalReflectance) * weight);
    const double metal = luminanceOf(baseColor_ + (1.0 - baseColor_) * weight);
    const double microfacets = (1 - metallic_) * coat + metallic_ * metal;
    const double base = (1 - metallic_) * (1 - coat) * luminanceOf(baseColor_);
    chanceOfMicrofacets_ = microfacets > 0 ? microfacets / (microfacets + base) : 0;
    if (chanceOfMicrofacets_ > 0 && (1 - metallic_) * maximumOf(baseColor_) > 0)
        chanceOfMicrofacets_ = std::clamp(chanceOfMicrofacets_, 0.1, 0.9);
    // A normal map that faces away from the eye leaves no visible microfacets to choose from.
    if (!(toEye_.z > 1e-6)) chanceOfMicrofacets_ = 0;
}

dvec3 Bsdf::evaluateLocal(const dvec3& l) const {
    if (!(l.z > 0)) return dvec3(0);
    const dvec3 sum = toEye_ + l;
    const double squared = glm::dot(sum, sum);
    const dvec3 h = squared > 1e-24 ? sum / std::sqrt(squared) : dvec3(0, 0, 1);
    const double weight = schlick(std::max(0.0, glm::dot(toEye_, h)));
    const double coat = specular_ * (kNormalReflectance + (1 - kNormalReflectance) * weight);
    const dvec3 metal = baseColor_ + (1.0 - baseColor_) * weight;
    const double cosineToEye = std::abs(toEye_.z);
    double microfacets = 0; // D·V·n·l
    if (cosineToEye > 0)
        microfacets = distribution(alpha_, h) * masking(alpha_, cosineToEye) *
                      masking(alpha_, l.z) / (4 * cosineToEye);
    return (1 - metallic_) * ((1 - coat) * baseColor_ * (l.z / kPi) + coat * microfacets) +
           metallic_ * metal * microfacets;
}

double Bsdf::densityLocal(const dvec3& l) const {
    if (!(l.z > 0)) return 0;
    double result = (1 - chanceOfMicrofacets_) * l.z / kPi;
    if (chanceOfMicrofacets_ > 0) {
        const dvec3 h = glm::normalize(toEye_ + l);
        result += chanceOfMicrofacets_ * masking(alpha_, toEye_.z) * distribution(alpha_, h) /
                  (4 * toEye_.z);
    }
    return result;
}

dvec3 Bsdf::evaluate(const dvec3& toLight) const {
    if (!(glm::dot(geometricNormal_, toLight) > 0)) return dvec3(0);
    return evaluateLocal(frame_.toLocal(toLight));
}

double Bsdf::density(const dvec3& toLight) const { return densityLocal(frame_.toLocal(toLight)); }

BsdfSample Bsdf::sample(double choice, const dvec2& u) const {
    dvec3 l;
    if (choice < chanceOfMicrofacets_) {
        const dvec3 h = sampleVisible(alpha_, toEye_, u);
        l = 2 * glm::dot(toEye_, h) * h - toEye_;
    } else {
        const double z = std::sqrt(1 - u.x); // cosine-weighted, never exactly grazing: u.x < 1
        l = directionAround(z, u.y);
    }
    BsdfSample result;
    result.direction = glm::normalize(frame_.toWorld(l));
    if (!(l.z > 0) || !(glm::dot(geometricNormal_, result.direction) > 0)) return result;
    result.density = densityLocal(l);
    if (result.density > 0) result.weight = evaluateLocal(l) / result.density;
    return result;
}

} // namespace tyndall::tracing
