#pragma once
// A ray. Its space is the world moved so that the camera is at the origin: coordinates stay
// small where pictures are sharp, however far from the world's origin a scene lies.

#include "core/math.h"

namespace tyndall::tracing {

struct Ray {
    dvec3 origin{0};
    dvec3 direction{0, 0, -1}; // unit
    [[nodiscard]] dvec3 at(double t) const { return origin + t * direction; }
};

inline double maximumOf(const dvec3& v) { return glm::max(v.x, glm::max(v.y, v.z)); }
inline double meanOf(const dvec3& v) { return (v.x + v.y + v.z) / 3; }
/// Rec. 709 weights, for sampling decisions about colours.
inline double luminanceOf(const dvec3& v) { return 0.2126 * v.x + 0.7152 * v.y + 0.0722 * v.z; }

/// An orthonormal right-handed frame with z along `normal` (Duff et al. 2017).
struct Frame {
    dvec3 x, y, z;
    explicit Frame(const dvec3& normal) : z(normal) {
        const double s = std::copysign(1.0, normal.z), a = -1.0 / (s + normal.z),
                     b = normal.x * normal.y * a;
        x = {1.0 + s * normal.x * normal.x * a, s * b, -s * normal.x};
        y = {b, s + normal.y * normal.y * a, -normal.y};
    }
    [[nodiscard]] dvec3 toWorld(const dvec3& v) const { return x * v.x + y * v.y + z * v.z; }
    [[nodiscard]] dvec3 toLocal(const dvec3& v) const {
        return {glm::dot(v, x), glm::dot(v, y), glm::dot(v, z)};
    }
};

/// The direction at polar cosine `z` and azimuth 2π·u around the z axis.
inline dvec3 directionAround(double z, double u) {
    const double s = std::sqrt(glm::max(0.0, 1 - z * z)), azimuth = 2 * kPi * u;
    return {s * std::cos(azimuth), s * std::sin(azimuth), z};
}

} // namespace tyndall::tracing
