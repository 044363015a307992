#include "rotation_angles.h"

#include <cmath>

namespace tyndall::editor {
namespace {

constexpr double kDegrees = 180 / kPi;
// 1 - |cosine of half the angle| between two rotations that are the same but for rounding.
constexpr double kSame = 1e-12;

dquat rotationOf(const dvec3& degrees) { return glm::normalize(dquat(degrees / kDegrees)); }

/// Into ±180°.
double wrapped(double degrees) { return std::remainder(degrees, 360.0); }

/// Of R = Rz·Ry·Rx, whose row 2 is (-sin y, cos y·sin x, cos y·cos x) and column 0 (cos y·cos z, cos y·sin z, -sin y).
dvec3 principalAngles(const dquat& rotation) {
    const dmat3 m = glm::mat3_cast(glm::normalize(rotation)); // m[column][row]
    const double cosine = std::hypot(m[1][2], m[2][2]), y = std::atan2(-m[0][2], cosine);
    // Looking straight up or down, X and Z turn about one axis: Z takes it all. Below this the angle's error is that of a rounding.
    constexpr double kLocked = 1e-7;
    const dvec3 radians =
        cosine < kLocked ? dvec3(0, y, std::atan2(-m[1][0], m[1][1]))
                         : dvec3(std::atan2(m[1][2], m[2][2]), y, std::atan2(m[0][1], m[0][0]));
    return radians * kDegrees;
}

dvec3 anglesOf(const dquat& rotation) {
    const dvec3 one = principalAngles(rotation);
    const dvec3 other(wrapped(one.x + 180), wrapped(180 - one.y), wrapped(one.z + 180));
    const auto turn = [](const dvec3& a) { return std::abs(a.x) + std::abs(a.y) + std::abs(a.z); };
    return turn(other) < turn(one) ? other : one;
}

} // namespace

const dvec3& RotationAngles::of(int node, const dquat& rotation) {
    const double cosine = std::abs(glm::dot(rotationOf(degrees_), glm::normalize(rotation)));
    if (node != node_ || 1 - cosine > kSame) degrees_ = anglesOf(rotation);
    node_ = node;
    return degrees_;
}

dquat RotationAngles::set(int node, const dvec3& degrees) {
    node_ = node;
    degrees_ = degrees;
    return rotationOf(degrees);
}

} // namespace tyndall::editor
