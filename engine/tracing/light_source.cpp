#include "tracing/light_source.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "scene/light_flux.h"

namespace tyndall::tracing {
namespace {

constexpr double kWidestDisc = 1.5; // radians, half the angle of a sun

bool finite(const dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

} // namespace

double rangeWindow(double range, double distance) {
    if (!(range > 0)) return 1;
    const double x = distance / range;
    return std::clamp(1 - x * x * x * x, 0.0, 1.0);
}

LightSource::LightSource(const Light& light, const dmat4& rayFromNode)
    : type_(light.type), castsShadows_(light.castsShadows), centre_(rayFromNode[3]) {
    const bool rect = type_ == LightType::Rect;
    power_ = rect ? dvec3(light.radiance) : dvec3(light.color) * double(light.intensity);
    if (!finite(power_) || !finite(centre_)) return;
    if (std::min({power_.x, power_.y, power_.z}) < 0 || maximumOf(power_) == 0) return;
    dvec3 forward = -dvec3(rayFromNode[2]);
    if (rect) {
        halfX_ = 0.5 * double(light.size.x) * dvec3(rayFromNode[0]);
        halfY_ = 0.5 * double(light.size.y) * dvec3(rayFromNode[1]);
        const dvec3 normal = glm::cross(halfX_, halfY_);
        area_ = 4 * glm::length(normal);
        if (!(area_ > 0) || !std::isfinite(area_)) return;
        forward = glm::dot(normal, forward) < 0 ? -normal : normal;
        extent_ = glm::length(halfX_) + glm::length(halfY_);
    }
    const double length = glm::length(forward);
    if (length > 0 && std::isfinite(length))
        axis_ = forward / length;
    else if (type_ != LightType::Point)
        return;
    radius_ = rect ? 0 : std::max(0.0, double(light.radius));
    range_ = rect ? 0 : std::max(0.0, double(light.range));
    if (type_ == LightType::Directional && radius_ > 0) {
        const double s = std::sin(0.5 * std::min(radius_, kWidestDisc));
        versine_ = 2 * s * s;
    }
    if (type_ == LightType::Spot) {
        const double outer = std::clamp(double(light.outerConeAngle), 0.0, kPi / 2);
        if (!(outer > 0)) return;
        cosineInner_ = std::cos(std::clamp(double(light.innerConeAngle), 0.0, outer));
        cosineOuter_ = std::cos(outer);
    }
    if (type_ == LightType::Point || type_ == LightType::Spot) extent_ = radius_;
    delta_ = type_ == LightType::Directional ? !(versine_ > 0) : !rect && !(radius_ > 0);
    black_ = false;
}

/// KHR_lights_punctual: range and cone.
dvec3 LightSource::fading(const dvec3& travel, double distance) const {
    double factor = rangeWindow(range_, distance);
    if (type_ == LightType::Spot) {
        const double part = std::clamp((glm::dot(axis_, travel) - cosineOuter_) /
                                           std::max(0.001, cosineInner_ - cosineOuter_),
                                       0.0, 1.0);
        factor *= part * part;
    }
    return power_ * factor;
}

LampSample LightSource::sample(const dvec3& from, const dvec2& u) const {
    if (black_) return {};
    if (type_ == LightType::Directional) return sampleSun(u);
    if (type_ == LightType::Rect) return sampleRect(from, u);
    if (radius_ > 0) return sampleBall(from, u);
    LampSample result;
    const dvec3 way = centre_ - from;
    result.distance = glm::length(way);
    if (!(result.distance > 0)) return {};
    result.direction = way / result.distance;
    result.radiance =
        fading(-result.direction, result.distance) / (result.distance * result.distance);
    result.density = 1;
    return result;
}

LampSample LightSource::sampleSun(const dvec2& u) const {
    LampSample result;
    result.distance = kInfinity;
    if (delta_) {
        result.direction = -axis_;
        result.radiance = power_;
        result.density = 1;
        return result;
    }
    // A disc of constant radiance that gives `power_` lux on a surface facing its middle.
    result.direction =
        glm::normalize(Frame(-axis_).toWorld(directionAround(1 - u.x * versine_, u.y)));
    result.radiance = power_ / (kPi * versine_ * (2 - versine_)); // sin² = (1-cos)(1+cos)
    result.density = 1 / (2 * kPi * versine_);
    return result;
}

LampSample LightSource::sampleRect(const dvec3& from, const dvec2& u) const {
    const dvec3 at = centre_ + (2 * u.x - 1) * halfX_ + (2 * u.y - 1) * halfY_, way = at - from;
    const double squared = glm::dot(way, way);
    if (!(squared > 0)) return {};
    LampSample result;
    result.distance = std::sqrt(squared);
    result.direction = way / result.distance;
    const double cosine = -glm::dot(axis_, result.direction);
    if (!(cosine > 0)) return {};
    result.radiance = power_;
    result.density = squared / (cosine * area_);
    return result;
}

LampSample LightSource::sampleBall(const dvec3& from, const dvec2& u) const {
    const dvec3 way = centre_ - from;
    const double squared = glm::dot(way, way), r2 = radius_ * radius_;
    if (!(squared > r2 * (1 + 1e-9))) return {}; // inside: the ball shines outwards
    const double sine2 = r2 / squared, versine = sine2 / (1 + std::sqrt(1 - sine2));
    const double z = 1 - u.x * versine;
    LampSample result;
    result.direction =
        glm::normalize(Frame(way / std::sqrt(squared)).toWorld(directionAround(z, u.y)));
    // Nearer root, from the point nearest to the centre; a grazing ray that rounding takes past the ball touches it.
    const double nearest = glm::dot(way, result.direction);
    const dvec3 off = way - nearest * result.direction;
    result.distance = nearest - std::sqrt(std::max(0.0, r2 - glm::dot(off, off)));
    result.radiance = fading(-result.direction, result.distance) / (kPi * r2);
    result.density = 1 / (2 * kPi * versine);
    return result;
}

LampSample LightSource::meet(const Ray& ray) const {
    LampSample result;
    if (black_ || delta_ || !castsShadows_) return result;
    result.direction = ray.direction;
    if (type_ == LightType::Directional) {
        const dvec3 apart = ray.direction + axis_;
        if (0.5 * glm::dot(apart, apart) > versine_) return result;
        result.distance = kInfinity;
        result.radiance = power_ / (kPi * versine_ * (2 - versine_));
        result.density = 1 / (2 * kPi * versine_);
    } else if (type_ == LightType::Rect) {
        const double cosine = -glm::dot(axis_, ray.direction);
        if (!(cosine > 1e-12)) return result;
        const double t = glm::dot(ray.origin - centre_, axis_) / cosine;
        if (!(t > 0)) return result;
        const dvec3 p = ray.at(t) - centre_, normal = glm::cross(halfX_, halfY_);
        // Coordinates in a frame that need not be at right angles.
        const double squared = glm::dot(normal, normal);
        const double x = glm::dot(glm::cross(p, halfY_), normal) / squared,
                     y = glm::dot(glm::cross(halfX_, p), normal) / squared;
        if (!(std::abs(x) <= 1 && std::abs(y) <= 1)) return result;
        result.distance = t;
        result.radiance = power_;
        result.density = t * t / (cosine * area_);
    } else {
        const dvec3 way = centre_ - ray.origin;
        const double squared = glm::dot(way, way), r2 = radius_ * radius_;
        if (!(squared > r2 * (1 + 1e-9))) return result;
        const double nearest = glm::dot(way, ray.direction);
        const dvec3 off = way - nearest * ray.direction;
        const double within = r2 - glm::dot(off, off);
        if (!(nearest > 0) || !(within > 0)) return result;
        result.distance = nearest - std::sqrt(within);
        result.radiance = fading(-ray.direction, result.distance) / (kPi * r2);
        const double sine2 = r2 / squared;
        result.density = (1 + std::sqrt(1 - sine2)) / (2 * kPi * sine2);
    }
    return result;
}

/// Probabilities depend on it, light does not: emit() and sample() have formulas of their own. A spot counts with the most power of its rays
/// where they are drawn, its cone or a ball's whole sphere, so that no ray represents more than the sum of these.
double LightSource::power(double area) const {
    if (black_) return 0;
    const double mean = meanOf(power_);
    if (type_ == LightType::Directional) return parallelFlux(mean, area);
    if (type_ == LightType::Rect) return lambertFlux(mean, area_);
    if (type_ == LightType::Spot && radius_ == 0) return coneFlux(mean, cosineOuter_);
    return pointFlux(mean);
}

EmittedRay LightSource::emit(const dvec2& where, const dvec2& way) const {
    CHECK(local(), "light from infinity starts nowhere");
    EmittedRay out;
    if (black_) return out;
    out.range = range_;
    const double lambert = std::sqrt(1 - way.x);
    if (type_ == LightType::Rect) {
        out.ray = {centre_ + (2 * where.x - 1) * halfX_ + (2 * where.y - 1) * halfY_,
                   glm::normalize(Frame(axis_).toWorld(directionAround(lambert, way.y)))};
        out.power = power_ * (kPi * area_);
    } else if (radius_ > 0) { // a Lambertian ball; cone and range as fading() has them
        const dvec3 normal = directionAround(1 - 2 * where.x, where.y);
        out.ray = {centre_ + radius_ * normal,
                   glm::normalize(Frame(normal).toWorld(directionAround(lambert, way.y)))};
        out.power = fading(out.ray.direction, 0) * (4 * kPi);
    } else {
        const double versine = type_ == LightType::Spot ? 1 - cosineOuter_ : 2;
        out.ray = {centre_, glm::normalize(
                                Frame(axis_).toWorld(directionAround(1 - way.x * versine, way.y)))};
        out.power = fading(out.ray.direction, 0) * (2 * kPi * versine);
    }
    return out;
}

double LightSource::importance(const dvec3& from) const {
    if (type_ == LightType::Directional) return luminanceOf(power_);
    const dvec3 way = centre_ - from;
    const double squared = glm::dot(way, way), distance = std::sqrt(squared);
    // Inside its own extent a light is no longer a point.
    const double counted = std::max(squared, extent_ * extent_);
    if (type_ == LightType::Rect) {
        const double cosine = distance > extent_ ? -glm::dot(axis_, way) / distance : 1;
        return luminanceOf(power_) * area_ *
               std::max(cosine + extent_ / std::max(distance, extent_), 0.0) /
               std::max(counted, 1e-30);
    }
    dvec3 power = power_;
    if (distance > radius_) {
        power = fading(-way / distance, std::max(0.0, distance - radius_));
        if (radius_ > 0)
            power =
                glm::max(power, 0.01 * power_); // a ball shines past its centre's cone and range
    }
    return luminanceOf(power) / std::max(counted, 1e-30);
}

double LightSource::importanceAlong(const Ray& ray, double length) const {
    if (type_ == LightType::Directional) return luminanceOf(power_) * length;
    const double nearest = glm::dot(centre_ - ray.origin, ray.direction);
    const dvec3 off = centre_ - ray.at(nearest);
    const double height = std::max({glm::length(off), extent_, 1e-9 * length, 1e-30});
    const double angle = std::atan((length - nearest) / height) + std::atan(nearest / height);
    const double strength =
        type_ == LightType::Rect ? luminanceOf(power_) * area_ : luminanceOf(power_);
    return strength * angle / height;
}

} // namespace tyndall::tracing
