#include "media/segment_integral.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/check.h"
#include "core/sampling.h"

namespace tyndall {

namespace {

/// Where a ray is inside something convex: [begin,end], empty when end ≤ begin.
struct Interval {
    double begin = 0, end = 0;
    [[nodiscard]] double length() const { return end > begin ? end - begin : 0; }
};

/// The segment in another space: t keeps its meaning, metres of the world.
struct LocalRay {
    dvec3 origin, direction;
    LocalRay(const RaySegment& segment, const dmat4& localFromWorld)
        : origin(localFromWorld * dvec4(segment.origin, 1)),
          direction(localFromWorld * dvec4(segment.direction, 0)) {}
    [[nodiscard]] dvec3 at(double t) const { return origin + t * direction; }
};

Interval clipToBox(const LocalRay& ray, const dvec3& minimum, const dvec3& maximum, double length) {
    Interval inside{0, length};
    for (int axis = 0; axis < 3; ++axis) {
        if (ray.direction[axis] == 0) {
            if (!(ray.origin[axis] >= minimum[axis] && ray.origin[axis] <= maximum[axis]))
                return {};
            continue;
        }
        const double a = (minimum[axis] - ray.origin[axis]) / ray.direction[axis];
        const double b = (maximum[axis] - ray.origin[axis]) / ray.direction[axis];
        inside.begin = std::max(inside.begin, std::min(a, b));
        inside.end = std::min(inside.end, std::max(a, b));
    }
    return inside;
}

Interval clipToUnitBall(const LocalRay& ray, double length) {
    // About the point nearest to the centre, so that a far origin does not cancel the discriminant away.
    const double squared = glm::dot(ray.direction, ray.direction);
    const double nearest = -glm::dot(ray.origin, ray.direction) / squared;
    const dvec3 closest = ray.at(nearest);
    const double within = 1 - glm::dot(closest, closest);
    if (!(within > 0)) return {};
    const double half = std::sqrt(within / squared);
    return {std::max(0.0, nearest - half), std::min(length, nearest + half)};
}

/// ∫₀^length e^(-(y + slope·t)/H) dt where y + slope·t ≥ 0 throughout.
double integrateAbove(double y, double slope, double length, double scaleHeight) {
    if (!(length > 0)) return 0;
    // From the denser end upwards: the exponent never grows.
    const double lowest = slope < 0 ? y + slope * length : y;
    const double rate = std::abs(slope) / scaleHeight;
    const double denser = std::exp(-lowest / scaleHeight);
    if (std::isinf(length)) return rate > 0 ? denser / rate : (denser > 0 ? kInfinity : 0);
    return denser * length * oneMinusExpOverX(rate * length);
}

double integrateHeight(const Medium& medium, const dmat4& worldFromMedium,
                       const RaySegment& segment) {
    const dvec3 up = glm::normalize(dvec3(worldFromMedium[1]));
    const double y = glm::dot(segment.origin - dvec3(worldFromMedium[3]), up);
    const double slope = glm::dot(segment.direction, up);
    if (slope == 0)
        return y <= 0 ? segment.length : integrateAbove(y, 0, segment.length, medium.scaleHeight);

    const double crossing = std::clamp(
        -y / slope, 0.0, segment.length); // of the height 0, where the density stops at 1
    if (slope > 0)                        // from below upwards
        return crossing + integrateAbove(std::max(y, 0.0), slope, segment.length - crossing,
                                         medium.scaleHeight);
    const double below = segment.length - crossing;
    return integrateAbove(std::max(y, 0.0), slope, std::min(crossing, segment.length),
                          medium.scaleHeight) +
           below;
}

dmat4 unitBallFromWorld(const Medium& medium, const dmat4& worldFromMedium) {
    dmat4 scaled = worldFromMedium;
    for (int axis = 0; axis < 3; ++axis) scaled[axis] *= 0.5 * medium.size[axis];
    return glm::inverse(scaled);
}

/// Walks from one index plane to the next: plane crossings are computed from their index, never summed up.
class CellWalk {
public:
    CellWalk(const LocalRay& ray, Interval range) : ray_(ray), end_(range.end), t_(range.begin) {
        const dvec3 start = ray.at(range.begin);
        for (int axis = 0; axis < 3; ++axis) {
            plane_[axis] =
                ray.direction[axis] > 0 ? std::floor(start[axis]) + 1 : std::ceil(start[axis]) - 1;
            crossing_[axis] = crossingOf(axis);
        }
    }
    [[nodiscard]] bool done() const { return t_ >= end_; }
    /// The part of the ray in the next cell; may be empty where two planes are crossed at once.
    Interval next() {
        const double stop =
            std::max(t_, std::min({crossing_[0], crossing_[1], crossing_[2], end_}));
        const Interval part{t_, stop};
        for (int axis = 0; axis < 3; ++axis)
            while (crossing_[axis] <= stop && crossing_[axis] < end_) {
                plane_[axis] += ray_.direction[axis] > 0 ? 1 : -1;
                crossing_[axis] = crossingOf(axis);
            }
        t_ = stop;
        return part;
    }

private:
    [[nodiscard]] double crossingOf(int axis) const {
        return ray_.direction[axis] == 0
                   ? kInfinity
                   : (plane_[axis] - ray_.origin[axis]) / ray_.direction[axis];
    }
    const LocalRay& ray_;
    double end_, t_;
    dvec3 plane_, crossing_;
};

} // namespace

dvec3 segmentSource(const dvec3& source, const dvec3& extinction, double length) {
    dvec3 result;
    for (int c = 0; c < 3; ++c) {
        if (source[c] == 0)
            result[c] = 0; // even where the segment has no end
        else if (std::isinf(length))
            result[c] = extinction[c] > 0 ? source[c] / extinction[c] : kInfinity;
        else
            result[c] = source[c] * length * oneMinusExpOverX(extinction[c] * length);
    }
    return result;
}

double mediumDensity(const Medium& medium, const dmat4& worldFromMedium, const dvec3& position) {
    const auto local = [&](const dmat4& localFromWorld) {
        return dvec3(localFromWorld * dvec4(position, 1));
    };
    switch (medium.kind) {
    case MediumKind::Everywhere: return 1;
    case MediumKind::Box: {
        const dvec3 p = glm::abs(local(glm::inverse(worldFromMedium)));
        return p.x <= medium.size.x / 2 && p.y <= medium.size.y / 2 && p.z <= medium.size.z / 2 ? 1
                                                                                                : 0;
    }
    case MediumKind::Sphere:
        return glm::length(local(unitBallFromWorld(medium, worldFromMedium))) <= 1 ? 1 : 0;
    case MediumKind::Height: {
        const double y = glm::dot(position - dvec3(worldFromMedium[3]),
                                  glm::normalize(dvec3(worldFromMedium[1])));
        return y <= 0 ? 1 : std::exp(-y / medium.scaleHeight);
    }
    case MediumKind::Grid:
        return medium.density ? medium.density->sample(local(
                                    glm::inverse(worldFromMedium * medium.density->worldFromIndex)))
                              : 0;
    }
    return 0;
}

double densityLength(const Medium& medium, const dmat4& worldFromMedium,
                     const RaySegment& segment) {
    CHECK(std::abs(glm::length(segment.direction) - 1) < 1e-6,
          "the segment's direction must be a unit vector");
    if (!(segment.length > 0)) return 0;
    switch (medium.kind) {
    case MediumKind::Everywhere: return segment.length;
    case MediumKind::Box:
        return clipToBox({segment, glm::inverse(worldFromMedium)}, -0.5 * medium.size,
                         0.5 * medium.size, segment.length)
            .length();
    case MediumKind::Sphere:
        return clipToUnitBall({segment, unitBallFromWorld(medium, worldFromMedium)}, segment.length)
            .length();
    case MediumKind::Height: return integrateHeight(medium, worldFromMedium, segment);
    case MediumKind::Grid:
        return medium.density
                   ? integrateGrid(*medium.density,
                                   worldFromMedium * medium.density->worldFromIndex, segment)
                   : 0;
    }
    return 0;
}

dvec3 opticalDepth(const Medium& medium, const dmat4& worldFromMedium, const RaySegment& segment) {
    const double length = densityLength(medium, worldFromMedium, segment);
    const dvec3 extinction = dvec3(medium.scattering) + dvec3(medium.absorption);
    dvec3 depth;
    for (int c = 0; c < 3; ++c) depth[c] = extinction[c] == 0 ? 0 : extinction[c] * length;
    return depth;
}

double integrateGrid(const BrickGrid& grid, const dmat4& worldFromIndex,
                     const RaySegment& segment) {
    if (grid.bricks.empty()) return 0;
    const LocalRay ray(segment, glm::inverse(worldFromIndex));
    const Bounds bounds = grid.indexBounds();
    const Interval range = clipToBox(ray, bounds.minimum, bounds.maximum, segment.length);
    if (!(range.end > range.begin)) return 0;

    double sum = 0;
    for (CellWalk walk(ray, range); !walk.done();) {
        const Interval part = walk.next();
        if (part.length() == 0) continue;
        const double middle = 0.5 * (part.begin + part.end);
        sum += part.length() / 6 *
               (grid.sample(ray.at(part.begin)) + 4 * grid.sample(ray.at(middle)) +
                grid.sample(ray.at(part.end)));
    }
    return sum;
}

} // namespace tyndall
