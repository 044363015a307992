#include "camera_controller.h"

#include <algorithm>
#include <cmath>

namespace tyndall::editor {
namespace {

constexpr double kRadiansPerPixel = 0.004;
constexpr double kSteepest = 89.5 * kPi / 180; // above it "level" has no meaning
constexpr double kSpeedNotch = 1.2, kDollyNotch = 0.9;
constexpr double kSmallestDistance = 1e-6; // metres

} // namespace

void CameraController::reset(const dmat4& worldFromCamera, double sceneSize) {
    position_ = dvec3(worldFromCamera[3]);
    // The camera looks along -Z whatever mirrors it: X is made again from the two others.
    const dvec3 back = glm::normalize(dvec3(worldFromCamera[2]));
    const dvec3 right = glm::normalize(glm::cross(dvec3(worldFromCamera[1]), back));
    rotation_ = glm::normalize(glm::quat_cast(dmat3(right, glm::cross(back, right), back)));
    const double size = std::isfinite(sceneSize) && sceneSize > 0 ? sceneSize : 10;
    pivotDistance_ = 0.5 * size;
    speed_ = 0.15 * size;
}

dmat4 CameraController::worldFromCamera() const {
    dmat4 result = glm::mat4_cast(rotation_);
    result[3] = dvec4(position_, 1);
    return result;
}

void CameraController::turn(const dvec2& pixels) {
    const double elevation = std::asin(std::clamp(forward().y, -1.0, 1.0));
    // A camera that starts beyond the limit may come back, not go on.
    const double lowest = std::min(-kSteepest, elevation), highest = std::max(kSteepest, elevation);
    const double pitch =
        std::clamp(elevation - pixels.y * kRadiansPerPixel, lowest, highest) - elevation;
    const dquat yaw = glm::angleAxis(-pixels.x * kRadiansPerPixel, dvec3(0, 1, 0));
    rotation_ = glm::normalize(yaw * rotation_ * glm::angleAxis(pitch, dvec3(1, 0, 0)));
}

void CameraController::look(const dvec2& pixels) { turn(pixels); }

void CameraController::fly(const dvec3& axes, double seconds) {
    position_ += rotation_ * dvec3(axes.x, axes.y, -axes.z) * (speed_ * seconds);
}

void CameraController::changeSpeed(double notches) { speed_ *= std::pow(kSpeedNotch, notches); }

void CameraController::orbit(const dvec2& pixels) {
    const dvec3 centre = pivot();
    turn(pixels);
    position_ = centre - pivotDistance_ * forward();
}

void CameraController::pan(const dvec2& pixels, double metresPerPixel) {
    position_ += rotation_ * dvec3(-pixels.x, pixels.y, 0) * metresPerPixel;
}

void CameraController::dolly(double notches) {
    const dvec3 centre = pivot();
    pivotDistance_ = std::max(pivotDistance_ * std::pow(kDollyNotch, notches), kSmallestDistance);
    position_ = centre - pivotDistance_ * forward();
}

void CameraController::frame(const Bounds& bounds, double yfov, double aspect) {
    if (bounds.empty()) return;
    const double radius = std::max(0.5 * glm::length(bounds.extent()), kSmallestDistance);
    const double halfHeight = 0.5 * yfov, halfWidth = std::atan(std::tan(halfHeight) * aspect);
    pivotDistance_ = radius / std::sin(std::min(halfHeight, halfWidth));
    position_ = bounds.centre() - pivotDistance_ * forward();
    speed_ = 0.3 * radius;
}

} // namespace tyndall::editor
